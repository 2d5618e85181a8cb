// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CL/opencl.hpp>
#include <atomic>
#include <chrono>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <map>
#include <memory>
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

/// A program that is built once, by the first thread that comes to it. Others wait.
class ProgramBuild {
 public:
    using Make = std::function<cl::Program()>;
    explicit ProgramBuild(Make make) : make_(std::move(make)) {}

    /// Throws what `make` threw.
    const cl::Program& program();
    /// Whether it was built and failed.
    bool has_failed() const { return failed_; }
    /// Waits for the thread that builds. If there is none, nobody will build: program() throws.
    void abandon();

 private:
    std::once_flag once_;
    Make make_;
    cl::Program program_;
    std::exception_ptr error_;
    std::atomic<bool> failed_ = false;
};

/// A program, built or being built, and the lanes that its kernels' FV has.
struct KernelProgram {
    std::shared_ptr<ProgramBuild> build;
    int lanes = 1;

    /// Builds it, or waits until another thread has. Throws as build_program() says.
    const cl::Program& built() const { return build->program(); }
};

/// Building for longer is worth a word to the user.
inline constexpr double kLongBuildSeconds = 1.0;

/// What copies of a Gpu share: the programs of one context by options and text, and the tables that
/// kernels read. They live as long as a Gpu that shares them.
class ProgramCache {
 public:
    ~ProgramCache();

    /// From now on other threads build programs, unless the address space is limited. The
    /// destructor waits for builds that have begun. It must run before main() returns: drivers'
    /// compilers do not work while static objects are destroyed.
    void build_in_background();
    bool builds_in_background() const;

    /// The program of `key`; if it is new or has failed `make` will build it, in another thread or
    /// at its first use.
    std::shared_ptr<ProgramBuild> find(const std::string& key, ProgramBuild::Make make);

    /// Called around each build. end_build() returns true once: when builds and first launches, in
    /// which drivers compile, are together longer than kLongBuildSeconds.
    void begin_build();
    bool end_build();
    /// Adds the time before first launches. Returns as end_build() does.
    bool add_build_time(double seconds);
    /// For how long programs were built; times of several threads count once.
    double build_seconds() const;

    /// The tables; made by `make` if there are none yet.
    template <typename Make>
    std::shared_ptr<const DeviceTables> tables(const Make& make) {
        const std::scoped_lock lock(tables_mutex_);
        if (!tables_) tables_ = std::make_shared<const DeviceTables>(make());
        return tables_;
    }

 private:
    void start_builder();
    void build_waiting();
    std::shared_ptr<ProgramBuild> next_waiting();
    bool add_seconds(double seconds);

    mutable std::mutex mutex_;  // of those that follow
    bool in_background_ = false;
    std::map<std::string, std::shared_ptr<ProgramBuild>> programs_;
    std::deque<std::shared_ptr<ProgramBuild>> waiting_;
    std::vector<std::future<void>> builders_;
    int working_ = 0;  // builders

    std::mutex tables_mutex_;
    std::shared_ptr<const DeviceTables> tables_;

    mutable std::mutex times_;                              // of those that follow
    int building_ = 0;                                      // threads
    std::chrono::steady_clock::time_point building_since_;  // not yet in build_seconds_
    double build_seconds_ = 0.0;
};

/// Whether kernels/device/pocl_builtins.h replaces the driver's opencl-c.h. Tested with PoCL 3.1
/// only.
bool takes_our_declarations(const DeviceInfo& device);

/// The program of one stage, `kernels/<stem>.cl`, built for the device with its lane width as VW.
/// Copies of a Gpu share programs: the same text and options are built once. Throws Error where the
/// text cannot be read. KernelProgram::built() throws Error with file, device, options and the
/// compiler's log; Interrupted, before it builds, once a signal has asked for the end.
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
