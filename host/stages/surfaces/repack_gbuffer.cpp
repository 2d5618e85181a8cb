// SPDX-License-Identifier: Apache-2.0
#include "host/stages/surfaces/repack_gbuffer.h"

#include "host/base/formats/gbuffer_layout.h"
#include "host/gpu/memory/picture_memory.h"

namespace kilolux {
namespace {

// The source in the kernel's form.
struct RepackSource {
    const SourceGBuffer& planes;
    uint pitch, invert, world_normals;

    void each(auto&& set) const {
        set("depth", planes.depth);
        set("normal", planes.normal);
        set("albedo", planes.albedo);
        set("pitch", pitch);
        set("invert", invert);
        set("world_normals", world_normals);
        set("roughness", planes.roughness.value_or(ROUGHNESS_OF_ALBEDO));
    }
};

BuildOptions options_of(const SourceFormat& format) {
    BuildOptions options = feature_options(KernelFeatures{});
    options.define("DEPTH_FORMAT", static_cast<int>(format.depth))
        .define("NORMAL_FORMAT", static_cast<int>(format.normal))
        .define("NORMAL", format.normal == NormalFormat::float4 ? "float4" : "uint")
        .define("ALBEDO_FORMAT", static_cast<int>(format.albedo))
        .define("ALBEDO", format.albedo == AlbedoFormat::half4 ? "half" : "uint")
        .define("FROM_IMAGES", format.images);
    return options;
}

}  // namespace

RepackGBuffer::RepackGBuffer(const Gpu& gpu, const Tuning& tuning, const SourceFormat& format)
    : tuning_(tuning),
      format_(format),
      kernel_(gpu, build_program(gpu.with_lanes(1), kRepackGbufferStage, options_of(format)),
              kRepackGbufferStage, "repack_gbuffer"),
      gbuffer_(gpu, kRepackGbufferStage) {}

GBuffer RepackGBuffer::enqueue(const SourceGBuffer& source, const MatrixView& camera,
                               StageTimer& timer) {
    const View& view = camera.view;
    const uint pitch = source.pitch == 0 ? view.width : source.pitch;
    const auto check = [&](const char* name, const cl::Memory& memory, uint pixel_bytes) {
        check_picture_memory(std::string(kRepackGbufferStage) + ": " + name, memory,
                             {view.width, view.height, pitch, pixel_bytes, format_.images});
    };
    check("depth", source.depth, 4);
    check("normals", source.normal, format_.normal == NormalFormat::float4 ? 16 : 4);
    check("albedo", source.albedo, format_.albedo == AlbedoFormat::half4 ? 8 : 4);
    const GBufferLayout layout = make_gbuffer_layout({}, view.stride, view.height);
    GBuffer out{gbuffer_.reserve(gbuffer_bytes(layout, view.stride, view.height)), layout, view};
    const RepackSource from{source, pitch, camera.invert_depth ? 1u : 0u,
                            format_.world_normals ? 1u : 0u};
    kernel_.enqueue(items(std::size_t{view.stride} * view.height, tuning_.light_group), timer, from,
                    layout, view, SrgbBucketTables{}, out.bytes);
    return out;
}

}  // namespace kilolux
