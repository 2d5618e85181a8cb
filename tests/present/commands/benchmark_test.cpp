// SPDX-License-Identifier: Apache-2.0
// `kilolux export --benchmark` and `kilolux score`, small: the scenes of the benchmark with fewer
// pixels and lights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>

#include "host/base/text.h"
#include "host/measure/reference/ray_cast_reference.h"
#include "host/measure/report/picture_errors.h"
#include "host/scene/gltf/load_scene.h"
#include "host/scene/lights/light_kinds.h"
#include "present/commands/benchmark/write_benchmark.h"
#include "present/image/image_file.h"
#include "present/image/read.h"
#include "tests/support/child.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

constexpr int kViewWidth = 32, kViewHeight = 18;

std::vector<BenchmarkScene> small_rows() {
    const auto rows = benchmark_scenes();
    std::vector<BenchmarkScene> out(rows.begin(), rows.end());
    for (BenchmarkScene& row : out) {
        row.width = kViewWidth;
        row.height = kViewHeight;
        auto& count = row.generated_lights.count;
        count = std::min<std::uint64_t>(count, 2000);
    }
    std::ranges::find_if(out, &BenchmarkScene::by_formula)->generated_lights.radius = 6.0;
    return out;
}

// The small benchmark, written once.
class Benchmark : public testing::Test {
 protected:
    static void SetUpTestSuite() {
        folder_ = new TemporaryFolder;
        write_benchmark(folder(), small_rows(), [] { ++steps_; });
    }
    static void TearDownTestSuite() {
        delete folder_;
        folder_ = nullptr;
    }
    static fs::path folder() { return folder_->path(); }
    static std::string file(const std::string& name) { return (folder() / name).string(); }
    static Json scenes() { return Json::parse(text_of_file(folder() / "views.json")).at("scenes"); }

    // The result of a score that must succeed.
    static Json score(Words words) {
        words.insert(words.begin(), "score");
        words.push_back("--json");
        const ChildResult result = run_kilolux(words);
        EXPECT_EQ(result.code, 0) << result.err;
        return result.code == 0 ? Json::parse(result.out) : Json();
    }

    static TemporaryFolder* folder_;
    static std::size_t steps_;
};

TemporaryFolder* Benchmark::folder_ = nullptr;
std::size_t Benchmark::steps_ = 0;

// The words of a command of views.json for a picture, without "kilolux score PICTURE.exr --scene
// NAME.glb".
Words words_behind_scene(const std::string& command) {
    Words out;
    const auto words = split(command, ' ');
    for (std::size_t i = 5; i < words.size(); ++i) out.emplace_back(words[i]);
    return out;
}

TEST_F(Benchmark, EveryFileIsInTheJsonAndTheSameRowsGiveTheSameBytes) {
    std::size_t references = 0;
    const std::vector<BenchmarkScene> rows = small_rows();
    const Json made = scenes();
    ASSERT_EQ(made.size(), rows.size());
    for (const Json& scene : made) {
        EXPECT_TRUE(fs::exists(file(scene.at("scene"))));
        EXPECT_TRUE(fs::exists(file(scene.at("lights"))));
        for (const Json& view : scene.at("views")) {
            references += view.at("references").size();
            for (const Json& reference : view.at("references")) {
                EXPECT_EQ(image_size(file(reference.at("file"))),
                          std::pair(kViewWidth, kViewHeight));
            }
        }
    }
    EXPECT_EQ(references, reference_count(rows));
    EXPECT_EQ(references, steps_);
    for (const char* name : {"README.md", "LICENSE.txt", "blender_view.py", "million_lights.py"}) {
        EXPECT_GT(fs::file_size(file(name)), 0u);
    }
    const TemporaryFolder again;
    write_benchmark(again.path(), rows, [] {});
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder())) {
        ++files;
        EXPECT_TRUE(text_of_file(entry.path()) == text_of_file(again / entry.path().filename()))
            << entry.path();
    }
    EXPECT_EQ(files, 2 * rows.size() + references + 4);
}

// What the file holds is the float64 reference of the scene's file, rounded once.
TEST_F(Benchmark, ReferencesAreThoseOfTheirCommands) {
    for (const Json& scene : scenes()) {
        for (const Json& reference : scene.at("views").back().at("references")) {
            Words words = words_behind_scene(reference.at("score"));
            words.insert(words.begin(),
                         {file(reference.at("file")), "--scene", file(scene.at("scene"))});
            const Json found = score(words);
            EXPECT_LE(found.at("max-relative").get<double>(),
                      1.0001 * reference.at("error_at_most_of_value").get<double>())
                << reference;
            EXPECT_GT(found.at("psnr-peak").get<double>(), 0.1) << reference;
        }
    }
}

