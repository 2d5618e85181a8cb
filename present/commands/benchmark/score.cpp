// SPDX-License-Identifier: Apache-2.0
#include "present/commands/benchmark/score.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "host/base/error.h"
#include "host/base/log.h"
#include "host/base/system/interrupt.h"
#include "host/base/text.h"
#include "host/images/images.h"
#include "host/images/rec709.h"
#include "host/measure/metrics/error_metrics.h"
#include "host/measure/metrics/flip_hdr.h"
#include "host/measure/metrics/lost_light.h"
#include "host/measure/report/references.h"
#include "host/scene/generated/scenes.h"
#include "present/cli/option_builder.h"
#include "present/cli/progress.h"
#include "present/cli/refuse_others.h"
#include "present/cli/scene_choice.h"
#include "present/cli/stats_json.h"
#include "present/image/read.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

void require_finite(const fs::path& file, const RgbImage& image) {
    std::size_t count = 0, first = 0;
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const double* rgb = &image.rgb[3 * i];
        if (std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2])) continue;
        if (count++ == 0) first = i;
    }
    if (count == 0) return;
    const auto width = static_cast<std::size_t>(image.width);
    throw Error(fmt::format("{}: {} pixels are NaN or infinite, the first one at {},{}",
                            file.string(), count, first % width, first / width));
}

// Throws Error for a part of a picture, which is of another view, and for other primaries.
void require_whole_rec709(const fs::path& file, const ImageLayout& layout) {
    if (layout.full_width > 0) {
        throw Error(fmt::format("{}: is {}x{} pixels of a picture of {}x{}; score needs all of it",
                                file.string(), layout.width, layout.height, layout.full_width,
                                layout.full_height));
    }
    constexpr float kRounding = 1e-3f;  // of the numbers that programs write
    const auto is_near = [](float a, float b) { return std::abs(a - b) <= kRounding; };
    const std::vector<float>& primaries = layout.chromaticities;
    if (primaries.empty() || std::ranges::equal(primaries, kRec709, is_near)) return;
    throw Error(fmt::format("{}: its primaries are {:.4g}; score needs those of Rec. 709, {:.4g}",
                            file.string(), fmt::join(primaries, " "), fmt::join(kRec709, " ")));
}

// A linear picture with channels R, G and B. Throws Error for any other.
RgbImage linear_picture(const fs::path& file) {
    if (image_meaning(file) != ImageMeaning::linear) {
        throw Error(file.string() +
                    ": holds display values; score needs linear ones, .exr or .hdr");
    }
    require_whole_rec709(file, open_image(file)->layout());
    const FloatImage image = read_image(file);
    const std::set<std::string> channels(image.channels.begin(), image.channels.end());
    for (const char* name : {"R", "G", "B"}) {
        if (channels.contains(name)) continue;
        throw Error(fmt::format("{}: has channels {}; score needs R, G and B", file.string(),
                                joined(image.channels)));
    }
    RgbImage out = rgb_image_of(image.width, image.height, colour_of(image));
    require_finite(file, out);
    return out;
}

// The options that the picture and the reference decide.
void settle_options(ScoreOptions& options, const CLI::App& command) {
    SharedOptions& shared = options.shared;
    refuse_if(shared.scene.empty() == options.reference.empty(),
              "score: needs one of --scene SCENE and --reference FILE");
    refuse_if(is_given(command, "--resolution"), "--resolution: the size is that of the picture");
    refuse_if(is_given(command, "--samples"), "--samples: the reference has the pixels' centres");
    refuse_others(command, "--reference", "is a picture, not a scene", {"PICTURE", "--json"});
    if (shared.settings.tails == Tails::automatic) shared.settings.tails = Tails::exact;
    if (!shared.ambient_given) shared.settings.ambient = 0.0f;
    shared.ambient_given = true;
    // A file is lit by its own lights and those that the command line adds.
    const bool is_file = !is_generated_scene(shared.scene);
    if (shared.rig == Rig::automatic && is_file) shared.rig = Rig::none;
}

// A picture of another shape than the camera's would be of another view.
void require_shape(const ScoreOptions& options, const Scene& scene, const RgbImage& picture) {
    const CameraChoice& choice = options.shared.camera;
    if (is_framed(choice, scene)) return;
    const auto index = static_cast<std::size_t>(choice.index.value_or(0));
    const double aspect = scene.cameras.at(index).aspect;
    if (aspect <= 0.0 || std::abs(picture.width - aspect * picture.height) <= 1.0) return;
    throw Error(fmt::format("{}: is {}x{} pixels; camera {} of {} is {:.5g} times as wide as high",
                            options.picture.string(), picture.width, picture.height, index,
                            options.shared.scene, aspect));
}

struct ScoreReference {
    RgbImage radiance;
    std::optional<RgbImage> scale;  // see ReferencePicture; none of a file
    std::string line;               // what it is
};

ScoreReference cast_reference(ScoreOptions& options, const RgbImage& picture) {
    SharedOptions& shared = options.shared;
    RenderSettings& s = shared.settings;
    s.width = picture.width;
    s.height = picture.height;
    const Scene scene = open_scene(shared);
    const Camera camera = choose_camera(shared, scene);
    require_shape(options, scene, picture);
    const std::size_t lights = scene.lights.size() + s.lights.count;
    if (lights == 0) throw Error(shared.scene + ": has no lights; --lights N adds some");
    const Progress progress("reference", 1, shared.shown_progress());
    ReportReferences references({scene, camera, shared.time}, s);
    references.on_step(check_interrupt);
    const auto& made = options.inverse_square ? references.unbounded() : references.surfaces(s);
    return {made.picture.radiance, made.picture.scale,
            fmt::format("{}, {} lights, float64 at the pixels' centres, {}, {}", shared.scene,
                        lights, options.inverse_square ? "inverse square" : "the lights' ranges",
                        s.shadows == Shadows::off ? "no shadows" : "shadows")};
}

