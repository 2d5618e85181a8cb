// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/program.h"

#include <chrono>
#include <string>

#include "host/base/log.h"
#include "host/base/source.h"
#include "host/base/system/interrupt.h"

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

KernelProgram build(const Gpu& gpu, const std::string& file, const std::string& text,
                    const std::string& options) {
    const auto fail = [&](int code, const std::string& log) {
        throw Error(file + ": build failed with " + cl_error_name(code) + " on " + gpu.info.name +
                    ", options '" + options + "': " + log);
    };
    cl::Program program;
    try {
        program = cl::Program(gpu.context, text);
    } catch (const cl::Error& error) {
        fail(error.err(), "the source was not taken");
    }
    // clBuildProgram() itself: where there is no log, program.build() reports only that.
    const int code =
        ::clBuildProgram(program(), 1, &gpu.device(), options.c_str(), nullptr, nullptr);
    if (code != CL_SUCCESS) fail(code, build_log(program, gpu.device));
    return {program, gpu.info.lane_width};
}

}  // namespace

bool takes_our_declarations(const DeviceInfo& device) {
    return device.platform == "Portable Computing Language" && device.driver.starts_with("3.1");
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
    const std::string source = prologue(gpu.info) + std::string(text);
    return gpu.programs->find(all_options + "\n" + source, [&] {
        check_interrupt();
        detail("building " + name + " " + all_options);
        const auto start = std::chrono::steady_clock::now();
        KernelProgram program = build(gpu, name, source, all_options);
        const auto end = std::chrono::steady_clock::now();
        const std::chrono::duration<double> taken = end - start;
        gpu.programs->add_build({start, end});
        if (gpu.programs->add_build_time(taken.count())) {
            note_wait("building kernels for " + gpu.info.name +
                      "; most drivers keep them for the next run ...");
        }
        return program;
    });
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
