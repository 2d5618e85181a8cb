// SPDX-License-Identifier: Apache-2.0
#include "present/commands/render.h"

#include <fmt/format.h>
#include <memory>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/atomic_write.h"
#include "host/render/whole_picture.h"
#include "present/cli/frame_summary.h"
#include "present/cli/option_builder.h"
#include "present/cli/option_values.h"
#include "present/cli/options.h"
#include "present/cli/output_options.h"
#include "present/cli/sequence.h"
#include "present/commands/camera_motion.h"
#include "present/commands/devices/device_choice.h"
#include "present/commands/devices/device_share.h"
#include "present/commands/devices/picture_by_rows.h"
#include "present/commands/made_picture.h"
#include "present/commands/picture_files.h"
#include "present/commands/render_tasks.h"
#include "present/commands/scene_renderer.h"
#include "present/image/comparison.h"
#include "present/image/image_file.h"
#include "present/video/video_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

// Exposes by the sequence's first frame, also in a shard that does not contain it.
void expose_automatically(const RenderOptions& options, SceneRenderer& pictures) {
    const OutputOptions& out = options.output;
    const double time = options.shared.time;
    if (!out.frames) return pictures.expose_automatically(time);
    const int first = out.frames->first();
    pictures.expose_automatically(time + first / out.frames_per_second, first,
                                  ", of the sequence's first frame");
}

// Checks before rendering what would otherwise fail after it.
void check_files(const RenderOptions& options, const PictureTasks& tasks,
                 const PictureTask& first) {
    const OutputOptions& out = options.output;
    if (is_video(out.output)) {
        check_can_write_video(out.output);
    } else {
        check_can_write_image(first.file);
    }
    if (!out.difference.empty()) check_can_write_image(first.difference);
    if (!out.stats.empty() && out.stats != "-") check_can_write(out.stats);
    if (out.reference.empty()) return;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const fs::path reference = tasks[i].reference;
        if (!fs::exists(reference)) throw Error(reference.string() + ": no such reference");
    }
    const auto [width, height] = written_size(options.shared.settings, first.crop);
    require_reference_size(first.reference, width, height);
}

// Says which options change only what a display shows.
void warn_of_linear_light(const RenderOptions& options) {
    if (is_for_the_eye(options.output.output)) return;
    const SharedOptions& shared = options.shared;
    std::vector<std::string> words;
    if (shared.automatic_exposure || shared.settings.exposure != 0.0f)
        words.push_back("--exposure");
    if (shared.tone_curve_given) words.push_back("--tonemap");
    if (shared.settings.bloom > 0.0f) words.push_back("--bloom");
    if (words.empty()) return;
    note(fmt::format("{}: holds linear light, which {} {} not change",
                     options.output.output.string(), fmt::join(words, " and "),
                     words.size() == 1 ? "does" : "do"));
}

// Whether the picture has transparent background: --background none, where the format has alpha.
// Bloom reaches beyond surfaces, and debug views show no light, so neither has.
bool wants_alpha(const RenderOptions& options) {
    const SharedOptions& shared = options.shared;
    return shared.background.kind == BackgroundChoice::Kind::none &&
           !is_video(options.output.output) && holds_alpha(options.output.output) &&
           !needs_whole_picture(shared.settings) && shared.settings.want.view == ViewKind::lit &&
           !shared.show_error;
}

// Statistics and summary of the pictures. Throws where one failed its comparison, or a device was
// left out.
void report_pictures(const RenderOptions& options, SceneRenderer& pictures,
                     const MadePictures& made) {
    const OutputOptions& out = options.output;
    const WrittenPictures& written = made.written;
    if (!out.stats.empty()) {
        nlohmann::ordered_json stats = pictures.stats(written.last, false);
        if (!made.shares.empty()) stats["devices"] = shares_json(made.shares);
        write_json(out.stats, stats, written.log ? &*written.log : nullptr);
    }
    const Renderer& renderer = pictures.renderer();
    note(frame_summary(written.last, {written.count, renderer.gpu().programs->build_seconds(),
                                      options.shared.verbose}));
    if (!made.shares.empty()) note(share_lines(made.shares));
    std::string failures = failures_of(made.shares);
    if (!failures.empty()) failures += "; the other devices made the rest";
    if (!written.first_failure.empty()) {
        if (!failures.empty()) warn(failures);
        throw ComparisonFailed(written.first_failure);
    }
    if (!failures.empty()) throw Error(failures);
}

// Leaves the first of several devices in the settings. Returns the others.
std::vector<std::string> take_devices(RenderOptions& options) {
    std::string& device = options.shared.settings.device;
    std::vector<std::string> devices = devices_of(device, options.output.mixed_devices);
    device = devices.front();
    devices.erase(devices.begin());
    return devices;
}

