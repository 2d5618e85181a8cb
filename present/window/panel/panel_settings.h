// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/panel/panel.h"

namespace kilolux {

/// The sections that set the state, one function each.
struct PanelSettings : Panel {
    void picture() const;
    void lights() const;
    void clusters() const;
    void camera(const CameraRig& rig) const;
    void window() const;

 private:
    bool has_sizes() const;
    void emissive_lights() const;
    void size() const;
};

}  // namespace kilolux
