// SPDX-License-Identifier: Apache-2.0
// `kilolux photometry` as a whole: its points, its results, and a line for each bad input.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host/measure/bench/table.h"
#include "present/commands/photometry/points_choice.h"
#include "tests/support/child.h"
#include "tests/support/lit_hall.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

// Two lamps of 100 cd at heights of 2 and 4 m, one of which ends at 8 m.
constexpr const char* kLamps = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[
{"type":"point","intensity":100},{"type":"point","intensity":100,"range":8}]}},"nodes":[
{"translation":[0,2,0],"extensions":{"KHR_lights_punctual":{"light":0}}},
{"translation":[0,4,0],"extensions":{"KHR_lights_punctual":{"light":1}}}]})";

class PhotometryCommand : public testing::Test {
 protected:
    std::string scene() {
        write_text(folder_ / "lamps.gltf", lamps_);
        return (folder_ / "lamps.gltf").string();
    }
    std::string points(const std::string& text) {
        write_text(folder_ / "points.csv", text);
        return (folder_ / "points.csv").string();
    }
    ChildResult run(Words words) {
        words.insert(words.begin(), {"photometry", scene()});
        return run_kilolux(words);
    }
    void expect_refused(const Words& words, int code, const std::string& why) {
        const ChildResult result = run(words);
        EXPECT_EQ(result.code, code) << why;
        EXPECT_TRUE(contains(result.err, why)) << result.err;
        EXPECT_EQ(result.out, "");
    }
    TemporaryFolder folder_;
    std::string lamps_ = kLamps;
};

TEST_F(PhotometryCommand, TellsEachPointAndTheSummary) {
    const std::string file = points("x,y,z,nx,ny,nz\n# desk\n\n0,0,0,0,5,0\r\n0,3,0,0,-1,0\n");
    const ChildResult result = run({"--points", file, "--json", "--ambient", "0.5"});
    ASSERT_EQ(result.code, 0) << result.err;
    const Json json = Json::parse(result.out);
    const double window = 1.0 - std::pow(4.0 / 8.0, 4);
    const double below = 25.0 + 6.25 * window, between = 100.0;
    const Json& first = json.at("points").at(0);
    EXPECT_NEAR(first.at("float64_lx").get<double>(), below, 1e-9);
    EXPECT_NEAR(first.at("kernels_lx").get<double>(), below, 1e-4);
    EXPECT_NEAR(first.at("cut_off_at_most_lx").get<double>(), 6.25 * (1.0 - window), 1e-9);
    EXPECT_EQ(first.at("largest").at(0).at("name"), "0 point");
    EXPECT_EQ(first.at("largest").size(), 2u);
    EXPECT_NEAR(json.at("points").at(1).at("illuminance_lx").get<double>(), between, 1e-9);
    const Json& summary = json.at("summary");
    EXPECT_NEAR(summary.at("minimum_lx").get<double>(), below, 1e-9);
    EXPECT_NEAR(summary.at("mean_lx").get<double>(), 0.5 * (below + between), 1e-9);
    EXPECT_NEAR(summary.at("uniformity").get<double>(), below / (0.5 * (below + between)), 1e-9);
    EXPECT_NEAR(summary.at("ambient_apart_lx").get<double>(), 0.5 * 3.14159265358979, 1e-6);
    EXPECT_LE(summary.at("float64").at("largest_relative_error_of_kernels").get<double>(), 1e-5);
}

