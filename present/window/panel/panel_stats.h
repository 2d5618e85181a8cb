// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/window/panel/panel.h"

namespace kilolux {

/// The sections that show measurements, one function each.
struct PanelStats : Panel {
    void speed() const;
    void error() const;
    void device() const;
};

/// A name-value line.
void fact_line(const char* name, const std::string& value);

/// "12.3 k", "1.20 M"; "34.5 MiB".
std::string short_count(std::uint64_t value);
std::string byte_text(std::uint64_t bytes);

}  // namespace kilolux
