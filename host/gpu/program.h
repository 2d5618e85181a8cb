// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/base/error.h"
#include "host/gpu/device.h"
#include "host/gpu/device_tables.h"

namespace kilolux {

/// -D options of a kernel build: tunables and scene features, never formats that both sides share.
class BuildOptions {
 public:
    BuildOptions& define(std::string_view name, int value);
    BuildOptions& define(std::string_view name, std::string_view value);
    BuildOptions& flag(std::string_view text);  // a compiler option, e.g. "-cl-fast-relaxed-math"
    const std::string& text() const { return text_; }

 private:
    std::string text_;
};

/// What every program begins with. Kernels say fma where they mean it: the same bits for every lane
/// width and on every call site. Clang warns that wide vectors change the ABI of functions; ours
/// are all inlined.
inline constexpr std::string_view kKernelPrologue =
    "#pragma OPENCL FP_CONTRACT OFF\n"
    "#ifdef __clang__\n"
    "#if __has_warning(\"-Wpsabi\")\n"
    "#pragma clang diagnostic ignored \"-Wpsabi\"\n"
    "#endif\n"
    "#endif\n";

/// A built program, and the lanes that its kernels' FV has.
struct KernelProgram : cl::Program {
    int lanes = 1;
};

/// When the host built a program.
struct BuildSpan {
    std::chrono::steady_clock::time_point start, end;
};

/// Building for longer is worth a word to the user.
inline constexpr double kLongBuildSeconds = 1.0;

/// What copies of a Gpu share: the programs of one context by options and text, and the tables that
/// kernels read. They live as long as a Gpu that shares them.
class ProgramCache {
 public:
    /// The program of `key`; made by `build` if it is new.
    template <typename Build>
    KernelProgram find(const std::string& key, const Build& build) {
        const std::scoped_lock lock(mutex_);
        auto found = programs_.find(key);
        if (found == programs_.end()) found = programs_.emplace(key, build()).first;
        return found->second;
    }
    /// Adds the time of a build, or of a first launch, before which drivers compile. Returns
    /// whether all together then are long for the first time: the user waits.
    bool add_build_time(double seconds) {
        const std::scoped_lock lock(times_);
        const double before = std::exchange(build_seconds_, build_seconds_ + seconds);
        return before < kLongBuildSeconds && build_seconds_ >= kLongBuildSeconds;
    }
    double build_seconds() const {
        const std::scoped_lock lock(times_);
        return build_seconds_;
    }
    /// Adds the time in which a program was built.
    void add_build(const BuildSpan& span) {
        const std::scoped_lock lock(times_);
        builds_.push_back(span);
    }
    /// The builds since the last call.
    std::vector<BuildSpan> take_builds() {
        const std::scoped_lock lock(times_);
        return std::exchange(builds_, {});
    }
    /// The tables; made by `make` if there are none yet.
    template <typename Make>
    std::shared_ptr<const DeviceTables> tables(const Make& make) {
        const std::scoped_lock lock(mutex_);
        if (!tables_) tables_ = std::make_shared<const DeviceTables>(make());
        return tables_;
    }

 private:
    std::mutex mutex_;
    std::map<std::string, KernelProgram> programs_;
    std::shared_ptr<const DeviceTables> tables_;
    mutable std::mutex times_;  // of those that follow; a build holds the other mutex for long
    double build_seconds_ = 0.0;
    std::vector<BuildSpan> builds_;
};

/// Whether kernels/device/pocl_builtins.h replaces the driver's opencl-c.h. Tested with PoCL 3.1
/// only.
bool takes_our_declarations(const DeviceInfo& device);

/// The program of one stage, `kernels/<stem>.cl`, built for the device with its lane width as VW.
/// Copies of a Gpu share programs: the same text and options are built once.
/// Throws Error with file, device, options and the compiler's log; Interrupted, before it builds,
/// once a signal has asked for the end.
KernelProgram build_program(const Gpu& gpu, std::string_view stem,
                            const BuildOptions& options = {});

/// The same of a text without includes, which `name` names in messages. Where the device
/// takes_our_declarations(), it may call only the built-in functions that they declare.
KernelProgram build_text(const Gpu& gpu, const std::string& name, std::string_view text,
                         const BuildOptions& options);

/// Rounds a global size up to whole work-groups.
constexpr std::size_t round_up(std::size_t value, std::size_t multiple) {
    return (value + multiple - 1) / multiple * multiple;
}

/// Name of an OpenCL error code, e.g. "CL_OUT_OF_RESOURCES".
std::string cl_error_name(int code);

/// Runs `body`, turning cl::Error into Error("<stage>: <call> failed with <name>").
template <typename Body>
auto in_stage(std::string_view stage, Body&& body) {
    try {
        return body();
    } catch (const cl::Error& error) {
        throw Error(std::string(stage) + ": " + error.what() + " failed with " +
                    cl_error_name(error.err()));
    }
}

}  // namespace kilolux
