// SPDX-License-Identifier: Apache-2.0
#include "raster/scene_programs.h"

#include <glm/gtc/type_ptr.hpp>

namespace kilolux {
namespace {

// Uniform locations of geometry.vert.
constexpr GLint kViewFromObject = 0;
constexpr GLint kNormalFromObject = 3;
constexpr GLint kClipFromView = 6;
constexpr GLint kFirstTriangle = 9;
constexpr GLint kEyeHigh = 10;
constexpr GLint kEyeLow = 11;

void set_object(const InstanceRow& row) {
    glUniform4fv(kViewFromObject, 3, &row.view_from_object[0].x);
    glUniform4fv(kNormalFromObject, 3, &row.normal_from_object[0].x);
    glUniform1ui(kFirstTriangle, row.first_triangle);
    glUniform3fv(kEyeHigh, 1, &row.eye_high.x);
    glUniform3fv(kEyeLow, 1, &row.eye_low.x);
}

void draw_triangles(const GpuMesh& mesh) {
    glBindVertexArray(mesh.vertex_array.name());
    glDrawElements(GL_TRIANGLES, mesh.index_count, GL_UNSIGNED_INT, nullptr);
}

// Of a surface that blends, the far side comes first.
void draw_faces(const GpuMesh& mesh, const Material& material) {
    if (!material.double_sided) {
        glEnable(GL_CULL_FACE);
        draw_triangles(mesh);
    } else if (material.alpha_mode != AlphaMode::blend) {
        glDisable(GL_CULL_FACE);
        draw_triangles(mesh);
    } else {
        glEnable(GL_CULL_FACE);
        glCullFace(GL_FRONT);
        draw_triangles(mesh);
        glCullFace(GL_BACK);
        draw_triangles(mesh);
    }
}

}  // namespace

ScenePass coverage_pass(const std::string& fragment, bool ids) {
    return {fragment, {}, {.surface = false, .ids = ids}, coverage_features()};
}

ScenePrograms::ScenePrograms(const GpuScene& scene, const ScenePass& pass) : mask_(pass.mask) {
    for (const GpuMesh& mesh : scene.meshes()) {
        const bool blends = scene.material(mesh.material).alpha_mode == AlphaMode::blend;
        if (blends != pass.blended) continue;
        GlProgram& program = programs_[mesh.features & mask_];
        if (program) continue;
        Defines defines = feature_defines(mesh.features & mask_, pass.inputs);
        defines.insert(defines.end(), pass.defines.begin(), pass.defines.end());
        program = load_program("raster/shaders/geometry.vert", pass.fragment, defines);
    }
}

void ScenePrograms::draw(const GpuScene& scene, std::span<const Draw> draws,
                         const glm::mat4& clip) const {
    for_each([&](GLuint program) {
        glProgramUniformMatrix4fv(program, kClipFromView, 1, GL_FALSE, glm::value_ptr(clip));
    });
    GLuint current = 0;
    int material = -1;
    for (const Draw& draw : draws) {
        const GpuMesh& mesh = scene.mesh(draw.mesh);
        if (mesh.index_count == 0) continue;
        const GLuint program = programs_.at(mesh.features & mask_).name();
        if (program != current) glUseProgram(program);
        if (program != current || mesh.material != material) {
            scene.bind_material(mesh.material, mesh.features & mask_);
        }
        current = program;
        material = mesh.material;
        glFrontFace(draw.mirrored ? GL_CW : GL_CCW);
        set_object(draw.row);
        draw_faces(mesh, scene.material(mesh.material));
    }
}

}  // namespace kilolux
