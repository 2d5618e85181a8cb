// SPDX-License-Identifier: Apache-2.0
#include "host/scene/animated_scene.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "host/base/log.h"
#include "host/base/system/memory.h"
#include "host/base/system/parallel.h"
#include "host/scene/gltf/animation.h"
#include "host/scene/gltf/choices.h"
#include "host/scene/gltf/light_profiles.h"
#include "host/scene/gltf/lights_cameras.h"
#include "host/scene/gltf/material/image.h"
#include "host/scene/gltf/material/specular_glossiness.h"
#include "host/scene/gltf/nodes.h"
#include "host/scene/gltf/shapes.h"

namespace kilolux {

// The file that the scene is evaluated from at other times.
struct AnimatedScene::File {
    GltfDocument document;
    GltfMaterials materials;
    std::vector<PrimitiveJob> jobs;
    std::vector<int> mesh_of_job;   // index into Scene::meshes; -1: has no triangles
    std::vector<MeshShape> shapes;  // of the scene's time
    // By job, of shapes that move: planned once.
    std::vector<std::optional<MeshPlan>> plans;
    double line_width_m = 0.0;  // of points and lines
    double time = 0.0;          // [s] of the scene
};

namespace {

// Instances of each placement's meshes, in the file's order.
std::vector<Instance> place_instances(const GltfDocument& document, const ShapePlan& plan,
                                      const std::vector<PrimitiveJob>& jobs,
                                      const std::vector<int>& mesh_of_job) {
    std::vector<std::vector<int>> meshes_of_shape(plan.shapes.size());
    for (std::size_t j = 0; j < jobs.size(); ++j) {
        if (mesh_of_job[j] >= 0) meshes_of_shape[jobs[j].shape].push_back(mesh_of_job[j]);
    }
    std::size_t count = 0;
    for (const Placement& placement : plan.placements) {
        count += meshes_of_shape[placement.shape].size();
    }
    document.budget->charge(count, sizeof(Instance), document.base.file + ": nodes");
    std::vector<Instance> instances;
    instances.reserve(count);
    for (const Placement& placement : plan.placements) {
        for (const int mesh : meshes_of_shape[placement.shape]) {
            instances.push_back({mesh, placement.world_from_object});
        }
    }
    return instances;
}

// Whether `next` differs from the present value.
template <typename T>
bool replace(std::vector<T>& values, std::vector<T>&& next) {
    const bool differs = values != next;
    values = std::move(next);
    return differs;
}

}  // namespace

// Builds the meshes of jobs whose shape changed; the others are empty.
std::vector<Mesh> AnimatedScene::build_moved(File& file, const ShapePlan& plan, bool first) {
    std::vector<Mesh> meshes(file.jobs.size());
    parallel_each(meshes.size(), [&](std::size_t j) {
        const PrimitiveJob& job = file.jobs[j];
        const MeshShape& shape = plan.shapes[job.shape];
        if (!first && (!shape.moves || shape == file.shapes[job.shape])) return;
        std::optional<MeshPlan>& kept = file.plans[j];
        if (!kept) kept = plan_primitive(file.document, file.materials, shape, job.primitive);
        meshes[j] = build_primitive(file.document, file.materials, shape, job.primitive, *kept);
        if (!shape.moves) kept.reset();
    });
    return meshes;
}

// Gives points and lines their width, which is a share of the whole scene when it is made.
void AnimatedScene::make_solids_of_lines(File& file, const ShapePlan& plan,
                                         std::vector<Mesh>& meshes, bool first) {
    std::vector<std::size_t> lines;  // jobs
    std::size_t count = 0;
    for (std::size_t j = 0; j < meshes.size(); ++j) {
        if (file.jobs[j].corners == 3 || meshes[j].indices.empty()) continue;
        lines.push_back(j);
        count += meshes[j].indices.size() / static_cast<std::size_t>(file.jobs[j].corners);
    }
    if (lines.empty()) return;
    if (first) {
        file.line_width_m = line_width_m(file.document, plan, file.jobs, meshes);
        note(fmt::format("{}: {} points and lines are drawn as solids {:.3g} m wide (--line-width)",
                         file.document.base.file, count, file.line_width_m));
    }
    parallel_each(lines.size(), [&](std::size_t i) {
        const PrimitiveJob& job = file.jobs[lines[i]];
        const double unit = plan.shapes[job.shape].metres_per_unit;
        make_solid_mesh(file.document, meshes[lines[i]], {job.corners, file.line_width_m / unit});
    });
}

AnimatedScene::AnimatedScene(Scene scene) : scene_(std::move(scene)) { survey(); }

AnimatedScene::AnimatedScene(const std::filesystem::path& path, const LoadOptions& options,
                             const LoadProgress& progress)
    : file_(std::make_unique<File>()) {
    File& file = *file_;
    file.document = load_gltf_document(path, options);
    budget_ = file.document.budget;
    const bool moves = !file.document.animated.empty();
    if (moves) file.document.options.time = 0.0;
    // The scene gets a copy.
    const std::size_t copies = drives_materials(file.document) ? 4 : 2;
    file.document.budget->charge_memory(copies * file.document.materials.size() * sizeof(Material),
                                        file.document.base.file + ": materials");
    if (drives_materials(file.document)) scene_.extremes = extreme_materials(file.document);
    animate_elements(file.document);
    file.materials = convert_materials(file.document);
    scene_.name = path.stem().string();
    scene_.clips = list_clips(file.document);
    scene_.variants = list_variants(file.document);
    scene_.webs = read_profiles(file.document);
    scene_.light_nodes = read_light_nodes(file.document);
    place();
    scene_.images = decode_images(file.document, file.materials, progress);
    for (Image& image : roughness_images(file.document, file.materials, scene_.images)) {
        scene_.images.push_back(std::move(image));
    }
    scene_.textures = file.materials.textures;
    if (moves) {
        set_time(options.time);
    } else {
        file_ = nullptr;
    }
    survey();
}

AnimatedScene::~AnimatedScene() = default;

// Finds what generated lights and framing cameras depend on.
void AnimatedScene::survey() {
    scene_.still_box = bounds(scene_);
    enclosure_ = enclosure_of(scene_, scene_.still_box);
    scene_.kind = enclosure_.kind;
}

void AnimatedScene::see_from(SeenFrom from) {
    if (from == SeenFrom::inside) scene_.kind = SceneKind::interior;
    if (from == SeenFrom::outside && scene_.kind == SceneKind::interior) {
        scene_.kind = SceneKind::open;
    }
}

void AnimatedScene::add_lights(const std::vector<SceneLight>& lights) {
    added_lights_.insert(added_lights_.end(), lights.begin(), lights.end());
    scene_.lights.insert(scene_.lights.end(), lights.begin(), lights.end());
    ++scene_.revisions.lights;
}

void AnimatedScene::replace_lights(const std::vector<SceneLight>& lights) {
    scene_.lights.resize(scene_.lights.size() - added_lights_.size());
    added_lights_.clear();
    add_lights(lights);
}

std::span<const SceneLight> AnimatedScene::own_lights() const {
    const auto end = std::ranges::find_if(
        scene_.lights.begin(),
        scene_.lights.end() - static_cast<std::ptrdiff_t>(added_lights_.size()),
        &SceneLight::of_surface);
    return {scene_.lights.begin(), end};
}

std::vector<NumberedLight> AnimatedScene::exchange_lights(std::vector<NumberedLight> lights) {
    for (NumberedLight& one : lights) std::swap(scene_.lights.at(one.number), one.light);
    if (!lights.empty()) ++scene_.revisions.lights;
    return lights;
}

void AnimatedScene::light_by_surfaces(bool on) {
    if (on == (glowing_ != nullptr)) return;
    if (!budget_) budget_ = std::make_shared<LoadBudget>(loading_limit(0));
    auto next = on ? std::make_unique<GlowingSurfaces>(budget_) : nullptr;
    GlowingParts parts = glowing_parts(scene_);
    parts.moves = moves();
    const auto lights = on ? next->lights(parts) : std::vector<SceneLight>{};
    std::erase_if(scene_.lights, [](const SceneLight& light) { return light.of_surface; });
    const auto added = static_cast<std::ptrdiff_t>(added_lights_.size());
    scene_.lights.insert(scene_.lights.end() - added, lights.begin(), lights.end());
    glowing_ = std::move(next);
    ++scene_.revisions.lights;
}

// The lights of surfaces at the file's time: made again only where meshes, instances or materials
// differ from the scene's.
std::vector<SceneLight> AnimatedScene::glow_at(const File& file, const std::vector<Mesh>& moved,
                                               const std::vector<Instance>& instances) {
    std::vector<SceneLight> out;
    if (!glowing_) return out;
    GlowingParts parts = glowing_parts(scene_);
    parts.materials = file.materials.materials;
    parts.instances = instances;
    parts.moves = true;
    bool differs = scene_.instances != instances || scene_.materials != file.materials.materials;
    for (std::size_t j = 0; j < moved.size(); ++j) {
        if (moved[j].indices.empty()) continue;
        parts.meshes[static_cast<std::size_t>(file.mesh_of_job[j])] = &moved[j];
        differs = true;
    }
    if (differs) return glowing_->lights(parts);
    std::ranges::copy_if(scene_.lights, std::back_inserter(out), &SceneLight::of_surface);
    return out;
}

void AnimatedScene::set_time(double time) {
    if (!file_ || file_->time == time) return;
    file_->document.options.time = time;
    file_->document.budget->refill();
    animate_elements(file_->document);
    if (!scene_.extremes.empty()) file_->materials = convert_materials(file_->document);
    place();
    file_->time = time;
}

// Builds the scene of the document at its options' time: all of it, or only what may have moved.
// Changes the scene only after the last call that can throw.
void AnimatedScene::place() {
    File& file = *file_;
    const bool first = file.mesh_of_job.empty();
    const PlacedNodes nodes = place_nodes(file.document);
    ShapePlan plan = plan_shapes(file.document, nodes);
    if (!scene_.extremes.empty()) {
        add_map_axes(file.document, file.materials, scene_.extremes, plan);
    }
    if (first) {
        file.jobs = list_primitives(file.document, plan);
        file.plans.resize(file.jobs.size());
    }
    std::vector<Mesh> meshes = build_moved(file, plan, first);
    make_solids_of_lines(file, plan, meshes, first);
    if (first) {
        for (const Mesh& mesh : meshes) {
            const int next = static_cast<int>(scene_.meshes.size());
            file.mesh_of_job.push_back(mesh.indices.empty() ? -1 : next);
            if (!mesh.indices.empty()) scene_.meshes.emplace_back();
        }
    }
    std::vector<Instance> instances =
        place_instances(file.document, plan, file.jobs, file.mesh_of_job);
    std::vector<SceneLight> lights = convert_lights(file.document, nodes);
    std::vector<SceneCamera> cameras = convert_cameras(file.document, nodes);
    set_lights(nodes, std::move(lights), glow_at(file, meshes, instances));
    set_meshes(std::move(meshes));
    SceneRevisions& revisions = scene_.revisions;
    if (scene_.materials != file.materials.materials) {
        scene_.materials = file.materials.materials;
        ++revisions.materials;
    }
    if (replace(scene_.instances, std::move(instances))) ++revisions.placement;
    if (replace(scene_.cameras, std::move(cameras))) ++revisions.cameras;
    if (first) revisions = {};
    file.shapes = std::move(plan.shapes);
}

// Sets the file's lights, those with profiles, those of surfaces, and the added ones.
void AnimatedScene::set_lights(const PlacedNodes& nodes, std::vector<SceneLight> lights,
                               const std::vector<SceneLight>& of_surfaces) {
    std::swap(scene_.lights, lights);
    const std::vector<SceneProfile> profiles = scene_.aimed_profiles;
    add_profile_lights(file_->document, nodes, scene_);
    scene_.lights.insert(scene_.lights.end(), of_surfaces.begin(), of_surfaces.end());
    scene_.lights.insert(scene_.lights.end(), added_lights_.begin(), added_lights_.end());
    if (scene_.lights != lights || scene_.aimed_profiles != profiles) ++scene_.revisions.lights;
}

// Replaces the meshes that are not empty, one a job.
void AnimatedScene::set_meshes(std::vector<Mesh> meshes) {
    bool has_changed = false;
    for (std::size_t j = 0; j < meshes.size(); ++j) {
        if (meshes[j].indices.empty()) continue;
        Mesh& mesh = scene_.meshes[static_cast<std::size_t>(file_->mesh_of_job[j])];
        if (!mesh.indices.empty()) meshes[j].revision = mesh.revision + 1;
        mesh = std::move(meshes[j]);
        has_changed = true;
    }
    if (has_changed) ++scene_.revisions.geometry;
}

}  // namespace kilolux
