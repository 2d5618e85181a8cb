// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/panel.h"

#include <unistd.h>

#include <fstream>

namespace kilolux {
namespace {

std::uint64_t resident_bytes() {
    std::ifstream statm("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    statm >> size >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace

void PanelFacts::note_picture(const PictureRequest& request, const Picture& picture,
                              double scale_now) {
    stats = picture.frame.stats;
    history.add(stats, displayed == request.settings);
    displayed = request.settings;
    scale = scale_now;
    samples = request.samples > 0 ? request.samples : request.settings.samples;
    device = picture.device;
    plan = picture.plan;
    device_bytes = picture.device_bytes;
    process_bytes = resident_bytes();
}

}  // namespace kilolux
