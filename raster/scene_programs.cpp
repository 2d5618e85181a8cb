// SPDX-License-Identifier: Apache-2.0
#include "raster/scene_programs.h"

namespace kilolux {
namespace {

constexpr GLint kDrawnInstance = 0;  // uniform of scene.glsl

// Draws the far side of a surface that blends first.
void draw_faces(const GpuScene& scene, std::size_t mesh) {
    const Material& material = scene.material_of_mesh(mesh);
    const bool blends = is_blended(scene.scene(), scene.scene().meshes[mesh]);
    if (material.double_sided && !blends) {
        glDisable(GL_CULL_FACE);
        scene.draw(mesh);
        return;
    }
    glEnable(GL_CULL_FACE);
    if (material.double_sided) {
        glCullFace(GL_FRONT);
        scene.draw(mesh);
        glCullFace(GL_BACK);
    }
    scene.draw(mesh);
}

Defines variant_defines(const SurfaceFeatures& features, const ScenePass& pass) {
    Defines defines = surface_macros(features);
    defines.emplace_back("HAS_MASKS", features.masks ? "1" : "0");
    defines.emplace_back("HAS_UNLIT_MATERIALS", "1");
    defines.insert(defines.end(), pass.defines.begin(), pass.defines.end());
    return defines;
}

}  // namespace

ScenePass coverage_pass(Coverage writes) {
    ScenePass pass{.fragment = "raster/shaders/coverage.frag",
                   .defines = feature_macros({}),
                   .coverage = true};
    pass.defines.emplace_back("WRITES_IDS", writes == Coverage::ids ? "1" : "0");
    pass.defines.emplace_back("WRITES_COUNT", writes == Coverage::count ? "1" : "0");
    return pass;
}

CameraRow camera_row(const Camera& camera, const View& view, int width, int height) {
    const glm::mat4 clip(clip_from_view(camera, width, height));
    CameraRow out{view, {}};
    for (int i = 0; i < 4; ++i) {
        out.clip_from_view[i] = {clip[i].x, clip[i].y, clip[i].z, clip[i].w};
    }
    return out;
}

ScenePrograms::ScenePrograms(const GpuScene& scene, const ScenePass& pass)
    : scene_(scene), camera_(make_buffer()) {
    for (std::size_t i = 0; i < scene.scene().meshes.size(); ++i) {
        const Mesh& mesh = scene.scene().meshes[i];
        features_.push_back(
            pass.coverage ? coverage_features(scene.scene(), mesh)
                          : mesh_features(scene.scene(), mesh, pass.uses, scene.anisotropy()));
        const bool blends = is_blended(scene.scene(), mesh);
        if (blends != pass.blended) continue;
        GlProgram& program = programs_[features_.back()];
        if (program) continue;
        program = load_program("raster/shaders/scene.vert", pass.fragment,
                               variant_defines(features_.back(), pass));
    }
}

void ScenePrograms::draw(std::span<const Draw> draws, const CameraRow& camera) const {
    glNamedBufferData(camera_.name(), sizeof(camera), &camera, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, CAMERA_BLOCK, camera_.name());
    scene_.bind(draws);
    GLuint current = 0;
    for (std::size_t i = 0; i < draws.size(); ++i) {
        const auto mesh = static_cast<std::size_t>(draws[i].mesh);
        const GLuint program = programs_.at(features_[mesh]).name();
        if (program != current) glUseProgram(program);
        current = program;
        scene_.bind_maps(mesh, features_[mesh].texture_uses);
        glUniform1ui(kDrawnInstance, static_cast<GLuint>(i));
        glFrontFace(draws[i].mirrored ? GL_CW : GL_CCW);
        draw_faces(scene_, mesh);
    }
}

}  // namespace kilolux
