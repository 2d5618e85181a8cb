// SPDX-License-Identifier: Apache-2.0
#include "raster/gpu_scene.h"

#include <cstring>

#include "raster/gl_context.h"

namespace kilolux {
namespace {

// Trilinear filtering alone on the CPU: 8 samples cost llvmpipe 3.4 times the geometry pass.
constexpr float kHardwareAnisotropy = 8.0f;

float chosen_anisotropy(float anisotropy) {
    if (anisotropy > 0.0f) return anisotropy;
    return is_software_renderer() ? 1.0f : kHardwareAnisotropy;
}

uint used_features(const Mesh& mesh, const Material& material, GpuSceneUse use) {
    const uint features = features_of(mesh, material);
    const bool shaded = use == GpuSceneUse::shaded || material.alpha_mode == AlphaMode::blend;
    if (shaded) return features;
    if (material.alpha_mode == AlphaMode::opaque) return kFeatureNoSurface;
    return (features & coverage_features()) | kFeatureNoSurface;
}

std::size_t uniform_stride_bytes() {
    GLint alignment = 1;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
    const auto unit = static_cast<std::size_t>(std::max(alignment, 16));
    return (sizeof(MaterialRow) + unit - 1) / unit * unit;
}

}  // namespace

GpuScene::GpuScene(const Scene& scene, float anisotropy, GpuSceneUse use)
    : scene_(scene), textures_(scene, chosen_anisotropy(anisotropy)) {
    const std::size_t row_count = scene.materials.size() + 1;
    const std::size_t stride = uniform_stride_bytes();
    std::vector<std::byte> rows(row_count * stride);
    for (std::size_t i = 0; i < row_count; ++i) {
        const MaterialRow row = material_row(material(static_cast<int>(i)));
        std::memcpy(rows.data() + i * stride, &row, sizeof(row));
    }
    material_stride_bytes_ = static_cast<GLintptr>(stride);
    material_rows_ = make_buffer();
    glNamedBufferStorage(material_rows_.name(), static_cast<GLsizeiptr>(rows.size()), rows.data(),
                         0);
    for (const Mesh& mesh : scene.meshes) {
        const int row = mesh.material < 0 ? static_cast<int>(row_count) - 1 : mesh.material;
        const uint features = used_features(mesh, material(row), use);
        textures_.upload(scene, material(row), features);
        meshes_.push_back(upload_mesh(mesh, row, features));
    }
    check_gl_errors("upload of scene '" + scene.name + "'");
}

void GpuScene::refresh() {
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
        const Mesh& mesh = scene_.meshes[i];
        GpuMesh& old = meshes_[i];
        if (old.revision == mesh.revision) continue;
        old = upload_mesh(mesh, old.material, old.features);
    }
    check_gl_errors("new vertices of scene '" + scene_.name + "'");
}

const Material& GpuScene::material(int row) const {
    const auto index = static_cast<std::size_t>(row);
    return index < scene_.materials.size() ? scene_.materials[index] : default_material_;
}

void GpuScene::bind_material(int row, uint features) const {
    glBindBufferRange(GL_UNIFORM_BUFFER, 0, material_rows_.name(), row * material_stride_bytes_,
                      sizeof(MaterialRow));
    for (int use = 0; use < USE_COUNT; ++use) {
        if ((features & (kFeatureTexture << use)) == 0) continue;
        textures_.bind(scene_, texture_use(material(row), use), use);
    }
}

}  // namespace kilolux
