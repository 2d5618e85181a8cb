// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>
#include <vector>

#include "host/base/formats/gbuffer_layout.h"
#include "host/gpu/device.h"
#include "host/gpu/flow.h"
#include "host/gpu/memory/pinned_memory.h"
#include "host/gpu/stage_info.h"
#include "raster/gbuffer_targets.h"
#include "raster/gl_object.h"

namespace kilolux {

/// Brings what OpenGL drew to the device: by a copy, or, where the device has its own memory, by an
/// upload.
StageWork bridge_work(const StageCounts& counts);
inline constexpr StageInfo kGBufferBridgeStage = {"gbuffer_bridge", StageGroup::surfaces,
                                                  bridge_work, true};

/// Carries what OpenGL drew to OpenCL: a G-buffer's planes, or triangle ids, in one buffer.
///
/// The staged copy works everywhere: OpenGL reads its attachments into a persistently mapped pixel
/// buffer, whose memory a CPU device uses in place (no copy on the OpenCL side) and a GPU gets
/// uploaded, a plane while OpenGL reads the next.
class GBufferBridge {
 public:
    explicit GBufferBridge(const Gpu& gpu) : gpu_(gpu) {}

    /// The planes of what was drawn to `targets`, on the device. Waits for OpenGL to finish, not
    /// for OpenCL. Valid until the next call; the queue must be done with the last result before
    /// it. `view`'s rows begin at row `first_row` of the targets.
    GBuffer transfer(const GBufferTargets& targets, const GBufferNeeds& needs, const View& view,
                     int first_row = 0);

    /// As transfer(), of the ids pass: [view.height][view.stride], undefined past the width.
    DeviceArray<uint> transfer_ids(const GBufferTargets& targets, const View& view,
                                   int first_row = 0);

    /// Host time of the last transfer after the drawing ended, OpenGL's reading included [ms].
    double last_ms() const { return last_ms_; }

 private:
    // The pixel buffer, its mapping, and the device's buffer over or beside it.
    struct Staging {
        explicit Staging(const Gpu& gpu) : pinned(gpu) {}
        GlBuffer pixels;
        void* mapping = nullptr;
        std::size_t bytes = 0;
        cl::Buffer device;
        PinnedMemory pinned;  // of a GPU, as large as the pixel buffer
    };
    struct DeleteFence {
        using pointer = GLsync;
        void operator()(GLsync fence) const;
    };
    using Fence = std::unique_ptr<std::remove_pointer_t<GLsync>, DeleteFence>;
    struct PlaneCopy {
        PlaneRead read;
        std::size_t offset, bytes;
        Fence done;  // signalled once the plane is in the pixel buffer
    };
    void make_staging(std::size_t bytes);
    void carry(const GBufferTargets& targets, std::vector<PlaneCopy> planes, std::size_t bytes,
               const View& view, int first_row);
    void upload(const PlaneCopy& copy);

    Gpu gpu_;
    std::unique_ptr<Staging> staging_;
    double last_ms_ = 0.0;
};

}  // namespace kilolux
