// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/built_in_environments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kilolux {
namespace {

// A rectangle of light that faces the middle.
struct SoftBox {
    glm::dvec3 towards;    // its centre
    glm::dvec2 half_size;  // across, up; at distance 1
    glm::dvec3 radiance;
};

// Share of the box that is seen in a unit direction; its edges are soft.
double seen(const SoftBox& box, const glm::dvec3& d) {
    constexpr double kEdge = 0.08;
    const glm::dvec3 forward = glm::normalize(box.towards);
    const glm::dvec3 up = std::abs(forward.y) > 0.9 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
    const double depth = glm::dot(d, forward);
    if (depth <= 0.0) return 0.0;
    const double across = std::abs(glm::dot(d, right)) / depth;
    const double along = std::abs(glm::dot(d, glm::cross(right, forward))) / depth;
    return glm::smoothstep(box.half_size.x + kEdge, box.half_size.x, across) *
           glm::smoothstep(box.half_size.y + kEdge, box.half_size.y, along);
}

glm::dvec3 studio_radiance(const glm::dvec3& d) {
    static const SoftBox boxes[] = {{{-0.8, 0.9, 1.2}, {0.45, 0.35}, {3.6, 3.4, 3.1}},
                                    {{1.2, 0.2, 0.9}, {0.3, 0.55}, {0.70, 0.75, 0.82}},
                                    {{0.45, 0.7, -1.2}, {0.75, 0.15}, {3.2, 3.3, 3.5}},
                                    {{0.0, 1.0, 0.0}, {0.6, 0.4}, {1.2, 1.2, 1.2}}};
    // Walls, lighter towards the ceiling, and a floor that throws light back.
    const double height = glm::smoothstep(-0.35, 0.9, d.y);
    glm::dvec3 out = glm::dvec3(0.10, 0.10, 0.11) + height * glm::dvec3(0.14);
    out += glm::smoothstep(-0.2, -0.9, d.y) * glm::dvec3(0.10, 0.095, 0.09);
    for (const SoftBox& box : boxes) out += seen(box, d) * box.radiance;
    return out;
}

// Preetham et al. 1999, appendix A.2: the distribution's coefficients for luminance, x and y.
struct Perez {
    double a, b, c, d, e;
    // Relative to the zenith's, for an angle from the sun and its height.
    double at(double cos_zenith, double from_sun) const {
        const double cos_sun = std::cos(from_sun);
        return (1.0 + a * std::exp(b / cos_zenith)) *
               (1.0 + c * std::exp(d * from_sun) + e * cos_sun * cos_sun);
    }
};

constexpr double kTurbidity = 3.0;
constexpr Perez kLuminance = {0.1787 * kTurbidity - 1.4630, -0.3554 * kTurbidity + 0.4275,
                              -0.0227 * kTurbidity + 5.3251, 0.1206 * kTurbidity - 2.5771,
                              -0.0670 * kTurbidity + 0.3703};
constexpr Perez kX = {-0.0193 * kTurbidity - 0.2592, -0.0665 * kTurbidity + 0.0008,
                      -0.0004 * kTurbidity + 0.2125, -0.0641 * kTurbidity - 0.8989,
                      -0.0033 * kTurbidity + 0.0452};
constexpr Perez kY = {-0.0167 * kTurbidity - 0.2608, -0.0950 * kTurbidity + 0.0092,
                      -0.0079 * kTurbidity + 0.2102, -0.0441 * kTurbidity - 1.6537,
                      -0.0109 * kTurbidity + 0.0529};
constexpr double kSunElevation = 40.0 * std::numbers::pi / 180.0;
constexpr double kSunZenith = 0.5 * std::numbers::pi - kSunElevation;
constexpr double kSunRadius =
    0.2665 * std::numbers::pi / 180.0;        // as seen from the earth, in the mean
constexpr double kSkyIlluminance = 1.0;       // of the ground [lx]
constexpr double kSunIlluminance = 3.0;       // of what faces it [lx]
const glm::dvec3 kSunColor(1.08, 1.0, 0.82);  // of luminance 1
constexpr double kGroundAlbedo = 0.25;

glm::dvec3 towards_sun() {
    return {-0.6 * std::cos(kSunElevation), std::sin(kSunElevation), 0.8 * std::cos(kSunElevation)};
}

// A zenith's chromaticity, ibid.: cubic in the sun's zenith angle, quadratic in turbidity.
double zenith_chromaticity(const glm::dvec4& t2, const glm::dvec4& t1, const glm::dvec4& t0) {
    const double s = kSunZenith;
    const glm::dvec4 powers(s * s * s, s * s, s, 1.0);
    return kTurbidity * kTurbidity * glm::dot(t2, powers) + kTurbidity * glm::dot(t1, powers) +
           glm::dot(t0, powers);
}

glm::dvec3 linear_of_xyy(double x, double y, double luminance) {
    const glm::dvec3 xyz(luminance * x / y, luminance, luminance * (1.0 - x - y) / y);
    // CIE XYZ to Rec. 709 with D65 (ITU-R BT.709).
    const glm::dvec3 rgb(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                         -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                         0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
    return glm::max(rgb, glm::dvec3(0.0));
}

// Luminance of a direction above the horizon, relative to that of the zenith.
glm::dvec3 clear_sky(const glm::dvec3& d) {
    static const double x = zenith_chromaticity({0.00166, -0.00375, 0.00209, 0.0},
                                                {-0.02903, 0.06377, -0.03202, 0.00394},
                                                {0.11693, -0.21196, 0.06052, 0.25886});
    static const double y = zenith_chromaticity({0.00275, -0.00610, 0.00317, 0.0},
                                                {-0.04214, 0.08970, -0.04153, 0.00516},
                                                {0.15346, -0.26756, 0.06670, 0.26688});
    const double cos_zenith = std::max(d.y, 0.01);  // the model ends at the horizon
    const double from_sun = std::acos(std::clamp(glm::dot(d, towards_sun()), -1.0, 1.0));
    const auto relative = [&](const Perez& perez) {
        return perez.at(cos_zenith, from_sun) / perez.at(1.0, kSunZenith);
    };
    return linear_of_xyy(x * relative(kX), y * relative(kY), relative(kLuminance));
}

// Illuminance of the ground by the sky [lx].
glm::dvec3 ground_illuminance(const Environment& sky) {
    glm::dvec3 sum(0.0);
    for (int y = 0; y < sky.height / 2; ++y) {
        for (int x = 0; x < sky.width; ++x) sum += sky.light(x, y) * sky.direction(x, y).y;
    }
    return sum;
}

// Adds the sun: each pixel has the share of its area that the disc covers.
void add_sun(Environment& sky) {
    constexpr int kParts = 16;  // of a pixel's edge
    const double step = std::numbers::pi / sky.height;
    const double cos_radius = std::cos(kSunRadius);
    const auto first = static_cast<int>((kSunZenith - kSunRadius) / step) - 1;
    const auto last = static_cast<int>((kSunZenith + kSunRadius) / step) + 1;
    std::vector<std::pair<std::size_t, double>> covered;
    double solid_angle = 0.0;
    for (int y = first; y <= last; ++y) {
        for (int x = 0; x < sky.width; ++x) {
            if (glm::dot(sky.direction(x, y), towards_sun()) < std::cos(kSunRadius + 2.0 * step)) {
                continue;
            }
            int inside = 0;
            for (int part = 0; part < kParts * kParts; ++part) {
                const double from_top = step * (y + (part / kParts + 0.5) / kParts);
                const double around =
                    step * (x + (part % kParts + 0.5) / kParts) - std::numbers::pi;
                const double r = std::sin(from_top);
                const glm::dvec3 d(r * std::sin(around), std::cos(from_top), -r * std::cos(around));
                inside += glm::dot(d, towards_sun()) > cos_radius ? 1 : 0;
            }
            const double share = static_cast<double>(inside) / (kParts * kParts);
            covered.emplace_back(sky.place(x, y), share);
            solid_angle += share * sky.solid_angle(y);
        }
    }
    for (const auto& [pixel, share] : covered) {
        sky.rows[pixel] += glm::vec3(share * kSunIlluminance / solid_angle * kSunColor);
    }
}

}  // namespace

Environment studio_environment() { return painted_environment(512, studio_radiance); }

Environment sky_environment() {
    constexpr int kSkyRows = 1024;     // the sun is three pixels wide
    constexpr int kMeasuredRows = 64;  // the sky without it is smooth
    const glm::dvec3 measured = ground_illuminance(painted_environment(kMeasuredRows, clear_sky));
    const double scale = kSkyIlluminance / luminance(measured);
    const glm::dvec3 sun = kSunIlluminance * std::sin(kSunElevation) * kSunColor;
    const glm::dvec3 ground = kGroundAlbedo / std::numbers::pi * (scale * measured + sun);
    Environment out = painted_environment(kSkyRows, [&](const glm::dvec3& d) {
        if (d.y >= 0.0) return scale * clear_sky(d);
        // Haze: the horizon's sky turns into ground within three degrees.
        const glm::dvec3 horizon = scale * clear_sky(glm::normalize(glm::dvec3(d.x, 0.0, d.z)));
        return glm::mix(horizon, ground, glm::smoothstep(0.0, -0.05, d.y));
    });
    add_sun(out);
    return out;
}

const std::vector<std::string>& built_in_environment_names() {
    static const std::vector<std::string> names = {"studio", "sky"};
    return names;
}

bool is_built_in_environment(std::string_view name) {
    return std::ranges::find(built_in_environment_names(), name) !=
           built_in_environment_names().end();
}

Environment environment_of(const std::string& name_or_file, std::uint64_t max_memory_bytes) {
    if (name_or_file == "studio") return studio_environment();
    if (name_or_file == "sky") return sky_environment();
    return read_environment(name_or_file, max_memory_bytes);
}

}  // namespace kilolux
