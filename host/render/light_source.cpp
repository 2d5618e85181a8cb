// SPDX-License-Identifier: Apache-2.0
#include "host/render/light_source.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/render/light_order.h"
#include "host/scene/lights/light_ranges.h"
#include "host/scene/lights/rig.h"
#include "kernels/shared/hash.h"

namespace kilolux {
namespace {

// Generated lights are ordered anew this often [s]: they move at most 1.2 m/s, so neighbours stay
// neighbours. Order and places at a time do not depend on the times before it.
constexpr double kOrderInterval = 0.5;
// Within this of the origin [m] no light is too far from the camera to be used.
constexpr double kNear = 4e14;

double order_time(double time) { return std::floor(time / kOrderInterval) * kOrderInterval; }

// Grows with every change of the scene that may be one of its lights.
std::uint32_t lights_revision(const Scene& scene) { return scene.revision + scene.lights_revision; }

std::vector<std::size_t> headlights_of(const std::vector<SceneLight>& lights) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        if (lights[i].follows_camera) out.push_back(i);
    }
    return out;
}

SceneLight placed_light(const SceneLight& light, const Camera& camera) {
    return kilolux::placed_light(light, camera.world_from_view, camera.position);
}

bool is_near(const glm::dvec3& p) {
    return glm::all(glm::lessThan(glm::abs(p), glm::dvec3(kNear)));
}

std::array<double, 3> axes(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

std::vector<SceneLight> all_lights(const std::vector<SceneLight>& own, const LightOptions& options,
                                   const Scene& scene, double time) {
    std::vector<SceneLight> out = own;
    const std::vector<SceneLight> generated = generate_lights(options, scene, time);
    out.insert(out.end(), generated.begin(), generated.end());
    return out;
}

}  // namespace

uint tail_seed(const RenderSettings& settings, uint sample) {
    if (settings.tails != Tails::stochastic) return 0;
    return std::max(1u, hash_of(hash_of(settings.tail_seed) + sample));
}

std::vector<SceneLight> lights_at(const Scene& scene, const RenderSettings& settings,
                                  const Camera& camera, double time) {
    std::vector<SceneLight> own = scene.lights;
    for (SceneLight& light : own) light = placed_light(light, camera);
    const Tails tails = tails_for(scene.lights, settings.tails, settings.range_budget);
    fill_missing_ranges(own, tails == Tails::stochastic ? Tails::exact : tails,
                        settings.range_budget);
    const std::vector<SceneLight> now = all_lights(own, settings.lights, scene, time);
    const auto ordered = all_lights(own, settings.lights, scene, order_time(time));
    std::vector<SceneLight> out;
    for (const std::uint32_t number : order_by_place(ordered)) out.push_back(now[number]);
    return out;
}

LightSource::LightSource(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                         const RenderSettings& settings)
    : gpu_(gpu),
      scene_(scene),
      revision_(lights_revision(scene)),
      tails_(tails_for(scene.lights, settings.tails, settings.range_budget)),
      range_budget_(settings.range_budget),
      generated_(settings.lights),
      own_(scene.lights),
      headlights_(headlights_of(own_)),
      move_(gpu, tuning),
      directional_(gpu, "lights"),
      profile_starts_(profile_starts(scene.webs)),
      profiles_(gpu, "lights"),
      uploaded_tables_(gpu, "lights"),
      nodes_(gpu, "lights") {
    if (!scene.aimed_profiles.empty()) upload_tables();
    fill_missing_ranges(own_, tails_, range_budget_);
    input_.seed = tail_seed(settings, 0);
}

void LightSource::set_generated(const LightOptions& generated) {
    if (generated == generated_) return;
    generated_ = generated;
    time_.reset();
    order_time_.reset();
}

void LightSource::set_tails(const RenderSettings& settings) {
    const Tails tails = tails_for(scene_.lights, settings.tails, settings.range_budget);
    input_.seed = tail_seed(settings, 0);
    if (tails == tails_ && settings.range_budget == range_budget_) return;
    tails_ = tails;
    range_budget_ = settings.range_budget;
    revision_.reset();
}

// The scene's own lights anew where they moved.
void LightSource::take_up_changes() {
    if (revision_ == lights_revision(scene_)) return;
    revision_ = lights_revision(scene_);
    own_ = scene_.lights;
    fill_missing_ranges(own_, tails_, range_budget_);
    headlights_ = headlights_of(own_);
    headlight_camera_.reset();
    time_.reset();
    order_time_.reset();
}

void LightSource::place_headlights(const Camera& camera) {
    if (headlights_.empty() || headlight_camera_ == camera) return;
    headlight_camera_ = camera;
    for (const std::size_t i : headlights_) own_[i] = placed_light(scene_.lights[i], camera);
    fill_missing_ranges(own_, tails_, range_budget_);
    time_.reset();
    order_time_.reset();
}

// The point or spot light of a row.
SceneLight LightSource::light(std::size_t place) const {
    if (place >= order_.size()) return tree_.lights[place - order_.size()];
    const std::uint32_t number = order_[place];
    return number < own_.size() ? own_[number] : at_time_->at(tracks_[place]);
}

void LightSource::find_order(const glm::dvec3& camera_position) {
    order_.clear();
    directional_order_.clear();
    order_camera_.reset();
    std::vector<std::uint32_t> members;
    const auto lights = all_lights(own_, generated_, scene_, *order_time_);
    bool all_near = is_near(camera_position);
    for (const std::uint32_t number : order_by_place(lights)) {
        const SceneLight& light = lights[number];
        const bool is_directional = light.type == LightType::directional;
        all_near = all_near && (is_directional || is_near(light.position));
        if (!is_usable(light, camera_position)) continue;
        const bool in_tree =
            tails_ == Tails::tree && number < own_.size() && is_for_tree(scene_.lights[number]);
        (in_tree ? members : is_directional ? directional_order_ : order_).push_back(number);
    }
    plant_tree(members);
    if (!all_near) order_camera_ = camera_position;
    tracks_.resize(order_.size());
    tbb::parallel_for(std::size_t{0}, order_.size(), [&](std::size_t i) {
        if (order_[i] >= own_.size()) tracks_[i] = at_time_->track(order_[i] - own_.size());
    });
}

