// SPDX-License-Identifier: Apache-2.0
#include "host/interop/gbuffer_bridge.h"

#include <chrono>

#include "host/gpu/program.h"
#include "raster/gl_debug.h"
#include "raster/gl_object.h"

namespace kilolux {
namespace {

constexpr std::string_view kStage = "gbuffer_bridge";

void wait_for(GLsync fence) {
    constexpr GLuint64 kSecond = 1'000'000'000;
    GLenum status = GL_TIMEOUT_EXPIRED;
    while (status == GL_TIMEOUT_EXPIRED) {
        status = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kSecond);
    }
    if (status == GL_WAIT_FAILED) {
        check_gl_errors(kStage);
        throw Error("gbuffer_bridge: OpenGL's wait for a copy failed");
    }
}

}  // namespace

// The pixel buffer, its mapping, and the device's buffer over or beside it.
struct GBufferBridge::Staging {
    GlBuffer pixels;
    void* mapping = nullptr;
    std::size_t bytes = 0;
    cl::Buffer device;
};

void GBufferBridge::DeleteFence::operator()(GLsync fence) const { glDeleteSync(fence); }

GBufferBridge::GBufferBridge(const Gpu& gpu) : gpu_(gpu) {}
GBufferBridge::~GBufferBridge() = default;
GBufferBridge::GBufferBridge(GBufferBridge&&) noexcept = default;
GBufferBridge& GBufferBridge::operator=(GBufferBridge&&) noexcept = default;

void GBufferBridge::make_staging(std::size_t bytes) {
    staging_ = nullptr;  // before the new one is there: both might not fit
    auto staging = std::make_unique<Staging>();
    constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    staging->pixels = make_buffer();
    glNamedBufferStorage(staging->pixels.name(), static_cast<GLsizeiptr>(bytes), nullptr,
                         kAccess | GL_CLIENT_STORAGE_BIT);
    staging->mapping =
        glMapNamedBufferRange(staging->pixels.name(), 0, static_cast<GLsizeiptr>(bytes), kAccess);
    check_gl_errors(kStage);
    if (!staging->mapping)
        throw Error("gbuffer_bridge: OpenGL cannot map a pixel buffer of " +
                    std::to_string(bytes >> 20) + " MiB");
    staging->bytes = bytes;
    const cl_mem_flags flags =
        gpu_.info.is_cpu ? CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR : CL_MEM_READ_ONLY;
    staging->device =
        cl::Buffer(gpu_.context, flags, bytes, gpu_.info.is_cpu ? staging->mapping : nullptr);
    staging_ = std::move(staging);
}

// OpenGL reads every plane into the pixel buffer.
std::vector<GBufferBridge::PlaneCopy> GBufferBridge::start_reads(const GBufferTargets& targets,
                                                                 const GBufferLayout& layout,
                                                                 const View& view, int first_row) {
    std::vector<PlaneCopy> copies;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, staging_->pixels.name());
    for (const PlaneRead& read : targets.reads()) {
        const std::size_t offset = layout.offset_bytes[read.plane];
        read_plane(targets, read, view.stride, {first_row, static_cast<int>(view.height)},
                   reinterpret_cast<void*>(offset));  // NOLINT(performance-no-int-to-ptr)
        const std::size_t element = plane_element_bytes(layout.layout, read.plane);
        copies.push_back({offset, element * view.stride * view.height,
                          Fence(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0))});
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    return copies;
}

// While OpenGL reads the next plane.
void GBufferBridge::upload(const PlaneCopy& copy) {
    const auto* plane = static_cast<const std::byte*>(staging_->mapping) + copy.offset;
    gpu_.queue.enqueueWriteBuffer(staging_->device, CL_FALSE, copy.offset, copy.bytes, plane);
}

GBuffer GBufferBridge::transfer(const GBufferTargets& targets, const GBufferNeeds& needs,
                                const View& view, int first_row) {
    return in_stage(kStage, [&] {
        wait_for(Fence(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)).get());
        const auto start = std::chrono::steady_clock::now();  // what came before was drawing
        GBuffer out;
        out.layout = make_gbuffer_layout(needs, view.stride, view.height);
        out.view = view;
        const std::size_t bytes = gbuffer_bytes(out.layout, view.stride, view.height);
        if (!staging_ || staging_->bytes < bytes) make_staging(bytes);
        const std::vector<PlaneCopy> copies = start_reads(targets, out.layout, view, first_row);
        for (const PlaneCopy& copy : copies) {
            wait_for(copy.read.get());
            if (!gpu_.info.is_cpu) upload(copy);
        }
        check_gl_errors(kStage);
        if (gpu_.info.is_cpu) {
            // Tells the device that the memory behind its buffer has changed.
            void* mapped = gpu_.queue.enqueueMapBuffer(staging_->device, CL_FALSE,
                                                       CL_MAP_WRITE_INVALIDATE_REGION, 0, bytes);
            gpu_.queue.enqueueUnmapMemObject(staging_->device, mapped);
        }
        out.bytes = staging_->device;
        last_ms_ =
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count();
        return out;
    });
}

}  // namespace kilolux
