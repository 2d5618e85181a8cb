// SPDX-License-Identifier: Apache-2.0
#include "host/interop/gbuffer_bridge.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "host/base/system/parallel.h"
#include "host/gpu/program.h"
#include "raster/gl_debug.h"

namespace kilolux {
namespace {

void wait_for(GLsync fence) {
    constexpr GLuint64 kSecond = 1'000'000'000;
    constexpr int kMostSeconds = 600;  // longer than any frame: the driver hangs
    GLenum status = GL_TIMEOUT_EXPIRED;
    for (int second = 0; status == GL_TIMEOUT_EXPIRED && second < kMostSeconds; ++second) {
        status = glClientWaitSync(fence, GL_SYNC_FLUSH_COMMANDS_BIT, kSecond);
    }
    if (status == GL_TIMEOUT_EXPIRED) {
        throw Error(
            fmt::format("gbuffer_bridge: OpenGL has not made a frame in {} s: its driver "
                        "hangs",
                        kMostSeconds));
    }
    if (status == GL_WAIT_FAILED) {
        check_gl_errors(kGBufferBridgeStage);
        throw Error("gbuffer_bridge: OpenGL's wait for a copy failed");
    }
}

}  // namespace

StageWork bridge_work(const StageCounts& c) {
    const double bytes = c.bridge_bytes_per_pixel * c.pixels;
    if (c.device_is_host) return {.bytes_read = bytes, .bytes_written = bytes};
    return {.bytes_uploaded = bytes};
}

void GBufferBridge::DeleteFence::operator()(GLsync fence) const { glDeleteSync(fence); }

void GBufferBridge::make_staging(std::size_t bytes) {
    staging_ = nullptr;  // before the new one is there: both might not fit
    auto staging = std::make_unique<Staging>(gpu_);
    constexpr GLbitfield kAccess = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    staging->pixels = make_buffer();
    glNamedBufferStorage(staging->pixels.name(), static_cast<GLsizeiptr>(bytes), nullptr,
                         kAccess | GL_CLIENT_STORAGE_BIT);
    staging->mapping =
        glMapNamedBufferRange(staging->pixels.name(), 0, static_cast<GLsizeiptr>(bytes), kAccess);
    check_gl_errors(kGBufferBridgeStage);
    if (!staging->mapping)
        throw Error(
            fmt::format("gbuffer_bridge: OpenGL cannot map a pixel buffer of {} MiB", bytes >> 20));
    staging->bytes = bytes;
    const cl_mem_flags flags =
        gpu_.info.is_cpu ? CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR : CL_MEM_READ_ONLY;
    staging->device =
        cl::Buffer(gpu_.context, flags, bytes, gpu_.info.is_cpu ? staging->mapping : nullptr);
    staging_ = std::move(staging);
}

// Uploads a plane while OpenGL reads the next. OpenCL copies at the bus' rate only from memory that
// it pinned itself; all cores copy the plane there.
void GBufferBridge::upload(const PlaneCopy& copy) {
    constexpr std::size_t kPiece = std::size_t{1} << 20;  // [byte]
    const auto* from = static_cast<const std::byte*>(staging_->mapping) + copy.offset;
    std::byte* to = staging_->pinned.reserve(staging_->bytes) + copy.offset;
    parallel_for(std::size_t{0}, (copy.bytes + kPiece - 1) / kPiece, [&](std::size_t i) {
        const std::size_t first = i * kPiece;
        std::memcpy(to + first, from + first, std::min(kPiece, copy.bytes - first));
    });
    gpu_.queue.enqueueWriteBuffer(staging_->device, CL_FALSE, copy.offset, copy.bytes, to);
}

// OpenGL reads every plane into the pixel buffer; a GPU gets each when it is there.
void GBufferBridge::carry(const GBufferTargets& targets, std::vector<PlaneCopy> planes,
                          std::size_t bytes, const View& view, int first_row) {
    wait_for(Fence(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)).get());
    const auto start = std::chrono::steady_clock::now();  // time up to here was drawing
    if (!staging_ || staging_->bytes < bytes) make_staging(bytes);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, staging_->pixels.name());
    for (PlaneCopy& plane : planes) {
        read_plane(targets, plane.read, view.stride,
                   reinterpret_cast<void*>(plane.offset),  // NOLINT(performance-no-int-to-ptr)
                   {first_row, static_cast<int>(view.height)});
        plane.done = Fence(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    for (const PlaneCopy& plane : planes) {
        wait_for(plane.done.get());
        if (!gpu_.info.is_cpu) upload(plane);
    }
    check_gl_errors(kGBufferBridgeStage);
    if (gpu_.info.is_cpu) {
        // Tells the device that the memory behind its buffer has changed.
        void* mapped = gpu_.queue.enqueueMapBuffer(staging_->device, CL_FALSE,
                                                   CL_MAP_WRITE_INVALIDATE_REGION, 0, bytes);
        gpu_.queue.enqueueUnmapMemObject(staging_->device, mapped);
    }
    last_ms_ =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

GBuffer GBufferBridge::transfer(const GBufferTargets& targets, const GBufferNeeds& needs,
                                const View& view, int first_row) {
    return in_stage(kGBufferBridgeStage, [&] {
        GBuffer out;
        out.layout = make_gbuffer_layout(needs, view.stride, view.height);
        out.view = view;
        std::vector<PlaneCopy> planes;
        for (const PlaneRead& read : targets.reads()) {
            const std::size_t element = plane_element_bytes(out.layout.layout, read.plane);
            planes.push_back({read, out.layout.offset_bytes[read.plane],
                              element * view.stride * view.height, Fence()});
        }
        carry(targets, std::move(planes), gbuffer_bytes(out.layout, view.stride, view.height), view,
              first_row);
        out.bytes = staging_->device;
        return out;
    });
}

DeviceArray<uint> GBufferBridge::transfer_ids(const GBufferTargets& targets, const View& view,
                                              int first_row) {
    return in_stage(kGBufferBridgeStage, [&] {
        const std::size_t count = std::size_t{view.stride} * view.height;
        std::vector<PlaneCopy> planes;
        planes.push_back({targets.reads().front(), 0, count * sizeof(uint), Fence()});
        carry(targets, std::move(planes), count * sizeof(uint), view, first_row);
        return DeviceArray<uint>(staging_->device, count);
    });
}

}  // namespace kilolux
