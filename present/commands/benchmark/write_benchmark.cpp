// SPDX-License-Identifier: Apache-2.0
#include "present/commands/benchmark/write_benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host/base/source.h"
#include "host/base/system/atomic_write.h"
#include "host/base/system/interrupt.h"
#include "host/base/system/read_text.h"
#include "host/measure/report/references.h"
#include "host/scene/camera.h"
#include "host/scene/export/export_scene.h"
#include "host/scene/gltf/load_scene.h"
#include "host/scene/lights/light_kinds.h"
#include "present/cli/stats_json.h"
#include "present/commands/bench/bench.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kTexts = "present/commands/benchmark/text/";
constexpr const char* kLicense = "LICENSE.txt";

// Half of the last bit of float32, in which a picture's file holds its values.
constexpr double kFileRounding = 0x1p-24;
// Of float64 sums of points and spots, as a share of their unshadowed irradiance: less than 5000 of
// them reach a pixel, and each term and each addition rounds by 2^-53 a few times.
constexpr double kPointRounding = 1e-12;

std::string text_of(const char* name) { return embedded_text(std::string(kTexts) + name); }

void write_text_of(const fs::path& folder, const char* name) {
    write_atomically(folder / name, text_of(name));
}

std::string numbers(const glm::dvec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

// One line for each light; the first line names columns and units.
std::string light_table(const std::vector<SceneLight>& lights) {
    std::string out =
        "type,x_m,y_m,z_m,direction_x,direction_y,direction_z,side_x,side_y,side_z,"
        "red_cd,green_cd,blue_cd,range_m,inner_cone_rad,outer_cone_rad,width_m,height_m\n";
    for (const SceneLight& light : lights) {
        const LightKind& kind = kind_of(light);
        const auto if_has = [&](bool LightKind::*has, float value) {
            return kind.*has ? fmt::format("{}", value) : std::string();
        };
        out += fmt::format("{},{},", kind.name, numbers(light.position));
        out += kind.is_aimed ? numbers(light.direction) + ',' + numbers(light.side) : ",,,,,";
        out += fmt::format(",{},{},{},{}", light.intensity.x, light.intensity.y, light.intensity.z,
                           light.range);
        out += ',' + if_has(&LightKind::has_cone, light.inner_cone);
        out += ',' + if_has(&LightKind::has_cone, light.outer_cone);
        out += ',' + if_has(&LightKind::is_flat, light.width);
        out += ',' + if_has(&LightKind::is_flat, light.height) + '\n';
    }
    return out;
}

// The row's generated lights with nothing automatic.
LightOptions explicit_lights(const BenchmarkScene& row, const Scene& scene) {
    LightOptions out = row.generated_lights;
    if (out.count == 0) return out;
    const LightScale scale = automatic_light_scale(out, scene);
    out.radius = scale.radius;
    out.intensity = static_cast<double>(static_cast<float>(scale.intensity));
    out.box = scale.region.outer;
    return out;
}

Json generated_json(const LightOptions& lights) {
    const glm::dvec3 &low = lights.box.min, &high = lights.box.max;
    return {{"count", lights.count},
            {"seed", lights.seed},
            {"range_m", lights.radius},
            {"intensity_cd", lights.intensity},
            {"box_m", {low.x, low.y, low.z, high.x, high.y, high.z}}};
}

// The options that add the lights to a scene whose file lacks them.
std::string light_words(const LightOptions& lights) {
    if (lights.count == 0) return "";
    return fmt::format(
        " --lights {} --light-seed {} --light-radius {} --light-intensity {} "
        "--light-box={},{}",
        lights.count, lights.seed, lights.radius, lights.intensity, numbers(lights.box.min),
        numbers(lights.box.max));
}

Json camera_json(const SceneCamera& camera) {
    const glm::dmat4& m = camera.world_from_camera;
    return {{"name", camera.name},
            {"position_m", {m[3].x, m[3].y, m[3].z}},
            {"right", {m[0].x, m[0].y, m[0].z}},
            {"up", {m[1].x, m[1].y, m[1].z}},
            {"back", {m[2].x, m[2].y, m[2].z}},
            {"vertical_angle_rad", camera.y_fov}};
}

Frame frame_of(const RgbImage& image) {
    Frame out;
    out.width = image.width;
    out.height = image.height;
    for (const double value : image.rgb) out.radiance.push_back(static_cast<float>(value));
    return out;
}

// Writes the files of a row.
class RowWriter {
 public:
    RowWriter(const fs::path& folder, const BenchmarkScene& row,
              const std::function<void()>& advance)
        : folder_(folder), row_(row), advance_(advance), name_(row.name) {}

    // The row of views.json.
    Json write() {
        Scene made = row_.make();
        lights_ = explicit_lights(row_, made);
        const double aspect = static_cast<double>(row_.width) / row_.height;
        for (SceneCamera& camera : made.cameras) camera.aspect = aspect;
        if (!row_.by_formula) {
            const std::vector<SceneLight> points = generate_lights(lights_, made, 0.0);
            made.lights.insert(made.lights.end(), points.begin(), points.end());
            lights_.count = 0;
        }
        write_scene(made);
        Json out{{"name", name_}, {"about", row_.about}, {"scene", name_ + ".glb"}};
        out["lights"] = row_.by_formula ? "million_lights.py" : name_ + "_lights.csv";
        if (row_.by_formula) out["generated"] = generated_json(lights_);
        const Scene scene = load_scene(folder_ / (name_ + ".glb"));
        for (std::size_t view = 0; view < scene.cameras.size(); ++view) {
            out["views"].push_back(view_json(scene, view));
        }
        return out;
    }

 private:
    void write_scene(const Scene& scene) {
        for (const ExportedFile& part : export_scene(scene, name_ + ".glb").files) {
            write_atomically(folder_ / part.name, part.bytes);
        }
        if (row_.by_formula) {
            write_text_of(folder_, "million_lights.py");
        } else {
            write_atomically(folder_ / (name_ + "_lights.csv"), light_table(scene.lights));
        }
    }

    Json view_json(const Scene& scene, std::size_t view) {
        Json out = camera_json(scene.cameras[view]);
        out["width"] = row_.width;
        out["height"] = row_.height;
        for (const BenchmarkReference& model : benchmark_references().first(row_.reference_count)) {
            out["references"].push_back(write_reference(scene, view, model));
            advance_();
            check_interrupt();
        }
        return out;
    }

    Json write_reference(const Scene& scene, std::size_t view, const BenchmarkReference& model) {
        RenderSettings settings;
        settings.width = row_.width;
        settings.height = row_.height;
        settings.lights = lights_;
        settings.ambient = 0.0f;
        if (model.shadows) settings.shadows = Shadows::exact;
        ReportReferences references({scene, camera_of(scene.cameras[view])}, settings);
        references.on_step(check_interrupt);
        const ComparedReference& made =
            model.inverse_square ? references.unbounded() : references.surfaces(settings);
        const std::string file = fmt::format("{}_{}_{}.exr", name_, view, model.name);
        write_image(folder_ / file, frame_of(made.picture.radiance));
        const bool has_sizes = has_area_lights(scene.lights, settings.lights);
        const double of_lights = has_sizes ? ReferenceOptions().area_tolerance : kPointRounding;
        return {{"file", file},
                {"falloff", model.inverse_square ? "inverse square" : "range"},
                {"shadows", model.shadows},
                {"error_at_most_of_value", kFileRounding},
                {"error_at_most_of_lights", of_lights},
                {"score", score_command(view, model)}};
    }

    std::string score_command(std::size_t view, const BenchmarkReference& model) const {
        std::string out = fmt::format("kilolux score PICTURE.exr --scene {}.glb", name_);
        if (view > 0) out += fmt::format(" --camera-index {}", view);
        if (model.inverse_square) out += " --inverse-square";
        if (model.shadows) out += " --shadows exact";
        return out + light_words(lights_);
    }

    const fs::path& folder_;
    const BenchmarkScene& row_;
    const std::function<void()>& advance_;
    std::string name_;
    LightOptions lights_;  // those that the file lacks
};

}  // namespace