// Anew where the lights are others or have moved.
void LightSource::plant_tree(const std::vector<std::uint32_t>& members) {
    if (members == tree_members_ && !members.empty() && tree_revision_ == revision_) return;
    tree_members_ = members;
    tree_revision_ = revision_;
    std::vector<SceneLight> lights;
    for (const std::uint32_t number : members) lights.push_back(own_[number]);
    tree_ = make_light_tree(lights);
    kilolux::upload<TreeNode>(gpu_, nodes_.reserve(tree_.nodes.size()), tree_.nodes);
    input_.nodes = nodes_.get();
    input_.node_count = static_cast<uint>(tree_.nodes.size());
}

void LightSource::upload_tables() {
    for (const PhotometricWeb& web : scene_.webs) {
        profile_tables_.insert(profile_tables_.end(), web.table.begin(), web.table.end());
    }
    kilolux::upload<float>(gpu_, uploaded_tables_.reserve(profile_tables_.size()), profile_tables_);
    input_.profiles.tables = uploaded_tables_.get();
}

void LightSource::upload_profiles() {
    std::vector<AimedProfile> profiles(row_count());
    tbb::parallel_for(std::size_t{0}, row_count(), [&](std::size_t i) {
        profiles[i] = aimed_profile(light(i), scene_, profile_starts_);
    });
    kilolux::upload<AimedProfile>(gpu_, profiles_.reserve(profiles.size()), profiles);
    input_.profiles.lights = profiles_.get();
}

void LightSource::upload() {
    if (!scene_.aimed_profiles.empty()) upload_profiles();
    const std::span<WorldLight> rows = move_.stage(row_count());
    tbb::parallel_for(std::size_t{0}, row_count(),
                      [&](std::size_t i) { rows[i] = world_light(light(i)); });
    stage_drifts();
    move_.upload();
    drift_time_.reset();
    std::vector<DirectionalLight> directional;
    for (const std::uint32_t number : directional_order_) {
        directional.push_back(directional_row(own_[number]));
    }
    kilolux::upload<DirectionalLight>(gpu_, directional_.reserve(directional.size()), directional);
}

// How the generated lights move from the time of their order on: until the next one the device
// finds their places.
void LightSource::stage_drifts() {
    std::vector<std::uint32_t> rows;
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
        if (order_[i] >= own_.size()) rows.push_back(i);
    }
    if (rows.empty()) return;
    const LightGenerator start(generated_, scene_, *order_time_);
    std::vector<DriftBox> boxes;
    for (const Box& part : start.parts())
        boxes.push_back(drift_box(axes(part.min), axes(part.size())));
    const std::span<LightDrift> drifts = move_.stage_drifts(rows.size(), boxes);
    tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
        const LightTrack& track = tracks_[rows[i]];
        const LightTurns turns = start.turns(track);
        drifts[i] = light_drift(rows[i], track.part, axes(turns.at), axes(turns.rate));
    });
}

void LightSource::update(double time, const Camera& camera, FrameStats& stats) {
    take_up_changes();
    place_headlights(camera);
    const glm::dvec3& camera_position = camera.position;
    const bool out_of_order = order_time_ != order_time(time) ||
                              (order_camera_ && *order_camera_ != camera_position) ||
                              (!order_camera_ && !is_near(camera_position));
    if (out_of_order || time_ != time) {
        at_time_.emplace(generated_, scene_, time);
        time_ = time;
        order_time_ = order_time(time);
        input_camera_.reset();
        if (out_of_order) {
            find_order(camera_position);
            upload();
        }
    }
    stats.lights_given = own_.size() + generated_.count;
    stats.lights_used = order_.size() + tree_members_.size() + directional_order_.size();
    stats.lights_rejected = stats.lights_given - stats.lights_used;
    stats.directional_lights = directional_order_.size();
}

LightInput LightSource::input(const glm::dvec3& camera_position, bool reuse, StageTimer& timer) {
    if (reuse && input_camera_ == camera_position) return input_;
    if (!reuse || drift_time_ != time_) move_.drift(*time_ - *order_time_, timer);
    drift_time_ = time_;
    const glm::dvec3& p = camera_position;
    input_.lights = move_.enqueue(point_pair(p.x, p.y, p.z), timer);
    input_.count = static_cast<uint>(order_.size());
    input_.directional = directional_.get();
    input_.directional_count = static_cast<uint>(directional_order_.size());
    input_camera_ = camera_position;
    ++input_.version;
    return input_;
}

LightRows LightSource::rows(const glm::dvec3& camera_position) const {
    std::vector<SceneLight> lights(row_count());
    tbb::parallel_for(std::size_t{0}, row_count(), [&](std::size_t i) { lights[i] = light(i); });
    for (const std::uint32_t number : directional_order_) lights.push_back(own_[number]);
    LightRows out = make_light_rows(lights, camera_position);
    if (scene_.aimed_profiles.empty()) return out;
    out.profile_tables = profile_tables_;
    lights.resize(row_count());  // those that are usable: none is left out
    for (const SceneLight& light : lights) {
        out.profiles.push_back(aimed_profile(light, scene_, profile_starts_));
    }
    return out;
}

}  // namespace kilolux
