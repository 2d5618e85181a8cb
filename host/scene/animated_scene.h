// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "host/scene/enclosure.h"
#include "host/scene/framing.h"
#include "host/scene/gltf/load_scene.h"
#include "host/scene/lights/glow/glowing_surfaces.h"

namespace kilolux {

struct PlacedNodes;
struct ShapePlan;

/// One of a scene's lights and its place among them.
struct NumberedLight {
    std::size_t number = 0;
    SceneLight light;
    bool operator==(const NumberedLight&) const = default;
};

/// A scene that can be set to any time: what moves is evaluated again, the rest is kept.
///
/// The scene at a time is what load_scene() gives for that time, bit for bit, whatever times came
/// before. Its address does not change, so renderers may keep a reference; its revisions say which
/// parts changed.
class AnimatedScene {
 public:
    /// A scene without animation.
    explicit AnimatedScene(Scene scene);

    /// A glTF file at options.time; throws as load_scene() does.
    AnimatedScene(const std::filesystem::path& file, const LoadOptions& options,
                  const LoadProgress& progress = {});

    ~AnimatedScene();
    AnimatedScene(const AnimatedScene&) = delete;
    AnimatedScene& operator=(const AnimatedScene&) = delete;

    const Scene& scene() const { return scene_; }

    /// The measurement that decided scene().kind, unless see_from() did.
    const Enclosure& enclosure() const { return enclosure_; }

    /// Treats the scene as an interior or as an object; automatic changes nothing.
    void see_from(SeenFrom from);

    /// Whether clips play that drive something.
    bool moves() const { return file_ != nullptr; }

    /// Evaluates the animations at `time` [s]: transforms, visibility, lights, cameras, materials,
    /// and the vertices of meshes with a skin or with morph weights that are driven. Throws Error
    /// as loading does; the scene then stays at the time it had.
    void set_time(double time);

    /// Adds lights that are the same at any time.
    void add_lights(const std::vector<SceneLight>& lights);

    /// The added lights; and their replacement.
    const std::vector<SceneLight>& added_lights() const { return added_lights_; }
    void replace_lights(const std::vector<SceneLight>& lights);

    /// The lights before those of surfaces and the added ones.
    std::span<const SceneLight> own_lights() const;
    /// Replaces some of these, until the time changes, and returns what they were.
    std::vector<NumberedLight> exchange_lights(std::vector<NumberedLight> lights);

    /// Whether emissive surfaces are lights, too, at any time: those of GlowingSurfaces, behind the
    /// file's own. At first they are not. Throws MemoryError where memory for loading lacks; the
    /// scene then stays as it is.
    void light_by_surfaces(bool on);

    /// What they were made of; null where they are no lights.
    const GlowCounts* glow() const { return glowing_ ? &glowing_->counts() : nullptr; }

    Scene take() && { return std::move(scene_); }

 private:
    struct File;
    static void make_solids_of_lines(File& file, const ShapePlan& plan, std::vector<Mesh>& meshes,
                                     bool first);
    static std::vector<Mesh> build_moved(File& file, const ShapePlan& plan, bool first);
    void place();
    std::vector<SceneLight> glow_at(const File& file, const std::vector<Mesh>& moved,
                                    const std::vector<Instance>& instances);
    void set_lights(const PlacedNodes& nodes, std::vector<SceneLight> lights,
                    const std::vector<SceneLight>& of_surfaces);
    void set_meshes(std::vector<Mesh> meshes);
    void survey();

    Scene scene_;
    Enclosure enclosure_;
    std::vector<SceneLight> added_lights_;
    std::shared_ptr<LoadBudget> budget_;        // the file's; a made scene gets one of its own
    std::unique_ptr<GlowingSurfaces> glowing_;  // none: emissive surfaces are no lights
    std::unique_ptr<File> file_;                // none: no animation
};

}  // namespace kilolux
