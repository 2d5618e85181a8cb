// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "host/measure/report/run.h"
#include "host/picture/view_canvas.h"

namespace kilolux {

/// The whole picture and its errors |x-r| / max(|r|, E) of the worst channel against R1, R2 and R3,
/// in the heat map's colours, logarithmic from 1e-8 to 1; the legend stands below. `caption`: what
/// was measured; it stands below the setting's name.
Canvas error_map_sheet(const ReportRow& row, const ReportReferences::All& references,
                       const std::string& caption);

/// The rows whose axis compares_cut_offs(), each with its error against R3, its time and its
/// estimated error.
Canvas cut_off_sheet(const std::vector<ReportRow>& rows, const ComparedReference& unbounded,
                     const std::string& caption);

}  // namespace kilolux
