// SPDX-License-Identifier: Apache-2.0
#include "present/cli/names.h"

#include "host/base/gbuffer_layout.h"
#include "host/picture/views.h"

namespace kilolux {

std::vector<std::string> renderer_names() {
    return {"deferred", "forward-plus", "forward", "deferred-all"};
}

std::vector<std::string> shading_names() { return {"auto", "lambert", "blinn-phong", "pbr"}; }

std::vector<std::string> tone_curve_names() { return {"none", "neutral", "aces"}; }

std::vector<std::string> math_names() { return {"exact", "fast-relaxed", "native"}; }

std::vector<std::string> light_color_names() { return {"float", "half"}; }

std::vector<std::string> gbuffer_names() {
    std::vector<std::string> names;
    for (const int layout :
         {GBUFFER_PACKED, GBUFFER_FULL, GBUFFER_HALF, GBUFFER_NORMAL_XY, GBUFFER_OCT_2X4}) {
        names.push_back(gbuffer_layout_name(static_cast<uint>(layout)));
    }
    return names;
}

std::vector<std::string> show_names() { return view_names(); }

std::string name_of(RendererKind renderer) {
    return renderer_names().at(static_cast<std::size_t>(renderer));
}

std::string name_of(Shading shading) {
    return shading_names().at(static_cast<std::size_t>(shading));
}

std::string name_of(ToneCurve curve) {
    return tone_curve_names().at(static_cast<std::size_t>(curve));
}

}  // namespace kilolux
