// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include "host/images/images.h"

namespace kilolux::oiio {

OIIO::TypeDesc type_of(SampleType type);

/// The lines of OpenImageIO's reasons with "; " between them.
std::string one_line(const std::string& reasons);

}  // namespace kilolux::oiio
