// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include "host/measure/reference/decoded_samples.h"
#include "tests/support/lobe_pictures.h"

namespace kilolux {

/// Sees a glass_scene() whole.
inline const Camera kGlassCamera = look_at({0.5, 0.8, 5.0}, {0, 0, 0}, {0, 1, 0}, 0.55);

/// A square of 4 m about the z axis, turned about the y axis.
inline void add_glass_pane(Scene& scene, const Material& material, double z, double turn) {
    Mesh mesh;
    mesh.positions = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
    scene.meshes.push_back(mesh);
    const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, z));
    const glm::dmat4 place = glm::rotate(moved, turn, glm::dvec3(0, 1, 0));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()) - 1, place});
}

inline Material glass(const glm::vec3& color) {
    Material m;
    m.base_color = glm::vec4(color, 1.0f);
    m.metallic = 0.0f;
    m.roughness = 0.3f;
    m.transmission = 1.0f;
    m.double_sided = true;
    return m;
}

/// A sphere of green glass with maps, behind a pane that is metal in part and before another one
/// with a coat; a wall behind all.
inline Scene glass_scene() {
    Material ball = glass({0.9f, 0.95f, 1.0f});
    ball.double_sided = false;
    ball.ior = 1.8f;
    ball.thickness = 0.8f;
    ball.attenuation_distance = 0.5f;
    ball.attenuation_color = {0.3f, 0.8f, 0.5f};
    Scene scene = sphere_scene(ball);
    scene.instances[0].world_from_object =
        glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 0.0, 0.0)), glm::dvec3(1.2));
    scene.materials[0].transmission_texture = add_noise(scene, 16, 5, {128, 0, 0});
    scene.materials[0].thickness_texture = add_noise(scene, 16, 6, {0, 64, 0});
    Material front = glass({0.9f, 0.6f, 0.4f});
    front.metallic = 0.4f;
    front.sheen_color = {0.2f, 0.2f, 0.3f};
    front.sheen_roughness = 0.5f;
    front.alpha_mode = AlphaMode::blend;
    front.base_color.w = 0.7f;
    add_glass_pane(scene, front, 1.5, 0.4);
    Material back = glass({0.5f, 0.7f, 0.9f});
    back.transmission = 0.6f;
    back.clearcoat = 0.5f;
    back.specular = 0.4f;
    add_glass_pane(scene, back, -1.5, -0.3);
    Material wall;
    wall.metallic = 0.0f;
    wall.roughness = 0.6f;
    wall.double_sided = true;
    add_glass_pane(scene, wall, -2.5, 0.1);
    scene.materials.back().base_color_texture = add_noise(scene, 8, 7, {32, 32, 32});
    return with_ring_of_lights(std::move(scene));
}

/// Whether no layer is seen at a grazing angle at the pixel.
inline bool is_faced(const std::vector<SurfaceSamples>& layers, std::size_t i, bool orthographic) {
    return std::ranges::all_of(layers, [&](const SurfaceSamples& layer) {
        const SurfaceSample& s = layer.pixels[i];
        return s.kind == SurfaceKind::background ||
               (orthographic ? s.normal.z : glm::dot(s.normal, -glm::normalize(s.position))) > 0.2;
    });
}

/// Relative differences at the pixels off the sphere's silhouette.
inline std::vector<double> glass_differences(const Scene& scene, const RenderSettings& settings,
                                             const Camera& camera = kGlassCamera) {
    Renderer renderer(scene, settings);
    const Frame frame = renderer.render(camera, 0.0);
    const std::vector<SurfaceSamples> layers =
        RayCaster(scene).cast_layers(camera, settings.width, settings.height);
    const ReferencePicture expected =
        shade_reference(layers, reference_lights(scene.lights, camera, &scene),
                        reference_options(renderer, camera));
    EXPECT_EQ(layers.size(), 4u);
    std::vector<double> out;
    for (std::size_t i = 0; i < frame.radiance.size(); ++i) {
        const double right = expected.radiance.rgb[i];
        if (layers[0].pixels[i / 3].kind == SurfaceKind::background) continue;
        if (!is_faced(layers, i / 3, camera.orthographic)) continue;
        out.push_back(std::abs(frame.radiance[i] - right) / right);
    }
    EXPECT_GT(out.size(), frame.radiance.size() / 8);
    return out;
}

}  // namespace kilolux