ScoreReference read_reference(const ScoreOptions& options, const RgbImage& picture) {
    const fs::path& file = options.reference;
    RgbImage radiance = linear_picture(file);
    if (radiance.width != picture.width || radiance.height != picture.height) {
        throw Error(fmt::format("{}: is {}x{} pixels, the reference {} {}x{}",
                                options.picture.string(), picture.width, picture.height,
                                file.string(), radiance.width, radiance.height));
    }
    return {std::move(radiance), std::nullopt, file.string()};
}

// A share of no light is not defined.
void require_light(const ScoreReference& reference) {
    const std::vector<double>& values = reference.radiance.rgb;
    if (std::ranges::any_of(values, [](double value) { return value > 0.0; })) return;
    throw Error("the reference is black: " + reference.line);
}

struct Score {
    PictureErrors errors;  // of the linear picture
    LostLight light;
};

Score score_of(const RgbImage& picture, const ScoreReference& reference) {
    Score out;
    const RgbImage* scale = reference.scale ? &*reference.scale : nullptr;
    out.errors.hdr = compare_hdr(picture, reference.radiance, {.scale = scale});
    out.errors.flip = flip_hdr(picture, reference.radiance).error;
    out.light = lost_light(picture, reference.radiance);
    return out;
}

nlohmann::ordered_json score_json(const ScoreOptions& options, const RgbImage& picture,
                                  const ScoreReference& reference, const Score& score) {
    nlohmann::ordered_json out{{"picture", options.picture.string()},
                               {"reference", reference.line},
                               {"width", picture.width},
                               {"height", picture.height}};
    for (const ErrorMetric& metric : error_metrics()) {
        if (metric.part == MetricPart::display) continue;
        out[std::string(metric.name)] = *metric.value(score.errors);
    }
    out["lost-light"] = score.light.lost;
    out["added-light"] = score.light.added;
    out["losing-pixels"] = score.light.losing;
    return out;
}

std::string score_text(const ScoreOptions& options, const RgbImage& picture,
                       const ScoreReference& reference, const Score& score) {
    const HdrMetrics& hdr = score.errors.hdr;
    const LostLight& light = score.light;
    std::string out = fmt::format("picture    {}, {}x{}\nreference  {}\n", options.picture.string(),
                                  picture.width, picture.height, reference.line);
    out += fmt::format("rmse       {:.3g}, largest difference {:.3g} at {}\n", hdr.rmse,
                       hdr.absolute.max, pixel_text(hdr.absolute));
    out += fmt::format("relmse     {:.3g}\n", hdr.rel_mse);
    out += fmt::format("flip       {:.3g}, 99.9 % of the pixels at most {:.3g}\n",
                       score.errors.flip.mean, score.errors.flip.percentile_99_9);
    out += fmt::format("lost       {:.3g} % of the light", 100.0 * light.lost);
    if (light.lost > 0.0) out += fmt::format(", most at {},{}", light.x, light.y);
    out += fmt::format("; {:.3g} % of the lit pixels lack more than {:.0f} %\n",
                       100.0 * light.losing, 100.0 * kLosingShare);
    out += fmt::format("added      {:.3g} %\n", 100.0 * light.added);
    return out;
}

void run_score(ScoreOptions& options, const CLI::App& command) {
    settle_options(options, command);
    check_progress(options.shared.progress, options.json);
    begin_command(options.shared);
    const RgbImage picture = linear_picture(options.picture);
    const ScoreReference reference = options.reference.empty() ? cast_reference(options, picture)
                                                               : read_reference(options, picture);
    require_light(reference);
    const Score score = score_of(picture, reference);
    const auto document =
        options.json ? score_json(options, picture, reference, score) : nlohmann::ordered_json();
    print_result(options.json, document, score_text(options, picture, reference, score));
}

constexpr const char* kScoreExamples =
    "  kilolux score mine.exr --scene street.glb\n"
    "  kilolux score mine.exr --scene street.glb --camera-index 1 --inverse-square --json\n"
    "  kilolux score mine.exr --reference street_0_range.exr";

}  // namespace

void visit_settings(ScoreOptions& options, const SettingVisitor& f) {
    visit_settings(options.shared, [&f](Setting setting) {
        if (setting.option() == "SCENE") setting.text.name = "--scene";
        f(setting);
    });
    OptionBuilder(f, "Reference and output")
        .input_file({"--reference", "FILE", "",
                     "A reference picture in place of one of --scene: .exr or .hdr, linear"},
                    options.reference)
        .flag("--inverse-square", options.inverse_square,
              "Compare with lights that have no range, as path tracers' lights have none")
        .flag("--json", options.json, "JSON instead of text on standard output");
}

void add_score_options(CLI::App& command, ScoreOptions& options) {
    command
        .add_option("PICTURE", options.picture,
                    "The picture of any renderer: linear Rec. 709, .exr or .hdr")
        ->required()
        ->type_name("FILE");
    add_options(command, options);
    leave_to_help_all(command, {"--renderer", "--resolution", "--samples", "--show", "--aov",
                                "--gbuffer", "--exposure", "--tonemap", "--bloom", "--background",
                                "--reflections", "--device", "--shadow-rays"});
}

void add_score_command(Program& program) {
    program.add_command("score",
                        "Compare the linear picture of any renderer with a float64 reference",
                        kScoreExamples, add_score_options, run_score);
}

}  // namespace kilolux
