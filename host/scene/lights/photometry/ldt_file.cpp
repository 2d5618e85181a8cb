// SPDX-License-Identifier: Apache-2.0
// EULUMDAT files: a field a line, in fixed order.
#include "host/scene/lights/photometry/ldt_file.h"

#include <cmath>

#include "host/base/text.h"
#include "host/scene/lights/photometry/c_planes.h"
#include "host/scene/lights/photometry/photometry_text.h"

namespace kilolux {
namespace {

struct LdtHead {
    std::size_t symmetry = 0;  // 0 none, 1 all around, 2 about C0-C180, 3 about C90-C270, 4 both
    std::size_t planes = 0;    // C-planes of the whole circle
    std::size_t rows = 0;      // gamma angles
    double lamp_lumens = 0.0;  // of the first set of lamps
    double conversion = 1.0;
    double down_share = 0.0;    // DFF: of the luminaire's flux; 0: not stated
    double output_ratio = 0.0;  // LORL: the luminaire's flux by the lamps'; 0: not stated
};

// A percentage as a share. That of lamps whose flux is more than they were rated at exceeds 100.
double share_of_percent(PhotometryText& file, std::string_view what, double most_percent) {
    const double value = file.number(what);
    if (value < 0.0 || value > most_percent) {
        file.fail("{} is {}, must be 0 to {} %", what, value, most_percent);
    }
    return 0.01 * value;
}

void skip_lines(PhotometryText& file, std::initializer_list<const char*> texts) {
    for (const char* what : texts) file.skip_line(what);
}

// Sets of lamps follow each other, six lines each.
double first_lamp_lumens(PhotometryText& file) {
    const std::size_t sets = file.count("the number of lamp sets", 1);
    double lumens = 0.0;
    for (std::size_t set = 0; set < sets; ++set) {
        file.number("the number of lamps");  // below 0: the flux is the luminaire's
        file.skip_line("the type of lamps");
        const double flux = file.number("the lamps' luminous flux");
        if (set == 0 && !(flux > 0.0)) {
            file.fail("the lamps' luminous flux is {}, must be greater than 0", flux);
        }
        if (set == 0) lumens = flux;
        skip_lines(file, {"the colour temperature", "the colour rendering"});
        file.number("the wattage");
    }
    return lumens;
}

LdtHead read_ldt_head(PhotometryText& file) {
    LdtHead out;
    file.skip_line("the identification");
    file.number("the type of luminaire");
    out.symmetry = file.count("the symmetry", 0);
    if (out.symmetry > 4) file.fail("the symmetry is {}, must be 0 to 4", out.symmetry);
    out.planes = file.count("the number of C-planes", 1);
    file.number("the distance of C-planes");
    out.rows = file.count("the number of gamma angles", 2);
    file.number("the distance of gamma angles");
    skip_lines(file, {"the report's number", "the luminaire's name", "the luminaire's number",
                      "the file's name", "the date"});
    for (const char* what :
         {"the length", "the width", "the height", "the luminous area's length",
          "the luminous area's width", "the luminous area's height at C0",
          "the luminous area's height at C90", "the luminous area's height at C180",
          "the luminous area's height at C270"}) {
        file.number(what);
    }
    out.down_share = share_of_percent(file, "the downward flux fraction", 100.0);
    out.output_ratio = share_of_percent(file, "the light output ratio", 1000.0);
    out.conversion = file.positive("the conversion factor");
    file.number("the tilt");
    out.lamp_lumens = first_lamp_lumens(file);
    file.numbers("direct ratio", 10);
    return out;
}

// What the symmetry stores of the planes: from the first's index on, around the circle.
struct StoredPlanes {
    std::size_t first = 0, count = 1;
    double last_angle = 0.0;  // [deg], that symmetry asks for
};

StoredPlanes stored_planes(const PhotometryText& file, const LdtHead& head) {
    const std::size_t all = head.planes;
    const std::size_t divisor = head.symmetry < 2 ? 1 : head.symmetry == 2 ? 2 : 4;
    if (all % divisor != 0) {
        file.fail("{} C-planes are no multiple of {}, as symmetry {} needs", all, divisor,
                  head.symmetry);
    }
    switch (head.symmetry) {
        case 0:
            return {0, all, 0.0};
        case 1:
            return {0, 1, 0.0};
        case 2:
            return {0, all / 2 + 1, 180.0};
        case 3:
            return {3 * all / 4, all / 2 + 1, 90.0};  // from C270 over C0
        default:
            return {0, all / 4 + 1, 90.0};
    }
}

std::vector<CPlane> ldt_planes(const PhotometryText& file, const LdtHead& head,
                               const std::vector<double>& c_angles) {
    const StoredPlanes stored = stored_planes(file, head);
    std::vector<double> angles;
    for (std::size_t i = 0; i < stored.count; ++i) {
        angles.push_back(c_angles[(stored.first + i) % head.planes]);
    }
    std::vector<CPlane> planes = planes_at(angles);
    if (head.symmetry == 1) {
        planes.front().angle = 0.0;
        return planes;
    }
    const double first = head.symmetry == 3 ? 270.0 : 0.0;
    if (angles.front() != first) {
        file.fail("C-plane {} is at {}, must be at {} with symmetry {}", stored.first + 1,
                  angles.front(), first, head.symmetry);
    }
    if (head.symmetry >= 2 && angles.back() != stored.last_angle) {
        file.fail("C-plane {} is at {}, must be at {} with symmetry {}",
                  (stored.first + stored.count - 1) % head.planes + 1, angles.back(),
                  stored.last_angle, head.symmetry);
    }
    if (head.symmetry == 0 && angles.back() != 360.0 && !lacks_last_angle(angles)) {
        file.fail("the last of {} C-planes is at {}, which leaves a gap before 360", head.planes,
                  angles.back());
    }
    if (head.symmetry >= 3) mirror(planes, 90.0);
    if (head.symmetry == 2 || head.symmetry == 4) mirror(planes, 0.0);
    close_circle(planes);
    return planes;
}

}  // namespace

bool looks_like_ldt(std::string_view text) {
    // Of LM-63; its first line may be "IESNA91", a maker's name may begin so, too.
    if (text.starts_with("TILT=") || text.find("\nTILT=") != std::string_view::npos) return false;
    for (int line = 1; line <= 3; ++line) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return false;
        if (line > 1 && !std::isfinite(line_value(text.substr(0, end)))) return false;
        text.remove_prefix(end + 1);
    }
    return true;
}

PhotometricWeb read_ldt(std::string_view text, const std::string& where) {
    PhotometricWeb web;
    PhotometryText file(text, where, PhotometryFields::lines);
    const LdtHead head = read_ldt_head(file);
    const std::vector<double> c_angles = file.angles("C-plane", head.planes);
    if (c_angles.front() < 0.0 || c_angles.back() > 360.0) {
        file.fail("C-planes are from {} to {}, must be within 0 to 360", c_angles.front(),
                  c_angles.back());
    }
    const std::vector<CPlane> planes = ldt_planes(file, head, c_angles);
    web.vertical = file.angles("gamma angle", head.rows);
    check_c_vertical(file, web.vertical);
    const std::size_t columns = stored_planes(file, head).count;
    const double factor = 1e-3 * head.lamp_lumens * head.conversion;
    const std::vector<double> candela = file.candela(columns * head.rows, factor);
    file.expect_end();
    if (head.output_ratio > 0.0) web.stated_lumens = head.lamp_lumens * head.output_ratio;
    if (head.down_share > 0.0) web.stated_down_share = head.down_share;
    set_planes(web, planes, candela);
    return web;
}

}  // namespace kilolux