// Our own picture of each first view, with float32 surfaces and every light.
TEST_F(Benchmark, OurOwnPicturesScoreWell) {
    for (const Json& scene : scenes()) {
        const std::string picture = file("own.exr"), glb = file(scene.at("scene"));
        const Json reference = scene.at("views").at(0).at("references").at(0);
        const Words lights = words_behind_scene(reference.at("score"));
        Words words{"render",    glb,    "-o",    picture, "--resolution", "32,18",
                    "--gbuffer", "full", "--rig", "none",  "--ambient",    "0"};
        words.insert(words.end(), lights.begin(), lights.end());
        const ChildResult made = run_kilolux(words);
        ASSERT_EQ(made.code, 0) << made.err;
        const Json found = score({picture, "--reference", file(reference.at("file"))});
        EXPECT_LE(found.at("relmse").get<double>(), 1e-5) << scene.at("name");
        EXPECT_LE(found.at("lost-light").get<double>(), 1e-4) << scene.at("name");
        EXPECT_LE(found.at("added-light").get<double>(), 1e-4) << scene.at("name");
        fs::remove(picture);
    }
}

// The picture of a renderer that keeps `cap` lights of a block of pixels, the first ones that
// reach one of them.
RgbImage capped_picture(const Scene& scene, std::size_t cap, int block) {
    const Camera camera = camera_of(scene.cameras.at(0));
    const SurfaceSamples all = RayCaster(scene).cast(camera, kViewWidth, kViewHeight);
    const ReferenceLights lights = reference_lights(scene.lights, camera);
    const ReferenceOptions options;
    RgbImage out = make_rgb_image(kViewWidth, kViewHeight);
    for (int top = 0; top < kViewHeight; top += block) {
        for (int left = 0; left < kViewWidth; left += block) {
            const int width = std::min(block, kViewWidth - left),
                      height = std::min(block, kViewHeight - top);
            SurfaceSamples part = make_surface_samples(width, height);
            for (int y = 0; y < height; ++y) {
                for (int x = 0; x < width; ++x) part.at(x, y) = all.at(left + x, top + y);
            }
            ReferenceLights kept;
            for (const ReferenceLight& light : lights.lights) {
                const auto reaches = [&](const SurfaceSample& s) {
                    return s.kind == SurfaceKind::lit &&
                           incidence(light, s.position, options).attenuation > 0.0;
                };
                if (kept.lights.size() < cap && std::ranges::any_of(part.pixels, reaches)) {
                    kept.lights.push_back(light);
                }
            }
            const RgbImage lit = shade_reference(part, kept, options).radiance;
            for (int y = 0; y < height; ++y) {
                const auto from = 3 * part.index(0, y), to = 3 * all.index(left, top + y);
                std::copy_n(lit.rgb.begin() + static_cast<std::ptrdiff_t>(from), 3 * width,
                            out.rgb.begin() + static_cast<std::ptrdiff_t>(to));
            }
        }
    }
    return out;
}

void write_exr(const fs::path& file, const RgbImage& image) {
    Frame frame;
    frame.width = image.width;
    frame.height = image.height;
    frame.radiance.assign(image.rgb.begin(), image.rgb.end());
    write_image(file, frame);
}

double sum_of(const RgbImage& image) {
    return std::accumulate(image.rgb.begin(), image.rgb.end(), 0.0);
}

// Lights dropped by a cap are lost light: exactly what the picture lacks, and no pixel gains.
TEST_F(Benchmark, ACapOfLightsIsSeen) {
    const Scene scene = load_scene(file("lantern_forest.glb"));
    const RgbImage all = capped_picture(scene, scene.lights.size(), 8);
    const RgbImage capped = capped_picture(scene, 8, 8);
    write_exr(file("all.exr"), all);
    write_exr(file("capped.exr"), capped);
    const std::string glb = file("lantern_forest.glb");
    const Json whole = score({file("all.exr"), "--scene", glb});
    EXPECT_LE(whole.at("max-relative").get<double>(), 1e-7);
    EXPECT_EQ(whole.at("losing-pixels"), 0.0);
    const Json lossy = score({file("capped.exr"), "--scene", glb});
    const double lost = 1.0 - sum_of(capped) / sum_of(all);
    EXPECT_GT(lost, 0.05);
    EXPECT_NEAR(lossy.at("lost-light").get<double>(), lost, 1e-6);
    EXPECT_LE(lossy.at("added-light").get<double>(), 1e-7);
    EXPECT_GT(lossy.at("losing-pixels").get<double>(), 0.1);
    fs::remove(file("all.exr"));
    fs::remove(file("capped.exr"));
}

// The script's lights are the generator's.
TEST_F(Benchmark, TheScriptComputesTheLightsOfTheMillion) {
    const std::vector<BenchmarkScene> rows = small_rows();
    const auto row = std::ranges::find_if(rows, &BenchmarkScene::by_formula);
    const auto lights = generate_lights(row->generated_lights, row->make(), 0.0);
    const ChildResult result =
        run_child({"/usr/bin/python3", file("million_lights.py"), std::to_string(lights.size())});
    ASSERT_EQ(result.code, 0) << result.err;
    const auto lines = split(trim(result.out), '\n');
    ASSERT_EQ(lines.size(), lights.size() + 1);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto words = split(lines[i + 1], ',');
        ASSERT_EQ(words.size(), 8u);
        const auto number = [&](std::size_t k) { return number_of<double>(words[k]).value(); };
        const SceneLight& light = lights[i];
        EXPECT_EQ(glm::dvec3(number(1), number(2), number(3)), light.position) << i;
        EXPECT_EQ(glm::dvec3(number(4), number(5), number(6)), glm::dvec3(light.intensity)) << i;
        EXPECT_EQ(number(7), double{light.range});
    }
}

