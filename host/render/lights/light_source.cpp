// SPDX-License-Identifier: Apache-2.0
#include "host/render/lights/light_source.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "host/base/system/parallel.h"
#include "host/render/lights/light_order.h"
#include "host/scene/lights/light_kinds.h"
#include "host/scene/lights/rig.h"
#include "kernels/shared/hash.h"

namespace kilolux {
namespace {

// Within this of the origin [m] no light is too far from the camera to be used.
constexpr double kNear = 4e14;

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

}  // namespace

uint tail_seed(const RenderSettings& settings, uint sample) {
    if (settings.tails != Tails::stochastic) return 0;
    return std::max(1u, hash_of(hash_of(settings.seed) + sample));
}

std::vector<SceneLight> lights_at(const Scene& scene, const RenderSettings& settings,
                                  const Camera& camera, double time) {
    std::vector<SceneLight> out =
        all_lights(scene, settings.lights, settings.light_mix, camera, time);
    const Tails tails = tails_for(scene.lights, settings.tails, settings.range_budget);
    fill_missing_ranges(out, tails == Tails::stochastic ? Tails::exact : tails,
                        settings.range_budget);
    return out;
}

LightSource::LightSource(const Gpu& gpu, const Tuning& tuning, const Scene& scene,
                         const RenderSettings& settings)
    : gpu_(gpu),
      scene_(scene),
      surfaces_(scene.revisions.surfaces()),
      tails_(tails_for(scene.lights, settings.tails, settings.range_budget)),
      range_budget_(settings.range_budget),
      mix_(settings.light_mix),
      asked_options_(settings.lights),
      generated_(gpu, tuning),
      tracks_order_(settings.shadows == Shadows::exact),
      index_before_(gpu, "lights"),
      move_(gpu, tuning),
      directional_(gpu, "lights"),
      profile_starts_(profile_starts(scene.webs)),
      profiles_(gpu, "lights"),
      shapes_(gpu, "lights"),
      groups_(gpu, "lights"),
      light_groups_(settings.light_groups),
      uploaded_tables_(gpu, "lights"),
      nodes_(gpu, "lights") {
    if (!scene.aimed_profiles.empty()) upload_tables();
    input_.seed = tail_seed(settings, 0);
}

void LightSource::set_generated(const LightOptions& generated) {
    if (generated == asked_options_) return;
    asked_options_ = generated;
    revision_.reset();
}

void LightSource::set_tails(const RenderSettings& settings) {
    const Tails tails = tails_for(scene_.lights, settings.tails, settings.range_budget);
    input_.seed = tail_seed(settings, 0);
    if (tails == tails_ && settings.range_budget == range_budget_) return;
    tails_ = tails;
    range_budget_ = settings.range_budget;
    revision_.reset();
}

void LightSource::set_groups(const std::vector<LightGroup>& groups) {
    if (groups == light_groups_) return;
    light_groups_ = groups;
    if (groups.empty()) input_.extras.groups.reset();
    is_ordered_ = false;
}

void LightSource::set_mix(const LightMix& mix) {
    if (mix == mix_) return;
    mix_ = mix;
    revision_.reset();
    tree_revision_.reset();  // its nodes are sums of intensities
}

// Takes over the scene's own lights where they changed.
void LightSource::take_up_changes() {
    const SceneRevisions& now = scene_.revisions;
    // Generated lights may depend on the box of the surfaces.
    if (std::exchange(surfaces_, now.surfaces()) != now.surfaces()) time_.reset();
    if (revision_ == now.lights) return;
    revision_ = now.lights;
    options_ = mixed_generated(asked_options_, scene_, mix_);
    own_ = mixed_lights(scene_, mix_, mix_groups_);
    fill_missing_ranges(own_, tails_, range_budget_);
    headlights_ = headlights_of(own_);
    headlight_camera_.reset();
    time_.reset();
    is_ordered_ = false;
}

void LightSource::place_headlights(const Camera& camera) {
    if (headlights_.empty() || headlight_camera_ == camera) return;
    headlight_camera_ = camera;
    for (const std::size_t i : headlights_) {
        const glm::vec3 intensity = own_[i].intensity;  // as the mix has it
        own_[i] = placed_light(scene_.lights[i], camera);
        own_[i].intensity = intensity;
    }
    fill_missing_ranges(own_, tails_, range_budget_);
    time_.reset();
    is_ordered_ = false;
}

// The point or spot light of a row.
SceneLight LightSource::light(std::size_t place) const {
    if (place >= list_count()) return tree_.lights[place - list_count()];
    if (place >= order_.size()) return generated_.at(place - order_.size());
    const std::uint32_t number = order_[place];
    return number < own_.size() ? own_[number] : far_[number - own_.size()];
}

void LightSource::find_order(const glm::dvec3& camera_position) {
    order_.clear();
    directional_order_.clear();
    order_camera_.reset();
    std::vector<std::uint32_t> members;
    std::vector<SceneLight> lights = own_;
    far_ = is_far_ ? generate_lights(options_, scene_, *time_) : std::vector<SceneLight>();
    lights.insert(lights.end(), far_.begin(), far_.end());
    bool all_near = is_near(camera_position);
    for (const std::uint32_t number : order_by_place(lights)) {
        const SceneLight& light = lights[number];
        const bool is_directional = !kind_of(light).is_placed;
        all_near = all_near && (is_directional || is_near(light.position));
        if (!is_usable(light, camera_position)) continue;
        const bool in_tree =
            tails_ == Tails::tree && number < own_.size() && is_for_tree(scene_.lights[number]);
        (in_tree ? members : is_directional ? directional_order_ : order_).push_back(number);
    }
    plant_tree(members);
    if (!all_near) order_camera_ = camera_position;
}

// Builds the light tree anew where the lights are others or have moved.
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
    input_.extras.profile_tables = uploaded_tables_.get();
}