// Gains count once, by the kernels and in float64.
TEST_F(PhotometryCommand, HasTheGainsOfAMix) {
    const std::string file = points("0,0,0,0,1,0\n");
    const auto lux = [&](const Words& mix, const char* which) {
        Words words = {"--points", file, "--json"};
        words.insert(words.end(), mix.begin(), mix.end());
        const ChildResult result = run(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return Json::parse(result.out).at("points").at(0).at(which).get<double>();
    };
    const Words mix = {"--light-groups", "all=from:file", "--light-mix", "all=0.5"};
    for (const char* which : {"kernels_lx", "float64_lx"}) {
        EXPECT_NEAR(lux(mix, which), 0.5 * lux({}, which), 1e-5) << which;
    }
}

// The first of the two gives no light.
TEST_F(PhotometryCommand, LightsKeepTheirNumbers) {
    lamps_.replace(lamps_.find("100"), 3, "0");
    const ChildResult result = run({"--points", points("0,0,0,0,1,0\n"), "--json"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "1 unusable lights are left out")) << result.err;
    const Json largest = Json::parse(result.out).at("points").at(0).at("largest");
    ASSERT_EQ(largest.size(), 1u);
    EXPECT_EQ(largest.at(0).at("light"), 1);
    EXPECT_EQ(largest.at(0).at("name"), "1 point");
    EXPECT_EQ(largest.at(0).at("position"), Json({0.0, 4.0, 0.0}));
}

TEST_F(PhotometryCommand, WritesAPlaneAsCsv) {
    const auto file = folder_ / "lux.csv";
    const ChildResult result =
        run({"--plane=-2,-1,2,1,0,4,2", "-o", file.string(), "--exact-points", "2"});
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "uniformity")) << result.out;
    const TextTable table = parse_csv(text_of_file(file));
    ASSERT_EQ(table.rows.size(), 8u);
    EXPECT_EQ(table.columns.at(6), "illuminance [lx]");
    EXPECT_EQ(table.rows[0][0], "-1.5");
    EXPECT_EQ(table.rows[0][2], "0.5");
    EXPECT_EQ(table.rows[0][4], "1");
    EXPECT_EQ(table.rows[0][11], "0 point");
    EXPECT_EQ(table.rows[1][11], "");  // float64 computed points 0 and 4
    EXPECT_EQ(table.rows[4][11], "0 point");
}

// In parts, with one header.
TEST_F(PhotometryCommand, WritesManyPointsAsCsv) {
    const auto file = folder_ / "lux.csv";
    ASSERT_EQ(run({"--plane=0,0,10,1,0,5000,1", "-o", file.string()}).code, 0);
    const TextTable table = parse_csv(text_of_file(file));
    ASSERT_EQ(table.rows.size(), 5000u);
    for (std::size_t i = 0; i < 5000; ++i) {
        ASSERT_EQ(table.rows[i].size(), table.columns.size()) << i;
        ASSERT_NEAR(std::stod(table.rows[i][0]), (static_cast<double>(i) + 0.5) / 500.0, 1e-9);
    }
}

TEST_F(PhotometryCommand, WhatIsNotComparedHasNoError) {
    const Words words = {"--plane=0,0,1,1,0,2,1", "--exact-points", "0"};
    const ChildResult text = run(words);
    EXPECT_TRUE(contains(text.out, "on 0 points: kernels are not compared")) << text.out;
    const ChildResult result = run({words[0], words[1], words[2], "--json"});
    const Json float64 = Json::parse(result.out).at("summary").at("float64");
    EXPECT_TRUE(float64.at("largest_relative_error_of_kernels").is_null());
    EXPECT_TRUE(float64.at("largest_error_of_kernels_lx").is_null());
    EXPECT_EQ(float64.at("lit_by_one"), 0);
}

TEST_F(PhotometryCommand, AByteOrderMarkAndNamesAreLeftOut) {
    for (const char* names : {"", "x,y,z,nx,ny,nz\n", "X [m], Y [m], Z [m], NX, NY, NZ\r\n"}) {
        const std::string file = points(std::string("\xef\xbb\xbf") + names + "0,0,0,0,1,0\n");
        const ChildResult result = run({"--points", file, "--json"});
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(Json::parse(result.out).at("points").size(), 1u);
    }
}

TEST_F(PhotometryCommand, CapitalsNameTheResultsTypeToo) {
    const auto file = folder_ / "lux.JSON";
    ASSERT_EQ(run({"--plane=0,0,1,1,0,1,1", "-o", file.string()}).code, 0);
    EXPECT_EQ(Json::parse(text_of_file(file)).at("points").size(), 1u);
}

TEST_F(PhotometryCommand, CountsTheEnvironmentApart) {
    const std::string file = points("0,0,0,0,1,0\n");
    const ChildResult result = run({"--points", file, "--json", "--environment", "sky"});
    ASSERT_EQ(result.code, 0) << result.err;
    const Json json = Json::parse(result.out);
    EXPECT_GT(json.at("points").at(0).at("environment_lx").get<double>(), 0.0);
    EXPECT_EQ(json.at("summary").at("lights"), 2);
    EXPECT_LT(json.at("points").at(0).at("illuminance_lx").get<double>(), 32.0);
}

