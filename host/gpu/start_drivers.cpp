// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/start_drivers.h"

#include <system_error>

#include "host/gpu/device.h"
#include "host/gpu/pocl_cache.h"

namespace kilolux {

std::jthread start_drivers() {
    prepare_pocl();  // changes the environment, which no other thread may read meanwhile
    try {
        return std::jthread([] {
            try {
                all_devices();
            } catch (...) {  // the next call throws it, too
            }
        });
    } catch (const std::system_error&) {  // no thread: the next call starts them
        return {};
    }
}

}  // namespace kilolux
