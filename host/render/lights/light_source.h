// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/flow.h"
#include "host/picture/frame.h"
#include "host/render/lights/generated_lights.h"
#include "host/render/lights/light_rows.h"
#include "host/render/settings.h"
#include "host/scene/camera.h"
#include "host/scene/lights/light_ranges.h"
#include "host/scene/lights/light_tree.h"
#include "host/scene/scene.h"
#include "host/stages/lights/move_lights.h"

namespace kilolux {

/// All lights of a scene at `time` [s], its own and then the generated ones, each with a range and
/// the intensity of settings.light_mix; `camera` has the headlights. Random ranges reach everywhere
/// here, as in the mean.
std::vector<SceneLight> lights_at(const Scene& scene, const RenderSettings& settings,
                                  const Camera& camera, double time);

/// Seed of the random ranges (Tails::stochastic) of one of a pixel's samples; 0: no range is
/// random.
uint tail_seed(const RenderSettings& settings, uint sample);

/// All lights of a scene, its own and the generated ones, at any time. They are on the device in
/// the world's coordinates: a camera that moves costs one kernel. The host uploads rows again
/// where the scene's lights change, headlights move, or camera or lights are so far away (4e14 m)
/// that some may be unusable. Rows are the scene's point and spot lights
/// (light_order.h), the generated ones (DriftLights), and those of a tree.
class LightSource {
 public:
    /// Lights of the scene without a range get one as settings.tails says. The scene must outlive
    /// this.
    LightSource(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                const RenderSettings& settings);

    /// Replaces the generated lights.
    void set_generated(const LightOptions& generated);

    /// Replaces the ranges of lights that lack one.
    void set_tails(const RenderSettings& settings);

    /// Replaces the groups of layers that lights are in.
    void set_groups(const std::vector<LightGroup>& groups);

    /// Replaces the gains of groups of lights.
    void set_mix(const LightMix& mix);

    /// The lights at `time` [s] of the scene as it is now; sets their counts, and how many rows
    /// were uploaded. The camera places the headlights, and its position decides which lights are
    /// too far away to be used.
    void update(double time, const Camera& camera, FrameStats& stats);

    /// The lights of the last update() relative to the camera, on the device until the next call.
    /// `reuse`: returns the last call's result where nothing changed. Enqueues only.
    LightInput input(const glm::dvec3& camera_position, bool reuse, StageTimer& timer);

    /// The same rows on the host, made in double. After input().
    LightRows rows(const glm::dvec3& camera_position);

 private:
    void take_up_changes();
    void place_headlights(const Camera& camera);
    SceneLight light(std::size_t place) const;
    std::size_t list_count() const { return order_.size() + drifting(); }
    std::size_t row_count() const { return list_count() + tree_.lights.size(); }
    bool generates() const { return options_.count > 0 && options_.gain != glm::vec3(0.0f); }
    std::size_t drifting() const { return is_far_ || !generates() ? 0 : generated_.count(); }
    bool drifts_near(const glm::dvec3& camera_position) const;
    void find_order(const glm::dvec3& camera_position);
    void plant_tree(const std::vector<std::uint32_t>& members);
    void upload();
    void upload_tables();
    DeviceArray<uint> upload_index_before();
    void upload_groups();
    SceneLight drifting_light() const { return drifting() > 0 ? generated_.first() : SceneLight(); }
    bool has_area_lights() const;
    template <typename Row>
    DeviceArray<Row> upload_extras(GrowingArray<Row>& to, const Row& drifting_row, auto&& row_of);

    Gpu gpu_;
    const Scene& scene_;
    std::optional<std::uint32_t> revision_;  // of the scene's lights; none: own_ are out of date
    std::array<std::uint32_t, 2> surfaces_;  // of the scene that generated lights are placed in
    Tails tails_;
    double range_budget_;
    LightMix mix_;
    GroupNumbers mix_groups_;
    LightOptions asked_options_, options_;  // options_: with the gain of mix_
    GeneratedLights generated_;
    std::vector<SceneLight> own_;             // with ranges, in the world
    std::vector<std::size_t> headlights_;     // those of own_ that follow the camera
    std::optional<Camera> headlight_camera_;  // that they are placed by
    std::optional<double> time_;              // of the generated ones; none: not made yet
    bool is_drifted_ = false;                 // the device has their rows of time_
    bool is_far_ = false;          // some may be too far away to be used: the host places them, too
    std::vector<SceneLight> far_;  // the generated ones then
    // Numbers of the lights that the host places, own_ before far_: usable point and spot lights in
    // the order of the kernels; directional ones.
    std::vector<std::uint32_t> order_, directional_order_;
    bool is_ordered_ = false;    // order_ and directional_order_ are up to date
    bool tracks_order_;          // input_.index_before is of use
    bool is_new_order_ = false;  // order_ changed since the last input(), which had order_before_
    std::vector<std::uint32_t> order_before_;
    GrowingArray<uint> index_before_;
    std::optional<glm::dvec3> order_camera_;  // from where they are usable, if that matters
    std::optional<glm::dvec3> input_camera_;  // of input_; none: to be made
    std::optional<double> input_time_;        // of input_
    LightInput input_;
    MoveLights move_;
    GrowingArray<DirectionalLight> directional_;
    // Of the scene's webs, one after the other, and where each starts.
    std::vector<float> profile_tables_, profile_starts_;
    GrowingArray<AimedProfile> profiles_;
    GrowingArray<LightShape> shapes_;
    GrowingArray<std::uint8_t> groups_;
    std::vector<LightGroup> light_groups_;  // of layers
    GroupNumbers group_numbers_;            // in these
    GrowingArray<float> uploaded_tables_;
    // With Tails::tree, the lights that are in no list: their rows follow those of order_.
    LightTree tree_;
    std::vector<std::uint32_t> tree_members_;     // numbers of its lights
    std::optional<std::uint32_t> tree_revision_;  // of the scene that they are of
    GrowingArray<TreeNode> nodes_;
};

}  // namespace kilolux
