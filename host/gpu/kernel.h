// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "host/gpu/buffer.h"
#include "host/gpu/program.h"
#include "host/gpu/stage_timer.h"
#include "kernels/shared/view.h"

namespace kilolux {

/// The work-items of a launch.
struct WorkSize {
    cl::NDRange global, local;
};

/// `count` work-items in groups of `group`, rounded up: the kernel guards the ragged end.
inline WorkSize items(std::size_t count, int group) {
    const auto size = static_cast<std::size_t>(group);
    return {cl::NDRange(round_up(count, size)), cl::NDRange(size)};
}

/// `count` work-groups of `group` work-items.
inline WorkSize groups(std::size_t count, int group) {
    const auto size = static_cast<std::size_t>(group);
    return {cl::NDRange(count * size), cl::NDRange(size)};
}

/// A work-item for every `lanes` pixels of a row. A work-group is as wide as a fine tile and `rows`
/// high.
WorkSize pixel_items(const View& view, int lanes, int rows);

/// The same for whole tiles: of blocks of pixels (kernels/surfaces/block.h).
WorkSize block_items(const View& view, int lanes, int rows);

/// One kernel of a stage, made once. A launch sets all arguments in their order.
class Kernel {
 public:
    /// `stage` names the launches in times and error messages. Throws Error with it.
    Kernel(const Gpu& gpu, const cl::Program& program, std::string_view stage, const char* name);

    /// Enqueues only. Arguments are buffers, uint, float and structs of kernels/shared; an optional
    /// one is none where it is empty. Throws Error with stage and error name.
    template <typename... Arguments>
    void enqueue(const WorkSize& size, StageTimer& timer, const Arguments&... arguments) {
        in_stage(stage_, [&] {
            cl_uint index = 0;
            (set(index, arguments), ...);
            timer.record(stage_, launch(size));
        });
    }

 private:
    template <typename T>
    void set(cl_uint& index, const T& value) {
        static_assert(std::is_same_v<T, uint> || std::is_same_v<T, float> || std::is_class_v<T>,
                      "bool, size_t and int have other sizes or signs on the device");
        kernel_.setArg(index++, value);
    }
    template <typename T>
    void set(cl_uint& index, const DeviceArray<T>& array) {
        kernel_.setArg(index++, array.buffer());
    }
    template <typename T>
    void set(cl_uint& index, const std::optional<T>& value) {
        if (value) set(index, *value);
    }

    cl::Event launch(const WorkSize& size);

    cl::CommandQueue queue_;
    cl::Kernel kernel_;
    std::string stage_;
};

}  // namespace kilolux
