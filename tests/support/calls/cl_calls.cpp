// SPDX-License-Identifier: Apache-2.0
// Definitions in the program come before those of the library: they count, and call the library's.
#include "tests/support/cl_calls.h"

#include <CL/cl.h>
#include <dlfcn.h>

#include <atomic>

namespace {

std::atomic<int> launches = 0, blocking_reads = 0, finishes = 0;

template <typename Function>
Function* library_function(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const size_t* offset, const size_t* global, const size_t* local,
                              cl_uint wait_count, const cl_event* waits, cl_event* event) {
    static auto* const next =
        library_function<decltype(clEnqueueNDRangeKernel)>("clEnqueueNDRangeKernel");
    ++launches;
    return next(queue, kernel, dimensions, offset, global, local, wait_count, waits, event);
}

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset,
                           size_t size, void* to, cl_uint wait_count, const cl_event* waits,
                           cl_event* event) {
    static auto* const next =
        library_function<decltype(clEnqueueReadBuffer)>("clEnqueueReadBuffer");
    if (blocking == CL_TRUE) ++blocking_reads;
    return next(queue, buffer, blocking, offset, size, to, wait_count, waits, event);
}

cl_int clFinish(cl_command_queue queue) {
    static auto* const next = library_function<decltype(clFinish)>("clFinish");
    ++finishes;
    return next(queue);
}

namespace kilolux {

ClCalls cl_calls() { return {launches, blocking_reads, finishes}; }

}  // namespace kilolux