// Renders and writes the pictures from `begin` on.
void render_from(RenderOptions& options, const PictureTasks& tasks, std::size_t begin,
                 const std::vector<std::string>& others) {
    const OutputOptions& out = options.output;
    const PictureTask first = tasks[begin];
    const CameraMotion motion(options.shared, out);
    const auto camera = [&motion](const Scene& scene, int frame, double time) {
        return motion.at(scene, frame, time);
    };
    const bool is_one_crop = tasks.size() - begin == 1 && first.crop.has_value();
    std::vector<std::string> more_devices = is_one_crop ? std::vector<std::string>{} : others;
    if (more_devices.size() < others.size()) note("device  one device makes a crop");
    FirstPicture start{request_of(options, options.shared.settings.want), first.time, first.number,
                       camera};
    DeviceHelpers* helpers = nullptr;  // of a single picture
    if (!more_devices.empty() && tasks.size() - begin == 1) {
        start.want.strip_makers *= static_cast<int>(1 + more_devices.size());
        start.on_lit = [&](const Scene& scene,
                           const RenderSettings& settings) -> std::shared_ptr<void> {
            if (!has_rows_to_share(settings)) {
                note("device  OpenGL lights surfaces: one device makes the whole picture");
                return nullptr;
            }
            auto made = std::make_shared<DeviceHelpers>(more_devices);
            made->start(scene, settings);
            helpers = made.get();
            return made;
        };
    }
    SceneRenderer pictures(options.shared, options.budget, start);
    if (helpers != nullptr) helpers->wait_until_ready();
    // Before the frames, which may take minutes.
    note(picture_header(pictures.renderer()));
    note(pictures.rig_lines());
    if (options.shared.automatic_exposure) expose_automatically(options, pictures);
    report_pictures(options, pictures,
                    helpers != nullptr
                        ? render_with_helpers(options, first, pictures, *helpers)
                        : render_tasks(options, tasks, begin, pictures, start, more_devices));
}

// The command of the picture, and of each of its tiles as a crop.
void note_commands(RenderOptions& options) {
    options.command = picture_command(options);
    if (!options.output.tiles) return;
    RenderOptions one = options;
    const TileGrid tiles = *std::exchange(one.output.tiles, std::nullopt);
    const RenderSettings& s = options.shared.settings;
    for (int i = 0; i < tiles.columns * tiles.rows; ++i) {
        one.output.crop = tile_rect(tiles, i, s.width, s.height);
        options.tiles.push_back({*one.output.crop, picture_command(one)});
    }
}

void run_render(RenderOptions& options) {
    const OutputOptions& out = options.output;
    check_output_options(options.shared, out);
    const std::vector<std::string> more_devices = take_devices(options);
    note_commands(options);
    options.has_alpha = wants_alpha(options);  // lighting the scene may change the background
    begin_command(options.shared, !out.reference.empty());
    check_budget(options.shared, options.budget);
    options.shared.takes_light_layers = !is_video(out.output) && holds_layers(out.output);
    const std::string inputs = inputs_comment(options);
    options.command += inputs;
    for (PictureTile& tile : options.tiles) tile.command += inputs;
    note_shard(out.shard);
    const PictureTasks tasks(options);
    if (tasks.size() == 0) {
        return note(fmt::format(
            "nothing to render: shard {} has none of the {}", text_of(out.shard),
            out.tiles ? "tiles " + text_of(*out.tiles) : "frames " + text_of(*out.frames)));
    }
    const std::size_t begin = tasks.first_to_do();
    if (begin == tasks.size()) return note("nothing to render: every file is there");
    const PictureTask first = tasks[begin];
    check_files(options, tasks, first);
    std::vector<std::string> devices = more_devices;
    devices.push_back(options.shared.settings.device);
    share_memory(options.shared.settings, devices);
    check_light_memory(options.shared.lights_given ? options.shared.settings.lights.count : 0,
                       options.shared.settings);
    warn_of_linear_light(options);
    render_from(options, tasks, begin, more_devices);
}

constexpr const char* kRenderExamples =
    "  kilolux render -o atrium.png\n"
    "  kilolux render -o atrium.exr --lights 100000 --aov depth,normal,light-count\n"
    "  kilolux render town.glb -o town.png --lights 0 --camera-index 1 --resolution 3840x2160\n"
    "  kilolux render mug.glb -o turn.###.png --frames 0:119 --turntable 360\n"
    "  kilolux render -o frame.####.exr --frames 0:239 --fps 24 --shard 3/8 --skip-existing\n"
    "  kilolux render -o flight.mp4 --frames 0:239 --fps 24\n"
    "  kilolux render -o - --frames 0:239 --quiet | mpv -\n"
    "  kilolux render -o now.exr --reference all.exr --threshold 0 --difference where.png\n"
    "  kilolux render -o atrium.png --stats - --quiet";

}  // namespace

void add_render_options(CLI::App& command, RenderOptions& options) {
    options.shared.takes_automatic_exposure = true;
    options.shared.takes_automatic_samples = true;
    options.shared.shows_environment = true;
    add_options(command, options);
}

void add_render_command(Program& program) {
    program.add_command("render", "Render a scene to an image file, a sequence of them or a video",
                        kRenderExamples, add_render_options, run_render);
}

}  // namespace kilolux
