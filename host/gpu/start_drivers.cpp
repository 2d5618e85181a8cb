// SPDX-License-Identifier: Apache-2.0
#include "host/gpu/start_drivers.h"

#include "host/base/error.h"
#include "host/gpu/device.h"
#include "host/gpu/pocl_cache.h"

namespace kilolux {

std::jthread start_drivers() {
    prepare_pocl();  // changes the environment, which no other thread may read meanwhile
    return std::jthread([] {
        try {
            all_devices();
        } catch (const Error&) {  // the next call throws it, too
        }
    });
}

}  // namespace kilolux
