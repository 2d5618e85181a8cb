// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/photometry/photometry_file.h"

#include "host/base/byte_order_mark.h"
#include "host/scene/lights/photometry/ies_file.h"
#include "host/scene/lights/photometry/ldt_file.h"

namespace kilolux {

PhotometricWeb read_photometric_web(std::string text, const std::string& where) {
    text = std::string(without_byte_order_mark(text));
    const bool is_ldt = looks_like_ldt(text);
    PhotometricWeb web = is_ldt ? read_ldt(text, where) : read_ies(text, where);
    // Scenes are written with files of LM-63, for EXT_lights_ies has no others.
    web.text = is_ldt ? lm63_text(web) : std::move(text);
    return web;
}

}  // namespace kilolux
