// SPDX-License-Identifier: Apache-2.0
#include "host/scene/gltf/parallel.h"

#include <OpenImageIO/parallel.h>

#include <exception>
#include <vector>

namespace kilolux {

void parallel_each(std::size_t count, const std::function<void(std::size_t)>& work) {
    std::vector<std::exception_ptr> errors(count);
    const auto guarded = [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            try {
                work(i);
            } catch (...) {
                errors[i] = std::current_exception();
            }
        }
    };
    // OpenImageIO's thread pool, the one that is in the process anyway. Its parallel_for() would
    // take counts like ours for too small to share out.
    OIIO::parallel_for_chunked(0, static_cast<std::int64_t>(count), 1, guarded);
    for (const std::exception_ptr& error : errors) {
        if (error) std::rethrow_exception(error);
    }
}

}  // namespace kilolux
