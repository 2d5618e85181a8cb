// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "present/cli/options.h"

namespace kilolux {

/// The part of visit_settings() that changes pictures.
void visit_picture_settings(SharedOptions& options, const SettingVisitor& visit);

}  // namespace kilolux