bool LightSource::has_area_lights() const { return kilolux::has_area_lights(own_, options_); }

// Uploads a row beside each light's: `row_of` makes it, `drifting_row` is that of generated ones.
template <typename Row>
DeviceArray<Row> LightSource::upload_extras(GrowingArray<Row>& to, const Row& drifting_row,
                                            auto&& row_of) {
    std::vector<Row> rows(row_count(), drifting_row);
    parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
        const bool drifts = i >= order_.size() && i < list_count();
        if (!drifts) rows[i] = row_of(light(i));
    });
    const DeviceArray<Row> out = to.reserve(rows.size());
    kilolux::upload<Row>(gpu_, out, rows);
    return out;
}

// Uploads the groups of all lights, the directional ones last.
void LightSource::upload_groups() {
    const std::vector<std::uint8_t>& own = group_numbers_.of(scene_, light_groups_);
    std::vector<std::uint8_t> rows(row_count(),
                                   group_of(generated_light(options_), scene_, light_groups_));
    for (std::size_t i = 0; i < order_.size(); ++i) {
        if (order_[i] < own.size()) rows[i] = own[order_[i]];
    }
    for (const std::uint32_t number : directional_order_) rows.push_back(own[number]);
    input_.extras.groups = groups_.reserve(rows.size());
    kilolux::upload<std::uint8_t>(gpu_, *input_.extras.groups, rows);
}

// Uploads the lights that the host places.
void LightSource::upload() {
    if (!light_groups_.empty()) upload_groups();
    if (!scene_.aimed_profiles.empty()) {
        const auto row_of = [&](const SceneLight& light) {
            return aimed_profile(light, scene_, profile_starts_);
        };
        input_.extras.profiles = upload_extras(profiles_, row_of({}), row_of);
    }
    if (has_area_lights()) {
        input_.extras.shapes = upload_extras(shapes_, shape_row(drifting_light()), shape_row);
    }
    const std::span<WorldLight> rows = move_.stage(row_count() - drifting());
    parallel_for(std::size_t{0}, rows.size(), [&](std::size_t i) {
        rows[i] = world_light(light(i < order_.size() ? i : i + drifting()));
    });
    move_.upload(order_.size(), drifting());
    std::vector<DirectionalLight> directional;
    for (const std::uint32_t number : directional_order_) {
        directional.push_back(directional_row(own_[number]));
    }
    kilolux::upload<DirectionalLight>(gpu_, directional_.reserve(directional.size()), directional);
}

