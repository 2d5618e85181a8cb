// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/report/run.h"
#include "host/picture/view_canvas.h"

namespace kilolux {

/// Neighbourhoods of a setting's three worst pixels, by relative error against R1, R2 and R3, one
/// below the other: the picture, the reference, and the error in false colour, 33 pixels square,
/// magnified. The worst pixel is framed. The error's scale is logarithmic from 1e-8 to 1, viridis,
/// drawn below.
Canvas worst_pixel_sheet(const ReportRow& row, const ReportReferences::All& references);

}  // namespace kilolux
