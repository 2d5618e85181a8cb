// SPDX-License-Identifier: Apache-2.0
// A layer between the OpenCL loader and the drivers (OPENCL_LAYERS) that makes one call fail: the
// n-th after fault_layer_arm(n, code), or after the start with KILOLUX_FAULT=n:code; n:code:lost
// makes those after it fail, too.
#include <CL/cl_layer.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

// The drivers' functions, ours that replace them, and the number of the call that fails.
struct Layer {
    const cl_icd_dispatch* next = nullptr;
    cl_icd_dispatch table{};
    std::atomic<int> calls{0};
    std::atomic<int> failing{0};  // 0: none
    std::atomic<int> code{0};
    bool is_lost = false;
};

Layer& layer() {
    static Layer value;
    return value;
}

// The code with which this call fails, or 0.
cl_int fault() {
    Layer& l = layer();
    const int call = ++l.calls;
    return call == l.failing || (l.is_lost && call > l.failing) ? l.code.load() : CL_SUCCESS;
}

// Calls that return a code.
template <auto Entry, typename... Arguments>
cl_int call(Arguments... arguments) {
    const cl_int code = fault();
    return code != CL_SUCCESS ? code : (layer().next->*Entry)(arguments...);
}

// A lost device writes no memory any more, so the driver ends what it does, whatever this returns.
cl_int finish(cl_command_queue queue) {
    const cl_int code = fault();
    const cl_int done = layer().next->clFinish(queue);
    return code != CL_SUCCESS ? code : done;
}

template <auto Entry, typename... Arguments>
void divert(cl_int (*cl_icd_dispatch::*)(Arguments...)) {
    layer().table.*Entry = &call<Entry, Arguments...>;
}

cl_context create_context(const cl_context_properties* properties, cl_uint count,
                          const cl_device_id* devices,
                          void(CL_CALLBACK* notify)(const char*, const void*, size_t, void*),
                          void* user, cl_int* error) {
    const cl_int code = fault();
    if (code == CL_SUCCESS) {
        return layer().next->clCreateContext(properties, count, devices, notify, user, error);
    }
    if (error != nullptr) *error = code;
    return nullptr;
}

cl_command_queue create_queue(cl_context context, cl_device_id device,
                              const cl_queue_properties* properties, cl_int* error) {
    const cl_int code = fault();
    if (code == CL_SUCCESS) {
        return layer().next->clCreateCommandQueueWithProperties(context, device, properties, error);
    }
    if (error != nullptr) *error = code;
    return nullptr;
}

cl_mem create_buffer(cl_context context, cl_mem_flags flags, size_t size, void* host,
                     cl_int* error) {
    const cl_int code = fault();
    if (code == CL_SUCCESS) return layer().next->clCreateBuffer(context, flags, size, host, error);
    if (error != nullptr) *error = code;
    return nullptr;
}

cl_program create_program(cl_context context, cl_uint count, const char** texts,
                          const size_t* lengths, cl_int* error) {
    const cl_int code = fault();
    if (code == CL_SUCCESS) {
        return layer().next->clCreateProgramWithSource(context, count, texts, lengths, error);
    }
    if (error != nullptr) *error = code;
    return nullptr;
}

cl_kernel create_kernel(cl_program program, const char* name, cl_int* error) {
    const cl_int code = fault();
    if (code == CL_SUCCESS) return layer().next->clCreateKernel(program, name, error);
    if (error != nullptr) *error = code;
    return nullptr;
}

void* map_buffer(cl_command_queue queue, cl_mem buffer, cl_bool blocking, cl_map_flags flags,
                 size_t offset, size_t size, cl_uint count, const cl_event* waits, cl_event* event,
                 cl_int* error) {
    const cl_int code = fault();
    if (code == CL_SUCCESS) {
        return layer().next->clEnqueueMapBuffer(queue, buffer, blocking, flags, offset, size, count,
                                                waits, event, error);
    }
    if (error != nullptr) *error = code;
    return nullptr;
}

}  // namespace

extern "C" {

void fault_layer_arm(int call_number, int code) {
    layer().calls = 0;
    layer().code = code;
    layer().failing = call_number;
}

// Since the last arming.
int fault_layer_calls() { return layer().calls; }

CL_API_ENTRY cl_int CL_API_CALL clGetLayerInfo(cl_layer_info name, size_t size, void* value,
                                               size_t* size_ret) {
    constexpr cl_layer_api_version kVersion = CL_LAYER_API_VERSION_100;
    constexpr char kName[] = "kilolux fault layer";
    const bool version = name == CL_LAYER_API_VERSION;
    if (!version && name != CL_LAYER_NAME) return CL_INVALID_VALUE;
    const void* answer = version ? static_cast<const void*>(&kVersion) : kName;
    const size_t bytes = version ? sizeof kVersion : sizeof kName;
    if (value != nullptr && size < bytes) return CL_INVALID_VALUE;
    if (value != nullptr) std::memcpy(value, answer, bytes);
    if (size_ret != nullptr) *size_ret = bytes;
    return CL_SUCCESS;
}

CL_API_ENTRY cl_int CL_API_CALL clInitLayer(cl_uint count, const cl_icd_dispatch* target,
                                            cl_uint* count_ret, const cl_icd_dispatch** table_ret) {
    constexpr cl_uint kEntries = sizeof(cl_icd_dispatch) / sizeof(void*);
    if (target == nullptr || count_ret == nullptr || table_ret == nullptr || count < kEntries) {
        return CL_INVALID_VALUE;
    }
    Layer& l = layer();
    l.next = target;
    l.table = *target;
    l.table.clCreateContext = create_context;
    l.table.clCreateCommandQueueWithProperties = create_queue;
    l.table.clCreateBuffer = create_buffer;
    l.table.clCreateProgramWithSource = create_program;
    l.table.clCreateKernel = create_kernel;
    l.table.clEnqueueMapBuffer = map_buffer;
    divert<&cl_icd_dispatch::clBuildProgram>(&cl_icd_dispatch::clBuildProgram);
    divert<&cl_icd_dispatch::clSetKernelArg>(&cl_icd_dispatch::clSetKernelArg);
    divert<&cl_icd_dispatch::clEnqueueNDRangeKernel>(&cl_icd_dispatch::clEnqueueNDRangeKernel);
    divert<&cl_icd_dispatch::clEnqueueReadBuffer>(&cl_icd_dispatch::clEnqueueReadBuffer);
    divert<&cl_icd_dispatch::clEnqueueWriteBuffer>(&cl_icd_dispatch::clEnqueueWriteBuffer);
    divert<&cl_icd_dispatch::clEnqueueUnmapMemObject>(&cl_icd_dispatch::clEnqueueUnmapMemObject);
    l.table.clFinish = finish;
    divert<&cl_icd_dispatch::clWaitForEvents>(&cl_icd_dispatch::clWaitForEvents);
    divert<&cl_icd_dispatch::clGetEventProfilingInfo>(&cl_icd_dispatch::clGetEventProfilingInfo);
    if (const char* text = std::getenv("KILOLUX_FAULT")) {
        int call_number = 0, code = 0;
        if (std::sscanf(text, "%d:%d", &call_number, &code) == 2) {
            fault_layer_arm(call_number, code);
            layer().is_lost = std::strstr(text, ":lost") != nullptr;
        }
    }
    *count_ret = kEntries;
    *table_ret = &l.table;
    return CL_SUCCESS;
}
}
