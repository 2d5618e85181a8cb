// SPDX-License-Identifier: Apache-2.0
#include "present/commands/export.h"

#include <fmt/format.h>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "host/base/system/interrupt.h"
#include "host/base/text.h"
#include "host/images/images.h"
#include "host/scene/export/export_scene.h"
#include "host/scene/lights/light_generator.h"
#include "present/cli/option_builder.h"
#include "present/cli/progress.h"
#include "present/cli/refuse_others.h"
#include "present/cli/scene_choice.h"
#include "present/commands/benchmark/write_benchmark.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

std::string exported_file(const std::string&, const std::string& text) {
    const std::string extension = lower(fs::path(text).extension().string());
    if (extension == ".glb" || extension == ".gltf") return text;
    throw UsageError(
        fmt::format("--output: '{}': scene type '{}' is none of .glb, .gltf", text, extension));
}

// The picture's camera as the scene's first one, which readers show.
SceneCamera scene_camera(const Camera& camera, const RenderSettings& settings) {
    SceneCamera out = scene_camera_of(camera, "kilolux");
    out.aspect = static_cast<double>(settings.width) / settings.height;
    return out;
}

// Emissive surfaces are written, the lights that they are made into are not.
void warn_of_surfaces(const Scene& scene, const LightMix& mix) {
    const std::vector<SceneLight> mixed = mixed_lights(scene, mix);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < mixed.size(); ++i) {
        changed += mixed[i].of_surface && mixed[i].intensity != scene.lights[i].intensity ? 1 : 0;
    }
    if (changed == 0) return;
    warn(
        fmt::format("the light mix changes {} lights of emissive surfaces, which are not written: "
                    "other renderers show them as without the mix",
                    changed));
}

// The scene at its time, with the lights that the command line adds.
Scene scene_to_export(ExportOptions& options) {
    SharedOptions& shared = options.shared;
    Scene scene = open_scene(shared);
    const Camera camera = choose_camera(shared, scene);
    const RenderSettings& settings = shared.settings;
    warn_of_surfaces(scene, settings.light_mix);
    scene.lights = all_lights(scene, settings.lights, settings.light_mix, camera, shared.time);
    scene.cameras.insert(scene.cameras.begin(), scene_camera(camera, settings));
    return scene;
}

// glTF has no ambient light.
void warn_of_ambient(const SharedOptions& shared) {
    const bool of_rig = rig_ambient(shared.rig, 0.0f) > 0.0f;
    if (!shared.ambient_given && !of_rig) return;
    if (shared.settings.ambient <= 0.0f) return;
    warn(
        fmt::format("ambient light of {}{} is not written: glTF has none, other renderers show "
                    "the scene darker",
                    shared.settings.ambient, of_rig ? " of the rig studio" : ""));
}

std::string summary(const Scene& scene, const ExportedScene& exported, const fs::path& file) {
    std::size_t bytes = 0;
    for (const ExportedFile& part : exported.files) bytes += part.bytes.size();
    std::string files = file.string();
    if (exported.files.size() > 1) {
        files += fmt::format(" and {} files beside it", exported.files.size() - 1);
    }
    return fmt::format(
        "scene   {}, {} triangles, {} images\nlights  {} written, {} unusable left out\n"
        "wrote   {}, {} KiB",
        scene.name, triangle_count(scene), scene.images.size(), exported.lights,
        exported.unusable_lights, files, (bytes + 1023) / 1024);
}

void export_benchmark(const ExportOptions& options) {
    make_benchmark_folder(options.benchmark);
    load_image_library();
    const auto scenes = benchmark_scenes();
    Progress progress("references", reference_count(scenes), options.shared.shown_progress());
    write_benchmark(options.benchmark, scenes, [&progress] { progress.advance(); });
    note("wrote   " + options.benchmark.string());
}

void run_export(ExportOptions& options, const CLI::App& command) {
    if (!options.benchmark.empty()) {
        refuse_others(command, "--benchmark", "writes scenes of its own");
        begin_command(options.shared);
        return export_benchmark(options);
    }
    if (options.output.empty()) throw UsageError("--output: needs a file, e.g. -o scene.glb");
    begin_command(options.shared);
    check_can_write(options.output);
    const Scene scene = scene_to_export(options);
    warn_of_ambient(options.shared);
    check_interrupt();
    const ExportedScene exported = export_scene(scene, options.output);
    check_interrupt();
    for (const ExportedFile& part : exported.files) {
        write_atomically(options.output.parent_path() / part.name, part.bytes);
    }
    note(summary(scene, exported, options.output));
}

constexpr const char* kExportExamples =
    "  kilolux export -o atrium.glb --lights 1000\n"
    "  kilolux export hall.glb -o hall.gltf --lights 0 --camera-position 0,2,8\n"
    "  kilolux export walk.glb -o pose.glb --time 1.5 --lights 200\n"
    "  kilolux export --benchmark many_lights";

}  // namespace

void visit_settings(ExportOptions& options, const SettingVisitor& f) {
    visit_settings(options.shared, f);
    OptionBuilder(f, "Output")
        .value({"--output,-o", "FILE", "",
                "Scene: .glb holds everything, .gltf has its buffer and images beside it"},
               options.output, exported_file)
        .text({"--benchmark", "DIR", "",
               "In place of a scene: scenes of many lights with their views and float64 "
               "reference pictures, for `kilolux score`; minutes on two CPU cores"},
              options.benchmark);
}

void add_export_options(CLI::App& command, ExportOptions& options) {
    add_options(command, options);
    leave_to_help_all(command,
                      {"--renderer", "--samples", "--show", "--aov", "--gbuffer", "--shading",
                       "--ambient", "--exposure", "--tonemap", "--bloom", "--device"});
}

void add_export_command(Program& program) {
    program.add_command("export",
                        "Write the scene with all its lights as glTF 2.0, for any other renderer",
                        kExportExamples, add_export_options, run_export);
}

}  // namespace kilolux
