// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/memory/picture_memory.h"

#include "host/base/error.h"
#include "host/gpu/program.h"

namespace kilolux {
namespace {

std::string size_text(std::size_t width, std::size_t height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

// Which room is missing; empty: none.
std::string what_lacks(const cl::Memory& memory, const PictureMemory& need) {
    if (memory() == nullptr) return "there is none";
    const bool is_image = memory.getInfo<CL_MEM_TYPE>() == CL_MEM_OBJECT_IMAGE2D;
    if (is_image != need.image) return need.image ? "is no 2D image" : "is no buffer";
    if (need.image) {
        std::size_t width = 0, height = 0;
        clGetImageInfo(memory(), CL_IMAGE_WIDTH, sizeof(width), &width, nullptr);
        clGetImageInfo(memory(), CL_IMAGE_HEIGHT, sizeof(height), &height, nullptr);
        if (width >= need.width && height >= need.height) return "";
        return "has " + size_text(width, height) + " pixels, the picture " +
               size_text(need.width, need.height);
    }
    if (need.pitch < need.width) {
        return "its pitch is " + std::to_string(need.pitch) + " pixels, the picture is " +
               std::to_string(need.width) + " wide";
    }
    const std::size_t pixels = (need.height - std::size_t{1}) * need.pitch + need.width;
    const auto size = memory.getInfo<CL_MEM_SIZE>();
    if (size >= pixels * need.pixel_bytes) return "";
    return "has " + std::to_string(size) + " bytes, needs " +
           std::to_string(pixels * need.pixel_bytes);
}

}  // namespace

void check_picture_memory(const std::string& name, const cl::Memory& memory,
                          const PictureMemory& need) {
    const std::string lacks = in_stage(name, [&] { return what_lacks(memory, need); });
    if (!lacks.empty()) throw Error(name + ": " + lacks);
}

}  // namespace kilolux