// As in pictures, they are lights where nothing else is.
TEST_F(PhotometryCommand, EmissiveSurfacesLightWithoutAnEnvironment) {
    Scene scene = box_scene({2.0, 3.0, 4.0});
    scene.lights.clear();
    scene.materials[0].emissive = glm::vec3(1.0f);
    const std::string file = (folder_ / "glow.glb").string();
    write_scene(scene, file);
    const Words words = {"photometry", file, "--plane=-2,-2,2,2,5,2,2", "--json"};
    const auto lights = [&](const Words& more) {
        Words all = words;
        all.insert(all.end(), more.begin(), more.end());
        const ChildResult result = run_kilolux(all);
        EXPECT_EQ(result.code, 0) << result.err;
        return Json::parse(result.out).at("summary").at("lights").get<int>();
    };
    EXPECT_EQ(lights({}), 6);
    EXPECT_EQ(lights({"--environment", "sky"}), 0);
    EXPECT_EQ(lights({"--environment", "sky", "--emissive-lights", "on"}), 6);
}

TEST_F(PhotometryCommand, BadInputIsALine) {
    expect_refused({}, 2, "photometry: needs one of --points FILE.csv and --plane");
    expect_refused({"--plane", "0,0,1,1,0,2,2", "--shadows", "exact"}, 2, "--shadows: photometry");
    expect_refused({"--plane", "0,0,1,1,0,2,2", "--tails", "tree"}, 2, "--tails: in photometry");
    expect_refused({"--plane", "0,0,1,1,0,2,2", "-o", "a.txt"}, 2, "'.txt' is none of .csv, .json");
    expect_refused({"--plane", "0,0,1"}, 2, "has 3 numbers, must have 7");
    expect_refused({"--plane", "0,0,1,1,0,2,nan"}, 2, "has 'nan', must be a finite number");
    expect_refused({"--plane", "1,0,0,1,0,2,2"}, 2, "must have X0 < X1");
    expect_refused({"--plane", "0,0,1,1,0,2,0.5"}, 2, "has 0.5 points along an edge");
    expect_refused({"--plane", "0,0,0,1,0,0,2,0,0,3,3"}, 2, "has edges in one line");
    expect_refused({"--plane", "0,0,0,1e155,0,0,0,0,1e155,3,3"}, 2,
                   "has a point at 1e+155,0,0, must be nearer than 1e+15 m to the origin");
    expect_refused({"--points", "nowhere.csv"}, 1, "nowhere.csv");
    const std::pair<std::string, std::string> files[] = {
        {"", "points.csv: has no points"},
        {"x,y,z,nx,ny,nz\n", "points.csv: has no points"},
        {"0,0,0,0,1,0\n1,2,3\n", "points.csv: line 2: has 3 fields, must have 6: x,y,z,nx,ny,nz"},
        {"0,0,0,0,0,0\n", "points.csv: line 1: the normal is 0,0,0, must have a direction"},
        {"0,0,-2e15,0,1,0\n", "points.csv: line 1: has a point at 0,0,-2e+15, must be nearer"},
        {"0,nan,0,0,1,0\n", "points.csv: line 1: y is 'nan', must be a finite number"},
        {"x,z,y,nx,ny,nz\n0,0,0,0,1,0\n",
         "points.csv: line 1: the columns are 'x,z,y,nx,ny,nz', must be x,y,z,nx,ny,nz"},
        {"px,py,pz,nx,ny,nz\n0,0,0,0,1,0\n",
         "points.csv: line 1: the columns are 'px,py,pz,nx,ny,nz', must be x,y,z,nx,ny,nz"},
        {"# a\n0,0,0,0,1,up\n", "points.csv: line 2: nz is 'up', must be a finite number"}};
    for (const auto& [text, why] : files) expect_refused({"--points", points(text)}, 1, why);
}

TEST(MeasuringGrid, ReadsBackAsItsText) {
    const MeasuringGrid plane = parse_plane("--plane", "0,1,4,7,0.8,3,2");
    EXPECT_EQ(text_of(plane), "0,0.8,7,4,0,0,0,0,-6,3,2");
    EXPECT_EQ(parse_plane("--plane", text_of(plane)), plane);
    const std::vector<MeasuringPoint> points = points_of(plane);
    ASSERT_EQ(points.size(), 6u);
    EXPECT_EQ(points[5].normal, glm::dvec3(0, 1, 0));
    EXPECT_NEAR(points[5].position.x, 10.0 / 3.0, 1e-12);
    EXPECT_NEAR(points[5].position.z, 2.5, 1e-12);
}

}  // namespace
}  // namespace kilolux