std::size_t reference_count(std::span<const BenchmarkScene> scenes) {
    std::size_t count = 0;
    for (const BenchmarkScene& row : scenes)
        count += row.make().cameras.size() * row.reference_count;
    return count;
}

void make_benchmark_folder(const fs::path& folder) {
    make_output_folder(folder);
    const fs::path license = folder / kLicense;
    std::error_code error;
    if (fs::is_empty(folder, error)) return;
    if (fs::exists(license, error) && read_text(license) == text_of(kLicense)) return;
    throw Error(folder.string() + ": holds other things than a benchmark; give a new folder");
}

void write_benchmark(const fs::path& folder, std::span<const BenchmarkScene> scenes,
                     const std::function<void()>& advance) {
    write_text_of(folder, kLicense);  // first: it marks the folder
    Json views{{"benchmark", "Kilolux many lights"},
               {"version", 1},
               {"license", "CC0-1.0"},
               {"units", "metres, candela, linear Rec. 709; Y is up"},
               {"scenes", Json::array()}};
    for (const BenchmarkScene& row : scenes) {
        views["scenes"].push_back(RowWriter(folder, row, advance).write());
    }
    write_json((folder / "views.json").string(), views);
    for (const char* name : {"README.md", "blender_view.py"}) write_text_of(folder, name);
}

}  // namespace kilolux
