// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/measure/roofline/device_limits.h"
#include "host/render/renderer.h"
#include "host/scene/animated_scene.h"
#include "present/cli/options.h"
#include "present/cli/stats_json.h"
#include "present/commands/error_budget_options.h"

namespace kilolux {

/// Throws UsageError where an error budget meets options that its measurements do not cover; leaves
/// out those that can be.
void check_budget(SharedOptions& options, const BudgetOptions& budget);

/// The start of a SceneRenderer.
struct FirstPicture {
    FrameRequest want;  // of every frame
    double time = 0.0;  // [s]
    int frame = 0;      // of the sequence
    /// The camera of a frame at a time [s]; none: that of the options.
    std::function<Camera(const Scene& scene, int frame, double time)> camera{};
    std::optional<Scene> made{};  // replaces the scene that the options name
    /// Called after lighting and before the renderer is built, so that other renderers can be built
    /// at the same time. The result lives as long as the scene.
    std::function<std::shared_ptr<void>(const Scene& scene, const RenderSettings& settings)>
        on_lit{};
};

/// The settings of the same picture before a white background.
RenderSettings before_white(RenderSettings settings);

/// The share of each pixel that opaque surfaces cover, 0 to 1, from pictures before a black and a
/// white background.
std::vector<float> coverage_of(const Frame& black, const Frame& white);

/// A scene and the renderer of its pictures, by the options of a command line.
class SceneRenderer {
 public:
    /// Opens the scene, lights it and compiles for it. Options that are automatic, such as the rig,
    /// get their chosen values; they must outlive this. Throws the exceptions of the functions that
    /// it calls.
    SceneRenderer(SharedOptions& options, const BudgetOptions& budget, FirstPicture first);

    /// Sets the exposure of --exposure auto by the picture at `time`; prints it, with `of_what`.
    void expose_automatically(double time, int frame = 0, const std::string& of_what = "");

    /// Scene and camera of the picture at `time` [s].
    void place(double time, int frame);

    /// The picture at `time` [s], or its pixels of `crop`.
    Frame render(double time, int frame = 0, const std::optional<PixelRect>& crop = {});

    /// coverage_of() of the last render(), by the same picture before a white background.
    std::vector<float> coverage(const Frame& picture, double time, int frame,
                                const std::optional<PixelRect>& crop = {});

    /// Takes `next` in place of the present options, but for the scene. `relights`: takes its
    /// lights, too. When it throws, nothing changes.
    void change(const SharedOptions& next, const BudgetOptions& budget, const FrameRequest& want,
                bool relights);

    /// Lights in the world beside all others; an empty list removes the former ones.
    void set_lights(std::vector<SceneLight> lights);

    /// The document of --stats. `limits`: with the least time of each stage by the device's limits,
    /// which are measured once a device.
    nlohmann::ordered_json stats(FrameRecord record, bool limits);
    void fill_limits(FrameRecord& record);

    AnimatedScene& scene() { return scene_; }
    Renderer& renderer() { return *renderer_; }
    const Camera& camera() const { return camera_; }  // of the last render()
    bool is_framed() const { return kilolux::is_framed(options_.camera, scene_.scene()); }
    const std::string& rig_lines() const { return rig_; }  // describe the lights of the scene

 private:
    // How lights without a range are to be treated, before choose_tails().
    struct Asked {
        Asked() = default;
        explicit Asked(const RenderSettings& s) : tails(s.tails), range_budget(s.range_budget) {}
        Tails tails = Tails::automatic;
        double range_budget = kDefaultRangeBudget;
    };

    void relight(SharedOptions& options);
    void choose_for_lights();
    RenderSettings settings_of(const BudgetOptions& budget, const FrameRequest& want, double time);

    SharedOptions& options_;
    std::future<Gpu> device_;  // opens while the scene is loaded; empty then
    std::function<Camera(const Scene&, int, double)> camera_at_;
    AnimatedScene scene_;
    Asked asked_;
    std::vector<SceneLight> lights_;  // of set_lights()
    std::string rig_;
    std::shared_ptr<void> helpers_;  // of FirstPicture::on_lit; goes before the scene
    std::optional<Renderer> renderer_;
    Camera camera_;
    std::optional<DeviceLimits> limits_;
};

}  // namespace kilolux
