// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/device_tables.h"
#include "host/gpu/kernel_types.h"
#include "host/gpu/program.h"
#include "host/gpu/stage_timer.h"
#include "kernels/shared/view.h"

namespace kilolux {

/// The work-items of a launch.
struct WorkSize {
    cl::NDRange global, local;
    bool is_fixed = false;  // the kernel depends on the size of its groups
};

/// `count` work-items in groups of `group`, rounded up: the kernel guards the ragged end.
inline WorkSize items(std::size_t count, int group) {
    const auto size = static_cast<std::size_t>(group);
    return {cl::NDRange(round_up(count, size)), cl::NDRange(size)};
}

/// `count` work-groups of exactly `group` work-items.
inline WorkSize groups(std::size_t count, int group) {
    const auto size = static_cast<std::size_t>(group);
    return {cl::NDRange(count * size), cl::NDRange(size), true};
}

/// The same work-items in groups of at most `largest`, which a device allows the kernel. Throws
/// Error with `stage` and both sizes where the groups are fixed.
WorkSize fit_groups(const WorkSize& size, std::size_t largest, std::string_view stage);

/// Arguments that kernels take together. `each(set)` calls set(name, value) for every parameter of
/// a macro of kernels/device/arguments.h, in its order, and set(bundle) for a bundle within it.
template <typename T>
concept ArgumentBundle = requires(const T& value) {
    value.each([](const auto&...) {});
};

/// One kernel of a stage, for one thread at a time. A launch sets all arguments in their order.
/// Where other threads build programs, the first call that needs this one waits for it, and throws
/// as KernelProgram::built() does; the Gpu's programs must live till then.
class Kernel {
 public:
    /// `stage` names the launches in times and error messages. Throws Error with it,
    /// and as KernelProgram::built() where no other threads build. `name` is not copied.
    Kernel(const Gpu& gpu, KernelProgram program, std::string_view stage, const char* name);

    /// Lanes of the kernel's FV.
    std::size_t lanes() const { return static_cast<std::size_t>(program_.lanes); }
    /// A work-item for every vector of `count` elements, in groups of `group`.
    WorkSize vector_items(std::size_t count, int group) const {
        return items((count + lanes() - 1) / lanes(), group);
    }
    /// A work-item for every vector of pixels of a row. A work-group is as wide as a fine tile and
    /// `rows` high, or as many as the device allows this kernel.
    WorkSize pixel_items(const View& view, int rows) const;
    /// The same for whole tiles: of blocks of pixels (kernels/surfaces/block.h).
    WorkSize block_items(const View& view, int rows) const;

    /// Enqueues only. Arguments are bundles, buffers, uint, float and structs of kernels/shared; an
    /// optional bundle or buffer that is empty is null. Throws Error with stage and error name, and
    /// with Gpu::checks_arguments where an argument is not the kernel's parameter.
    template <typename... Arguments>
    void enqueue(const WorkSize& size, StageTimer& timer, const Arguments&... arguments) {
        in_stage(stage_, [&] {
            Setter set{*this, made()};
            (set(arguments), ...);
            take_wait(timer);
            const bool is_first = is_first_launch(size.local);
            timer.record(stage_, launch(size), is_first);
        });
    }

 private:
    // What needs the program.
    struct Made {
        cl::Kernel kernel;
        std::size_t largest_group = 0;                     // work-items that the device allows
        std::vector<KernelParameter> parameters;           // with Gpu::checks_arguments
        std::vector<std::array<std::size_t, 3>> launched;  // sizes of groups
        // Waiting for the program, until a timer has it.
        std::optional<std::array<StageTimer::Clock::time_point, 2>> wait;
    };
    // Sets arguments one after the other.
    struct Setter {
        const Kernel& kernel;
        Made& made;
        cl_uint index = 0;

        void operator()(const ArgumentBundle auto& bundle) { bundle.each(*this); }
        template <typename T>
        requires(!ArgumentBundle<T>) void operator()(const T& value) {
            (*this)(std::string_view(), value);
        }
        template <typename T>
        void operator()(std::string_view name, const T& value) {
            static_assert(std::is_same_v<T, uint> || std::is_same_v<T, float> || std::is_class_v<T>,
                          "bool, size_t and int have other sizes or signs on the device");
            if constexpr (std::is_base_of_v<cl::Memory, T>) {
                kernel.check_argument(index, name, {}, true);
            } else {
                kernel.check_argument(index, name, kKernelType<T>, false);
            }
            made.kernel.setArg(index++, value);
        }
        template <typename T>
        void operator()(std::string_view name, const DeviceArray<T>& array) {
            kernel.check_argument(index, name, kKernelType<T>, true);
            made.kernel.setArg(index++, array.buffer());
        }
        template <typename T>
        void operator()(std::string_view name, const std::optional<DeviceArray<T>>& array) {
            (*this)(name, array.value_or(DeviceArray<T>()));
        }
        void operator()(std::string_view name, SrgbTable) {
            (*this)(name, DeviceArray<float>(kernel.tables_->srgb, 0));
        }
        void operator()(SrgbBucketTables) {
            (*this)("bucket_boundary", DeviceArray<float>(kernel.tables_->bucket_boundary, 0));
            (*this)("bucket_code", DeviceArray<uint>(kernel.tables_->bucket_code, 0));
        }
    };

    void check_argument(cl_uint index, std::string_view name, std::string_view type,
                        bool is_memory) const {
        if (!made().parameters.empty()) compare_argument(index, name, type, is_memory);
    }
    void compare_argument(cl_uint index, std::string_view name, std::string_view type,
                          bool is_memory) const;
    cl::Event launch(const WorkSize& size);
    bool is_first_launch(const cl::NDRange& group);

    Made& made() const;
    void take_wait(StageTimer& timer);

    cl::CommandQueue queue_;
    cl::Device device_;
    KernelProgram program_;
    std::string stage_;
    const char* name_;
    bool checks_arguments_;
    std::shared_ptr<const DeviceTables> tables_;
    mutable std::optional<Made> made_;
};

}  // namespace kilolux
