// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/program.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>
#include <thread>

#include "host/base/log.h"
#include "host/base/source.h"
#include "host/base/system/interrupt.h"
#include "host/base/system/memory.h"

namespace kilolux {
namespace {

// What begins a program on this device.
std::string prologue(const DeviceInfo& device) {
    const std::string all(kKernelPrologue);
    if (!takes_our_declarations(device)) return all;
    return splice_source("kernels/device/pocl_builtins.h", false).text + all;
}

std::string build_log(const cl::Program& program, const cl::Device& device) {
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    } catch (const cl::Error&) {
        return "(no log)";
    }
}

// What a build takes. No Gpu: the cache would own itself.
struct BuildInput {
    cl::Context context;
    cl::Device device;
    std::string device_name, file, text, options;
};

cl::Program build(const BuildInput& in) {
    const auto fail = [&](int code, const std::string& log) {
        throw Error(in.file + ": build failed with " + cl_error_name(code) + " on " +
                    in.device_name + ", options '" + in.options + "': " + log);
    };
    cl::Program program;
    try {
        program = cl::Program(in.context, in.text);
    } catch (const cl::Error& error) {
        fail(error.err(), "the source was not taken");
    }
    // clBuildProgram() itself: where there is no log, program.build() reports only that.
    const int code =
        ::clBuildProgram(program(), 1, &in.device(), in.options.c_str(), nullptr, nullptr);
    if (code != CL_SUCCESS) fail(code, build_log(program, in.device));
    return program;
}

// The same, with its time and words to the user.
cl::Program timed_build(const BuildInput& in, ProgramCache& cache) {
    check_interrupt();
    detail("building " + in.file + " " + in.options);
    cache.begin_build();
    const auto end = [&] {
        if (!cache.end_build()) return;
        note_wait("building kernels for " + in.device_name +
                  "; most drivers keep them for the next run ...");
    };
    try {
        cl::Program program = build(in);
        end();
        return program;
    } catch (...) {
        end();
        throw;
    }
}

// Threads that build. Drivers that build one program at a time lose nothing by more (PoCL 3.1: 18
// programs in 1.6 s by one or two; NVIDIA 580, H100: 5.8 s by one, 4.3 by four, 5.4 by eight).
constexpr std::size_t kMostBuilders = 4;

}  // namespace

bool takes_our_declarations(const DeviceInfo& device) {
    return device.is_pocl() && device.driver.starts_with("3.1");
}

const cl::Program& ProgramBuild::program() {
    std::call_once(once_, [&] {
        try {
            program_ = make_();
        } catch (...) {
            error_ = std::current_exception();
            failed_ = true;
        }
        make_ = nullptr;
    });
    if (error_) std::rethrow_exception(error_);
    return program_;
}

void ProgramBuild::abandon() {
    std::call_once(once_, [&] {
        error_ =
            std::make_exception_ptr(Error("a program's device was closed before it was built"));
        make_ = nullptr;
    });
}

ProgramCache::~ProgramCache() {
    {
        const std::scoped_lock lock(mutex_);
        waiting_.clear();
    }
    for (auto& [key, program] : programs_) program->abandon();
    builders_.clear();  // waits
}

void ProgramCache::build_in_background() {
    const std::scoped_lock lock(mutex_);
    in_background_ = !has_address_space_limit();
}

bool ProgramCache::builds_in_background() const {
    const std::scoped_lock lock(mutex_);
    return in_background_;
}

std::shared_ptr<ProgramBuild> ProgramCache::find(const std::string& key, ProgramBuild::Make make) {
    const std::scoped_lock lock(mutex_);
    std::shared_ptr<ProgramBuild>& found = programs_[key];
    if (found && !found->has_failed()) return found;
    found = std::make_shared<ProgramBuild>(std::move(make));
    if (in_background_) {
        waiting_.push_back(found);
        start_builder();
    }
    return found;
}

