// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/session.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "host/base/error.h"
#include "host/base/system/interrupt.h"
#include "present/cli/names.h"
#include "present/cli/scene_choice.h"
#include "present/window/app/command_text.h"
#include "present/window/panel/key_bindings.h"
#include "present/window/panel/panel_groups.h"
#include "present/window/panel/panel_lights.h"
#include "present/window/panel/panel_settings.h"
#include "present/window/panel/panel_stats.h"
#include "raster/gl_context.h"

namespace kilolux {
namespace {

constexpr double kIdleSeconds = 0.25;  // signals are checked that often
constexpr double kBusySeconds = 0.1;   // while a thread works; its end wakes the loop
constexpr std::chrono::milliseconds kStopPatience(200);
constexpr int kSmallestKept = 64;  // [pixel] of the window's edges, from run to run

// What a command line cannot say.
std::string unsaid_lights(std::size_t changed) {
    return changed == 0 ? "" : fmt::format(" without the changes of {} lights", changed);
}

}  // namespace

ViewState first_state(const SharedOptions& asked, const SharedOptions& lit) {
    ViewState state;
    state.rig = asked.rig;
    state.emissive_lights = asked.emissive_lights;
    state.settings = lit.settings;
    // The session chooses anew where they are automatic.
    state.settings.tails = asked.settings.tails;
    state.settings.range_budget = asked.settings.range_budget;
    state.settings.background = lit.shown_background;
    state.settings.reflections = lit.maps;
    state.settings.want.aovs.clear();
    state.settings.want.probes = true;
    state.settings.want.radiance = false;
    return state;
}

ViewSession::ViewSession(AnimatedScene& scene, SessionOptions options, StateFile& file,
                         Screen& screen)
    : scene_(scene.scene()),
      options_(std::move(options)),
      file_(file),
      state_(options_.state),
      frames_(screen,
              options_.script.empty() ? std::nullopt : std::optional(ScriptPlayer::kFrameSeconds)),
      steering_({choose_camera(options_.shared, scene_), bounds(scene_)}, frames_,
                options_.script.empty()),
      lights_(scene, std::move(options_.asked), options_.shared, state_.rig),
      pictures_(state_, frames_, steering_.rig(), lights_, options_.shared.time,
                options_.exit_after > 0),
      outlines_(scene_),
      facts_{.scene = scene_,
             .own_lights = lights_.own(),
             .can_glow = lights_.can_glow(),
             .triangles = triangle_count(scene_),
             .opengl = gl_string(GL_RENDERER) + ", " + gl_string(GL_VERSION),
             .error = error_} {
    worker_ = std::make_unique<RenderWorker>(
        scene_, pictures_.wanted().settings,
        [&screen](bool use) { screen.use_worker_context(use); }, [this] { frames_.wake(); });
    if (!options_.script.empty()) {
        script_ = std::make_unique<ScriptPlayer>(
            options_.script,
            ScriptStage{screen, frames_.ui(), [this] { return picture_state(); },
                        [this](const std::filesystem::path& out) { frames_.save(out); }});
    }
}

void ViewSession::run() {
    while (!frames_.screen().should_close()) {
        check_interrupt();
        worker_->check_begun();
        begin_frame();
        take_results();
        obey_input();
        const bool draws = frames_.is_drawn_soon() || script_;
        if (draws) describe();
        request_picture();
        if (draws) frames_.paint(state_.vsync);
        frames_.end();
        if (options_.exit_after > 0 && pictures_.queue().shown_count() >= options_.exit_after)
            break;
        if (script_ && script_->is_done()) break;
    }
    if (!options_.screenshot.empty()) frames_.save(options_.screenshot);
    remember_size();
    file_.save(state_);
}

bool ViewSession::stop() {
    frames_.screen().hide();
    return worker_->stop(kStopPatience);
}

// How long the loop may sleep while no event comes [s].
double ViewSession::wait_seconds() {
    if (script_) return script_->is_waiting() ? 0.01 : 0.0;
    if (is_resting()) return kIdleSeconds;
    const bool moves = steering_.is_moving(state_.camera_mode) || state_.lights_move ||
                       pictures_.queue().is_moving();
    if (moves || frames_.is_drawn_soon() || frames_.has_events()) return FrameClock::kUsualSeconds;
    return is_busy() ? kBusySeconds : kIdleSeconds;
}

void ViewSession::begin_frame() {
    frames_.screen().set_changing(state_.lights_move || lights_.are_awaited() ||
                                  pictures_.are_busy() || pictures_.queue().is_moving());
    frames_.begin(wait_seconds(), [this] {
        if (script_) script_->advance();
    });
    if (!script_) {
        remember_size();
        file_.keep(state_, frames_.clock().now());
    }
    if (messages_.update(waiting_line(), frames_.clock().now())) frames_.redraw_soon(1);
}

void ViewSession::remember_size() {
    const auto size = frames_.screen().size_to_keep();
    state_.window_size = {std::max(size[0], kSmallestKept), std::max(size[1], kSmallestKept)};
}

void ViewSession::take_results() {
    const OnFailure failed = [this](const std::string& what) { fail(what); };
    pictures_.take([this](const PictureRequest& request, const Picture& picture,
                          double scale) { take_picture(request, picture, scale); },
                   failed);
    limits_.take([this](const DeviceLimits& limits) { facts_.limits = limits; }, failed);
    lights_.take(state_, failed);
    if (!lights_.are_awaited()) obey_actions(std::exchange(held_back_, {}));
    // After these the renderer's last picture is not the window's.
    if (error_.take(failed)) pictures_.queue().forget_request();
    saving_.take(
        [this](const std::string& what) {
            messages_.show(what, frames_.clock().now());
            pictures_.queue().forget_request();
        },
        failed);
    clusters_.take(state_, failed);
}

void ViewSession::take_picture(const PictureRequest& request, const Picture& picture,
                               double scale) {
    if (pictures_.queue().shown_count() == 1) {
        limits_ = Awaited(
            worker_->ask([](Renderer& renderer) { return cached_device_limits(renderer.gpu()); }));
    }
    facts_.note_picture(request, picture, scale);
    clusters_.take_depths(picture.frame);
}

void ViewSession::obey_input() {
    steering_.steer(state_.camera_mode);
    if (frames_.gui().wants_keys()) return;
    for (const KeyEvent& key : frames_.input().pressed()) obey_actions(obey_key(key, state_));
}

void ViewSession::request_picture() {
    if (is_resting() || is_ahead()) return;
    lights_.own().set_point_size(state_.settings.lights.size);
    if (!lights_.are_changing()) {
        const auto settings = [this] { return pictures_.wanted().settings; };
        // While a light is dragged, every change that the scene takes is shown.
        if (!lights_.fit(state_)) {
            lights_.replace(*worker_, state_, settings());
        } else if (!lights_.surfaces_fit(state_) ||
                   (lights_.own().has_news() && pictures_.show_lights())) {
            lights_.change(*worker_, state_, settings());
        }
    }
    // While lights are being replaced, the settings do not fit those that are there.
    if (!lights_.are_changing()) pictures_.request(*worker_);
}

void ViewSession::fail(const std::string& what) {
    // A script ends with the message; without one the window shows it.
    if (script_) throw Error(what);
    messages_.fail(what);
    frames_.redraw_soon();
}

// Minimised, and no script or --exit-after waits for pictures.
bool ViewSession::is_resting() const {
    return frames_.screen().is_minimised() && !script_ && options_.exit_after == 0;
}

// Lights move, the camera does not, and the screen has not sent the last picture: more would be
// left out and take the cores' time. Changes of settings wait, too.
bool ViewSession::is_ahead() const {
    return state_.lights_move && !steering_.is_moving(state_.camera_mode) && !script_ &&
           options_.exit_after == 0 && frames_.screen().is_behind();
}

bool ViewSession::is_busy() const {
    return limits_.is_open() || clusters_.is_open() || error_.is_open() || lights_.are_awaited() ||
           saving_.is_open() || pictures_.are_busy();
}

// Whether the last picture is the wanted one, in full size, and no task is left.
PictureState ViewSession::picture_state() const {
    if (state_.lights_move) return PictureState::endless;
    return pictures_.are_complete() && !is_busy() ? PictureState::complete : PictureState::pending;
}

void ViewSession::obey_actions(Actions actions) {
    if (lights_.are_awaited()) hold_back(actions);
    Screen& screen = frames_.screen();
    const auto save = [this](const char* extension) {
        saving_.begin(*worker_, pictures_.wanted_whole(), lights_.options(), extension);
    };
    if (actions.reset_camera) steering_.rig().set(choose_camera(lights_.options(), scene_));
    if (actions.frame_scene) steering_.rig().frame();
    if (actions.scene_camera) {
        steering_.rig().set(
            camera_of(scene_.cameras.at(static_cast<std::size_t>(*actions.scene_camera))));
    }
    if (actions.copy_camera) copy(camera_options(steering_.rig(), lights_.options(), scene_));
    if (actions.copy_command) copy(command(), unsaid_lights(lights_.own().changed_count()));
    if (actions.change_light) {
        lights_.own().change(actions.change_light->number, actions.change_light->light);
    }
    if (actions.reset_light) lights_.own().reset(*actions.reset_light);
    if (actions.reset_lights) lights_.own().reset();
    if (actions.measure_error)
        error_.begin(*worker_, pictures_.wanted(), [this] { frames_.wake(); });
    if (actions.save_png) save(".png");
    if (actions.save_exr) save(".exr");
    if (actions.help) messages_.show_help(!messages_.shows_help());
    if (actions.close_help) messages_.show_help(false);
    if (actions.dismiss_failure) messages_.dismiss_failure();
    if (actions.reset_settings) reset_settings();
    if (actions.full_screen) screen.set_full_screen(!screen.is_full_screen());
    if (actions.close) screen.close();
}

// Holds back actions that need the picture's settings, which belong to lights that are not there
// yet.
void ViewSession::hold_back(Actions& actions) {
    for (bool Actions::*action : {&Actions::measure_error, &Actions::save_png, &Actions::save_exr,
                                  &Actions::copy_command}) {
        held_back_.*action |= std::exchange(actions.*action, false);
    }
}

// Restores the program's defaults, without the command line's values; the device is fixed for the
// run.
void ViewSession::reset_settings() {
    ViewState fresh;
    fresh.settings = SharedOptions().settings;
    fresh.settings.samples = kRestSamples;
    fresh.settings.device = state_.settings.device;
    fresh.settings.light_mix.groups = state_.settings.light_mix.groups;
    fresh.settings.background = lights_.options().shown_background;
    fresh.settings.reflections = lights_.options().maps;
    fresh.window_size = state_.window_size;
    state_ = std::move(fresh);
    lights_.forget_command_line(state_.settings);
    lights_.replace(*worker_, state_, pictures_.wanted().settings);
    file_.forget();
}

void ViewSession::copy(const std::string& text, const std::string& remark) {
    frames_.screen().set_clipboard(text);
    messages_.show("copied" + remark + ": " + text, frames_.clock().now());
    frames_.redraw_soon();
}

std::string ViewSession::command() const {
    SharedOptions options = lights_.options();
    const PictureRequest whole = pictures_.wanted_whole();
    options.settings = whole.settings;
    options.time = whole.time;
    return render_command(steering_.rig(), options, scene_);
}

// The line about a picture that takes long; empty: none.
std::string ViewSession::waiting_line() const {
    const PictureProgress* progress = pictures_.queue().progress();
    if (progress == nullptr) return "";
    return waiting_text(state_.settings.renderer, progress->seconds(), progress->estimate());
}

void ViewSession::describe() {
    frames_.begin_description();
    Actions actions;
    describe_picture(pictures_.place());
    const ShownPicture picture = pictures_.shown_picture();
    clusters_.ask(*worker_, state_, picture);
    clusters_.describe(state_, picture);
    outlines_.draw(*ImGui::GetBackgroundDrawList(), lights_.own().lights(), state_, picture);
    if (state_.show_panel) describe_panel(actions);
    if (state_.show_overlay) {
        describe_overlay(overlay_lines(), messages_.notice(), picture.place, picture.scale);
    }
    actions.dismiss_failure |= messages_.describe(frames_.ui(), picture.place, picture.scale);
    frames_.ui().end_frame();
    obey_actions(actions);
}

void ViewSession::describe_picture(const ScreenPlace& at) {
    const PictureBuffers& buffers = pictures_.queue().buffers();
    if (buffers.width() == 0) return;
    const GLuint map = state_.error_map ? error_.map_of(pictures_.wanted()) : 0;
    const GLuint name = map != 0 ? map : buffers.texture();
    // Dear ImGui passes names of textures as pointers. NOLINTNEXTLINE(performance-no-int-to-ptr)
    const auto texture = reinterpret_cast<ImTextureID>(std::uintptr_t{name});
    ImGui::GetBackgroundDrawList()->AddImage(texture, {at.x0, at.y0}, {at.x1, at.y1});
}

void ViewSession::describe_panel(Actions& actions) {
    ImGui::SetNextWindowPos({0.0f, 0.0f});
    ImGui::SetNextWindowSize({pictures_.panel_width(), pictures_.place().y1});
    ImGui::Begin("panel", nullptr, kPinned);
    frames_.ui().set_label_width(frames_.gui().scaled(104.0f));
    facts_.boxes = clusters_.box_count();
    const PanelSettings settings{{frames_.ui(), state_, actions, facts_}};
    const PanelStats stats{settings};
    settings.picture();
    settings.lights();
    PanelLights{settings}.own_lights(steering_.rig());
    PanelGroups{settings}.groups();
    settings.clusters();
    settings.camera(steering_.rig());
    settings.window();
    // Last, since new results change their heights: no control above moves under the mouse.
    stats.speed();
    stats.error();
    stats.device();
    ImGui::End();
}

std::vector<std::string> ViewSession::overlay_lines() const {
    std::vector<std::string> out;
    const RenderSettings& asked = facts_.displayed;
    if (pictures_.queue().shown_count() == 0) {
        out.emplace_back("compiling kernels and shaders ...");
    } else {
        const double ms = facts_.history.median_frame_ms();
        out.push_back(fmt::format("{:.1f} ms  {:.0f}/s", ms, 1000.0 / std::max(ms, 1e-3)));
        out.push_back(fmt::format("{} x {} at {:.2f}", asked.width, asked.height, facts_.scale));
        if (asked.samples > 1) {
            out.push_back(fmt::format("{} of {} samples", facts_.samples, asked.samples));
        }
        out.push_back(fmt::format("{}  {} lights", name_of(asked.renderer),
                                  short_count(facts_.stats.lights_used)));
    }
    if (!messages_.waiting().empty()) out.push_back(messages_.waiting());
    if (state_.frozen) {
        out.push_back(fmt::format("frozen: {} clusters", short_count(clusters_.box_count())));
    }
    if (error_.is_open()) {
        out.push_back(fmt::format("error: {:.0f} % measured", 100.0f * error_.share()));
    }
    return out;
}

}  // namespace kilolux
