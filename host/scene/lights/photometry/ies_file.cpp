// SPDX-License-Identifier: Apache-2.0
// IES files (ANSI/IES LM-63): keywords, TILT, then numbers apart by spaces, lines or commas.
#include "host/scene/lights/photometry/ies_file.h"

#include "host/scene/lights/photometry/c_planes.h"
#include "host/scene/lights/photometry/photometry_text.h"
#include "host/scene/lights/photometry/type_ab.h"

namespace kilolux {
namespace {

// LM-63-1991 and the older edition without a first line of its own multiply by a second ballast
// factor; later ones reserve its place, and the last keeps the kind of file there.
bool has_photometric_factor(std::string_view first_line) {
    return !first_line.starts_with("IESNA:LM-63-") && !first_line.starts_with("IES:LM-63-");
}

// Whether a second ballast factor counts. Reads to where the numbers start.
bool skip_to_numbers(PhotometryText& file) {
    std::string_view line = file.take_line();
    const bool factor = has_photometric_factor(line);
    while (!line.starts_with("TILT=")) {
        if (file.at_end()) {
            file.fail(
                "there is no line TILT=, so this is no IES file (LM-63); nor are lines 2 and 3 "
                "numbers, so it is no EULUMDAT file");
        }
        line = file.take_line();
    }
    std::string_view tilt = line.substr(5);
    while (!tilt.empty() && tilt.front() <= ' ') tilt.remove_prefix(1);
    if (tilt == "INCLUDE") {
        file.number("the lamp's geometry");
        const std::size_t pairs = file.count("the number of tilt angles", 0);
        file.numbers("tilt angle", pairs);
        file.numbers("tilt factor", pairs);
    } else if (tilt != "NONE") {
        file.fail("TILT={} asks for another file; only NONE and INCLUDE are read",
                  shown_word(tilt));
    }
    return factor;
}

enum class PhotometricType { c = 1, b = 2, a = 3 };

struct Head {
    double lumens = 0.0;  // of all lamps; not above 0: none stated
    double factor = 1.0;  // of all candela values
    std::size_t verticals = 0, horizontals = 0;
    PhotometricType type = PhotometricType::c;
};

Head read_head(PhotometryText& file) {
    Head out;
    const bool has_factor = skip_to_numbers(file);
    const double lamps = file.number("the number of lamps");
    const double lamp_lumens = file.number("lumens per lamp");
    out.factor = file.positive("the candela multiplier");
    out.verticals = file.count("the number of vertical angles", 2);
    out.horizontals = file.count("the number of horizontal angles", 1);
    const double type = file.number("the photometric type");
    if (type != 1.0 && type != 2.0 && type != 3.0) {
        file.fail("the photometric type is {}, must be 1, 2 or 3", type);
    }
    out.type = static_cast<PhotometricType>(static_cast<int>(type));
    for (const char* what : {"the units", "the width", "the length", "the height"}) {
        file.number(what);
    }
    double ballast = file.positive("the ballast factor");
    if (has_factor) {
        ballast *= file.positive("the ballast-lamp factor");
    } else {
        file.number("the reserved number");
    }
    out.factor *= ballast;
    // -1 lumens say that candela are absolute.
    if (lamps > 0.0 && lamp_lumens > 0.0) out.lumens = lamps * lamp_lumens * ballast;
    file.number("the input watts");
    return out;
}

// All around, from what symmetry leaves out.
std::vector<CPlane> unfolded(const PhotometryText& file, const std::vector<double>& angles) {
    std::vector<CPlane> planes = planes_at(angles);
    const double first = angles.front();
    const double last = angles.back();
    if (angles.size() == 1) {
        if (first != 0.0) file.fail("the only horizontal angle is {}, must be 0", first);
        return planes;
    }
    if (first == 0.0 && last == 90.0) {
        mirror(planes, 90.0);
        mirror(planes, 0.0);
    } else if (first == 0.0 && last == 180.0) {
        mirror(planes, 0.0);
    } else if (first == 90.0 && last == 270.0) {
        mirror(planes, 90.0);
    } else if (!(first == 0.0 && last == 360.0) && !lacks_last_angle(angles)) {
        file.fail(
            "horizontal angles are from {} to {}, must be 0 alone or 0 to 90, 180 or 360, or 90 to "
            "270",
            first, last);
    }
    close_circle(planes);
    return planes;
}

// LM-63's ranges are -90 or 0 to 90. Narrower ones are what files of narrow beams have.
void check_pole_angles(const PhotometryText& file, const char* what,
                       const std::vector<double>& angles) {
    const double first = angles.front(), last = angles.back();
    if (angles.size() > 1 && -90.0 <= first && first <= 0.0 && 0.0 < last && last <= 90.0) return;
    file.fail(
        "{} angles are from {} to {}, must be two or more from 0 or below to above 0, within "
        "-90 to 90 in types A and B",
        what, first, last);
}

}  // namespace

PhotometricWeb read_ies(std::string_view text, const std::string& where) {
    PhotometricWeb web;
    PhotometryText file(text, where, PhotometryFields::words);
    const Head head = read_head(file);
    if (head.lumens > 0.0) web.stated_lumens = head.lumens;
    const bool is_c = head.type == PhotometricType::c;
    std::vector<double> vertical = file.angles("vertical angle", head.verticals);
    if (is_c) {
        check_c_vertical(file, vertical);
    } else {
        check_pole_angles(file, "vertical", vertical);
    }
    std::vector<double> horizontal = file.angles("horizontal angle", head.horizontals);
    std::vector<CPlane> planes;
    if (is_c) {
        planes = unfolded(file, horizontal);
    } else {
        check_pole_angles(file, "horizontal", horizontal);
    }
    std::vector<double> candela = file.candela(head.verticals * head.horizontals, head.factor);
    file.expect_end();
    if (is_c) {
        web.vertical = std::move(vertical);
        set_planes(web, planes, candela);
        return web;
    }
    const PoleType pole = head.type == PhotometricType::a ? PoleType::up : PoleType::right;
    set_pole_grid(web, {pole, std::move(vertical), std::move(horizontal), std::move(candela)});
    if (!(web.peak > 0.0)) file.fail("all light goes along the poles of type A or B");
    return web;
}

}  // namespace kilolux
