// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf_parallel.h"

#include <OpenImageIO/parallel.h>

#include <exception>
#include <vector>

namespace kilolux {

void parallel_each(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::vector<std::exception_ptr> errors(count);
    const auto guarded = [&](std::uint64_t i) {
        try {
            work(i);
        } catch (...) {
            errors[i] = std::current_exception();
        }
    };
    // OpenImageIO's thread pool: the one that is in the process anyway.
    OIIO::parallel_for(std::uint64_t{0}, std::uint64_t{count}, guarded);
    for (const std::exception_ptr& error : errors) {
        if (error) std::rethrow_exception(error);
    }
}

}  // namespace kilolux
