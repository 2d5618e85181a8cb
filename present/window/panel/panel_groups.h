// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/panel/panel.h"

namespace kilolux {

/// The section of groups of lights: a gain and a colour for each.
struct PanelGroups : Panel {
    void groups() const;

 private:
    void group(const std::string& name) const;
};

}  // namespace kilolux