// With mutex_ locked. Where no thread starts, the first user of the program builds it.
void ProgramCache::start_builder() {
    const std::size_t most =
        std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, kMostBuilders);
    if (working_ >= static_cast<int>(most)) return;
    std::erase_if(builders_, [](const std::future<void>& builder) {
        return builder.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    try {
        builders_.push_back(std::async(std::launch::async, [this] { build_waiting(); }));
        ++working_;
    } catch (const std::system_error&) {
    }
}

void ProgramCache::build_waiting() {
    while (const std::shared_ptr<ProgramBuild> next = next_waiting()) {
        try {
            next->program();
        } catch (...) {  // program() throws it again where the program is used
        }
    }
}

// Null: there is none, and the builder ends.
std::shared_ptr<ProgramBuild> ProgramCache::next_waiting() {
    const std::scoped_lock lock(mutex_);
    if (waiting_.empty()) {
        --working_;
        return nullptr;
    }
    std::shared_ptr<ProgramBuild> next = std::move(waiting_.front());
    waiting_.pop_front();
    return next;
}

void ProgramCache::begin_build() {
    const std::scoped_lock lock(times_);
    if (building_++ == 0) building_since_ = std::chrono::steady_clock::now();
}

bool ProgramCache::end_build() {
    const std::scoped_lock lock(times_);
    const auto end = std::chrono::steady_clock::now();
    --building_;
    const auto since = std::exchange(building_since_, end);
    return add_seconds(std::chrono::duration<double>(end - since).count());
}

bool ProgramCache::add_build_time(double seconds) {
    const std::scoped_lock lock(times_);
    return add_seconds(seconds);
}

// With times_ locked.
bool ProgramCache::add_seconds(double seconds) {
    const double before = std::exchange(build_seconds_, build_seconds_ + seconds);
    return before < kLongBuildSeconds && build_seconds_ >= kLongBuildSeconds;
}

double ProgramCache::build_seconds() const {
    const std::scoped_lock lock(times_);
    return build_seconds_;
}

BuildOptions& BuildOptions::define(std::string_view name, int value) {
    return define(name, std::to_string(value));
}

BuildOptions& BuildOptions::define(std::string_view name, std::string_view value) {
    return flag("-D" + std::string(name) + "=" + std::string(value));
}

BuildOptions& BuildOptions::flag(std::string_view text) {
    if (!text_.empty()) text_ += ' ';
    text_ += text;
    return *this;
}

KernelProgram build_program(const Gpu& gpu, std::string_view stem, const BuildOptions& options) {
    const std::string file = kernel_path(stem);
    return build_text(gpu, file, splice_source(file, false).text, options);
}

KernelProgram build_text(const Gpu& gpu, const std::string& name, std::string_view text,
                         const BuildOptions& options) {
    const std::string all_options =
        "-cl-std=CL1.2 -Werror -DVW=" + std::to_string(gpu.info.lane_width) +
        (takes_our_declarations(gpu.info) ? " -D_OPENCL_H_" : "") +
        (gpu.checks_arguments ? " -cl-kernel-arg-info" : "") + (options.text().empty() ? "" : " ") +
        options.text();
    BuildInput in{
        gpu.context, gpu.device, gpu.info.name, name, prologue(gpu.info) + std::string(text),
        all_options};
    const std::string key = all_options + "\n" + in.text;
    // The cache waits for its builds.
    return {
        gpu.programs->find(key, [in = std::move(in),
                                 cache = gpu.programs.get()] { return timed_build(in, *cache); }),
        gpu.info.lane_width};
}

std::string cl_error_name(int code) {
    static const std::map<int, const char*> names = {
        {CL_DEVICE_NOT_FOUND, "CL_DEVICE_NOT_FOUND"},
        {CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE"},
        {CL_COMPILER_NOT_AVAILABLE, "CL_COMPILER_NOT_AVAILABLE"},
        {CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE"},
        {CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES"},
        {CL_OUT_OF_HOST_MEMORY, "CL_OUT_OF_HOST_MEMORY"},
        {CL_BUILD_PROGRAM_FAILURE, "CL_BUILD_PROGRAM_FAILURE"},
        {CL_INVALID_VALUE, "CL_INVALID_VALUE"},
        {CL_INVALID_CONTEXT, "CL_INVALID_CONTEXT"},
        {CL_INVALID_COMMAND_QUEUE, "CL_INVALID_COMMAND_QUEUE"},
        {CL_INVALID_MEM_OBJECT, "CL_INVALID_MEM_OBJECT"},
        {CL_INVALID_BUILD_OPTIONS, "CL_INVALID_BUILD_OPTIONS"},
        {CL_INVALID_KERNEL_NAME, "CL_INVALID_KERNEL_NAME"},
        {CL_INVALID_KERNEL_ARGS, "CL_INVALID_KERNEL_ARGS"},
        {CL_INVALID_ARG_SIZE, "CL_INVALID_ARG_SIZE"},
        {CL_INVALID_WORK_GROUP_SIZE, "CL_INVALID_WORK_GROUP_SIZE"},
        {CL_INVALID_WORK_ITEM_SIZE, "CL_INVALID_WORK_ITEM_SIZE"},
        {CL_INVALID_BUFFER_SIZE, "CL_INVALID_BUFFER_SIZE"},
        {CL_INVALID_GLOBAL_WORK_SIZE, "CL_INVALID_GLOBAL_WORK_SIZE"},
    };
    const auto found = names.find(code);
    return found != names.end() ? found->second : "OpenCL error " + std::to_string(code);
}

}  // namespace kilolux
