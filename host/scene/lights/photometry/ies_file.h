// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "host/scene/lights/photometry/photometric_web.h"

namespace kilolux {

/// Reads an IES file, as read_photometric_web() does; sets all but `name` and `text`.
PhotometricWeb read_ies(std::string_view text, const std::string& where);

}  // namespace kilolux