// What a light's row must hold; a column that the kind lacks is empty.
std::map<std::string, std::optional<double>> columns_of(const SceneLight& light) {
    const LightKind& kind = kind_of(light);
    const auto if_has = [](bool has, double value) {
        return has ? std::optional(value) : std::nullopt;
    };
    std::map<std::string, std::optional<double>> out = {
        {"red_cd", light.intensity.x},
        {"green_cd", light.intensity.y},
        {"blue_cd", light.intensity.z},
        {"range_m", light.range},
        {"inner_cone_rad", if_has(kind.has_cone, light.inner_cone)},
        {"outer_cone_rad", if_has(kind.has_cone, light.outer_cone)},
        {"width_m", if_has(kind.is_flat, light.width)},
        {"height_m", if_has(kind.is_flat, light.height)}};
    for (int axis = 0; axis < 3; ++axis) {
        const std::string name(1, "xyz"[axis]);
        out[name + "_m"] = light.position[axis];
        out["direction_" + name] = if_has(kind.is_aimed, light.direction[axis]);
        // The roll of a spot is not in its file.
        const double side = kind.is_flat ? light.side[axis] : std::nan("");
        out["side_" + name] = if_has(kind.is_aimed, side);
    }
    return out;
}

TEST_F(Benchmark, LightTablesHaveEveryLight) {
    for (const char* name : {"street", "panel_wall", "lantern_forest", "metal_hall"}) {
        const Scene scene = load_scene(file(std::string(name) + ".glb"));
        const std::string text = text_of_file(file(std::string(name) + "_lights.csv"));
        const auto lines = split(trim(text), '\n');
        ASSERT_EQ(lines.size(), scene.lights.size() + 1) << name;
        const auto names = split(lines[0], ',');
        for (std::size_t i = 0; i < scene.lights.size(); i += 17) {
            const auto words = split(trim(lines[i + 1]), ',');
            const auto expected = columns_of(scene.lights[i]);
            ASSERT_EQ(words.size(), names.size()) << name;
            ASSERT_EQ(names.size(), expected.size() + 1) << "type, too";
            EXPECT_EQ(words[0], kind_of(scene.lights[i]).name);
            for (std::size_t column = 1; column < names.size(); ++column) {
                const auto& value = expected.at(std::string(names[column]));
                const auto seen = number_of<double>(words[column]);
                ASSERT_EQ(seen.has_value(), value.has_value()) << name << ' ' << names[column];
                // The file's intensities are the product of a colour and a number.
                if (!value || std::isnan(*value)) continue;
                EXPECT_NEAR(*seen, *value, 1e-6 * std::abs(*value)) << names[column];
            }
        }
    }
}

// Scripts of other renderers take their cameras from views.json.
TEST_F(Benchmark, ViewsHaveTheCamerasOfTheFile) {
    for (const Json& row : scenes()) {
        const Scene scene = load_scene(file(row.at("scene")));
        ASSERT_EQ(row.at("views").size(), scene.cameras.size());
        for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
            const Json& view = row.at("views")[i];
            const glm::dmat4& world = scene.cameras[i].world_from_camera;
            const char* const names[] = {"right", "up", "back", "position_m"};
            for (int column = 0; column < 4; ++column) {
                for (int axis = 0; axis < 3; ++axis) {
                    EXPECT_EQ(view.at(names[column])[axis], world[column][axis]) << row.at("name");
                }
            }
            EXPECT_EQ(view.at("vertical_angle_rad"), scene.cameras[i].y_fov);
        }
    }
}

TEST(ExportBenchmark, TakesNoOptionsOfAScene) {
    const TemporaryFolder folder;
    const std::string set = (folder / "set").string();
    const ChildResult result = run_kilolux({"export", "--benchmark", set, "--lights", "5"});
    EXPECT_EQ(result.code, 2);
    EXPECT_TRUE(contains(result.err, "it does not go with --lights")) << result.err;
    EXPECT_FALSE(fs::exists(set));
}

// A README.md of somebody else stays; a benchmark is made again in its folder.
TEST(ExportBenchmark, NeedsAFolderOfItsOwn) {
    const TemporaryFolder folder;
    make_benchmark_folder(folder / "new");
    EXPECT_TRUE(fs::is_directory(folder / "new"));
    write_benchmark(folder / "new", {}, [] {});
    make_benchmark_folder(folder / "new");
    write_atomically(folder / "README.md", "mine");
    const ChildResult result = run_kilolux({"export", "--benchmark", folder.path().string()});
    EXPECT_EQ(result.code, 1);
    EXPECT_TRUE(contains(result.err, "holds other things than a benchmark")) << result.err;
    EXPECT_EQ(text_of_file(folder / "README.md"), "mine");
}

}  // namespace
}  // namespace kilolux