// LightInput::index_before after a new order.
DeviceArray<uint> LightSource::upload_index_before() {
    if (order_ == order_before_) return {};
    constexpr uint kNone = std::numeric_limits<uint>::max();
    std::vector<uint> index_of(own_.size() + far_.size(), kNone);
    for (std::size_t i = 0; i < order_before_.size(); ++i) {
        if (order_before_[i] < index_of.size()) index_of[order_before_[i]] = static_cast<uint>(i);
    }
    std::vector<uint> out(list_count());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const bool drifts = i >= order_.size();
        out[i] = drifts ? static_cast<uint>(i - order_.size() + order_before_.size())
                        : index_of[order_[i]];
    }
    const DeviceArray<uint> to = index_before_.reserve(out.size());
    kilolux::upload<uint>(gpu_, to, out);
    return to;
}

// Whether every generated light is usable from here, so that the device may place them.
bool LightSource::drifts_near(const glm::dvec3& camera_position) const {
    const Box& box = generated_.box();
    return is_near(camera_position) && is_near(box.min) && is_near(box.max) &&
           is_usable(generated_.first(), camera_position);
}

void LightSource::update(double time, const Camera& camera, FrameStats& stats) {
    take_up_changes();
    place_headlights(camera);
    const bool has_moved = time_ != time;
    if (has_moved) {
        time_.reset();  // until it is done
        generated_.set(options_, scene_, time);
        time_ = time;
        input_camera_.reset();
        is_drifted_ = false;
    }
    const bool is_far = generates() && !drifts_near(camera.position);
    const bool is_stale = !is_ordered_ || is_far_ != is_far || (is_far && has_moved) ||
                          (order_camera_ && *order_camera_ != camera.position) ||
                          (!order_camera_ && !is_near(camera.position));
    if (is_stale) {
        is_far_ = is_far;
        input_camera_.reset();
        is_drifted_ = false;
        is_ordered_ = false;  // until it is done
        if (tracks_order_ && !is_new_order_) order_before_ = std::move(order_);
        is_new_order_ = true;
        find_order(camera.position);
        upload();
        is_ordered_ = true;
        stats.lights_uploaded += row_count() - drifting() + directional_order_.size();
    }
    stats.lights_given = own_.size() + options_.count;
    stats.lights_used = list_count() + tree_members_.size() + directional_order_.size();
    stats.lights_rejected = stats.lights_given - stats.lights_used;
    stats.directional_lights = directional_order_.size();
}

LightInput LightSource::input(const glm::dvec3& camera_position, bool reuse, StageTimer& timer) {
    if (reuse && input_camera_ == camera_position) return input_;
    if (drifting() > 0 && (!reuse || !is_drifted_)) {
        generated_.place(move_.world(), order_.size(), timer);
    }
    is_drifted_ = true;
    const glm::dvec3& p = camera_position;
    input_.lights = move_.enqueue(point_pair(p.x, p.y, p.z), timer);
    input_.count = static_cast<uint>(list_count());
    input_.directional = directional_.get();
    input_.directional_count = static_cast<uint>(directional_order_.size());
    const bool is_new_order = std::exchange(is_new_order_, false);
    input_.index_before =
        is_new_order && tracks_order_ ? upload_index_before() : DeviceArray<uint>();
    const bool has_drifted = std::exchange(input_time_, time_) != time_;
    input_.have_all_moved = has_drifted && order_.empty() && directional_order_.empty();
    input_camera_ = camera_position;
    ++input_.version;
    return input_;
}

LightRows LightSource::rows(const glm::dvec3& camera_position) {
    if (drifting() > 0) generated_.read_order();
    std::vector<SceneLight> lights(row_count());
    parallel_for(std::size_t{0}, row_count(), [&](std::size_t i) { lights[i] = light(i); });
    for (const std::uint32_t number : directional_order_) lights.push_back(own_[number]);
    LightRows out = make_light_rows(lights, camera_position);
    if (has_area_lights()) out.shapes.resize(out.local.size());  // points, where none is usable
    if (scene_.aimed_profiles.empty()) return out;
    out.profile_tables = profile_tables_;
    lights.resize(row_count());  // those that are usable: none is left out
    for (const SceneLight& light : lights) {
        out.profiles.push_back(aimed_profile(light, scene_, profile_starts_));
    }
    return out;
}

}  // namespace kilolux
