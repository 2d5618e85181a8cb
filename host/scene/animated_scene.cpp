// SPDX-License-Identifier: Apache-2.0
#include "host/scene/animated_scene.h"

#include "host/base/log.h"
#include "host/scene/gltf/choices.h"
#include "host/scene/gltf/material/image.h"
#include "host/scene/gltf/material/specular_glossiness.h"
#include "host/scene/gltf/nodes.h"
#include "host/scene/gltf/parallel.h"
#include "host/scene/gltf/shapes.h"
#include "host/scene/look_around.h"

namespace kilolux {

// What the scene is evaluated from at another time.
struct AnimatedScene::File {
    GltfDocument document;
    GltfMaterials materials;
    std::vector<PrimitiveJob> jobs;
    std::vector<int> mesh_of_job;  // index into Scene::meshes; -1: has no triangles
    double line_width_m = 0.0;     // of points and lines
    double time = 0.0;             // [s] of the scene
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

}  // namespace

// Gives points and lines their width, which is that of the whole scene when it is made.
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
    const bool moves = has_animations(file.document);
    if (moves) file.document.options.time = 0.0;
    file.materials = convert_materials(file.document);
    scene_.name = path.stem().string();
    scene_.clips = list_clips(file.document);
    scene_.variants = list_variants(file.document);
    scene_.webs = read_profiles(file.document);
    place();
    scene_.images = decode_images(file.document, file.materials.images, progress);
    for (Image& image : roughness_images(file.document, file.materials, scene_.images)) {
        scene_.images.push_back(std::move(image));
    }
    scene_.textures = file.materials.textures;
    scene_.materials = file.materials.materials;
    if (moves) {
        set_time(options.time);
    } else {
        file_ = nullptr;
    }
    survey();
}

AnimatedScene::~AnimatedScene() = default;

// What lights and cameras that nobody placed go by.
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
    ++scene_.lights_revision;
}

void AnimatedScene::replace_lights(const std::vector<SceneLight>& lights) {
    scene_.lights.resize(scene_.lights.size() - added_lights_.size());
    added_lights_.clear();
    add_lights(lights);
}

void AnimatedScene::set_time(double time) {
    if (!file_ || file_->time == time) return;
    file_->document.options.time = time;
    file_->document.budget->refill();
    place();
    file_->time = time;
    ++scene_.revision;
}

// Makes the scene of the document at its options' time: all of it, or what can have moved. Changes
// the scene only once nothing can throw any more.
void AnimatedScene::place() {
    File& file = *file_;
    const bool first = file.mesh_of_job.empty();
    const PlacedNodes nodes = place_nodes(file.document);
    const ShapePlan plan = plan_shapes(file.document, nodes);
    if (first) file.jobs = list_primitives(file.document, plan);
    std::vector<Mesh> meshes(file.jobs.size());
    parallel_each(meshes.size(), [&](std::size_t j) {
        const MeshShape& shape = plan.shapes[file.jobs[j].shape];
        if (!first && !shape.moves) return;
        meshes[j] = build_primitive(file.document, file.materials, shape, file.jobs[j].primitive);
    });
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
    for (std::size_t j = 0; j < meshes.size(); ++j) {
        if (meshes[j].indices.empty()) continue;
        Mesh& mesh = scene_.meshes[static_cast<std::size_t>(file.mesh_of_job[j])];
        if (!first) meshes[j].revision = mesh.revision + 1;
        mesh = std::move(meshes[j]);
    }
    scene_.instances = std::move(instances);
    scene_.lights = std::move(lights);
    add_profile_lights(file.document, nodes, scene_);
    scene_.lights.insert(scene_.lights.end(), added_lights_.begin(), added_lights_.end());
    scene_.cameras = std::move(cameras);
}

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
    return AnimatedScene(file, options).take();
}

}  // namespace kilolux
