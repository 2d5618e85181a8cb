// SPDX-License-Identifier: Apache-2.0
#include "host/scene/lights/environment.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <span>

#include "host/base/error.h"
#include "host/base/formats/srgb.h"
#include "host/base/system/memory.h"
#include "host/base/system/parallel.h"
#include "host/images/images.h"
#include "host/scene/lights/light_side.h"
#include "host/scene/lights/radiance_header.h"

namespace kilolux {
namespace {

// Pixels [x0, x1) x [y0, y1).
struct Region {
    int x0, y0, x1, y1;
    double luminance;
    bool operator<(const Region& other) const { return luminance < other.luminance; }
    int pixels() const { return (x1 - x0) * (y1 - y0); }
};

// Sums of luminance over the pixels above and left of a corner: the sum over a region takes the
// same time for any size.
class SummedLuminance {
 public:
    explicit SummedLuminance(const Environment& e)
        : stride_(static_cast<std::size_t>(e.width) + 1),
          sums_(stride_ * (static_cast<std::size_t>(e.height) + 1)) {
        for (int y = 0; y < e.height; ++y) {
            double row = 0.0;
            for (int x = 0; x < e.width; ++x) {
                row += luminance(e.light(x, y));
                sums_[place(x + 1, y + 1)] = sums_[place(x + 1, y)] + row;
            }
        }
    }
    Region region(int x0, int y0, int x1, int y1) const {
        const double sum = sums_[place(x1, y1)] - sums_[place(x0, y1)] - sums_[place(x1, y0)] +
                           sums_[place(x0, y0)];
        return {x0, y0, x1, y1, std::max(sum, 0.0)};
    }

 private:
    std::size_t place(int x, int y) const {
        return static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(x);
    }
    std::size_t stride_;
    std::vector<double> sums_;
};

// Whether a region is wider than high on the sphere, where rows near the poles are short.
bool is_wide(const Environment& e, const Region& r) {
    const double latitude = std::numbers::pi * (0.5 - 0.5 * (r.y0 + r.y1) / e.height);
    const double wide = 2.0 * std::numbers::pi * (r.x1 - r.x0) / e.width * std::cos(latitude);
    const bool can_be_cut_across = r.y1 - r.y0 > 1;
    return r.x1 - r.x0 > 1 &&
           (!can_be_cut_across || wide >= std::numbers::pi * (r.y1 - r.y0) / e.height);
}

std::pair<Region, Region> cut(const Environment& e, const SummedLuminance& sums, const Region& r) {
    const bool wide = is_wide(e, r);
    const int first = wide ? r.x0 : r.y0, last = wide ? r.x1 : r.y1;
    const auto lower = [&](int at) {
        return wide ? sums.region(r.x0, r.y0, at, r.y1) : sums.region(r.x0, r.y0, r.x1, at);
    };
    int low = first + 1, high = last - 1;
    while (low < high) {  // the first place with half of the light before it
        const int middle = (low + high) / 2;
        if (lower(middle).luminance < 0.5 * r.luminance) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return {lower(low),
            wide ? sums.region(low, r.y0, r.x1, r.y1) : sums.region(r.x0, low, r.x1, r.y1)};
}

SceneLight light_of(const Environment& e, const Region& r) {
    glm::dvec3 sum(0.0), centroid(0.0);
    for (int y = r.y0; y < r.y1; ++y) {
        for (int x = r.x0; x < r.x1; ++x) {
            const glm::dvec3 light = e.light(x, y);
            sum += light;
            centroid += luminance(light) * e.direction(x, y);
        }
    }
    // Light from all around has its centroid in the middle: any direction is as good.
    const bool has_direction = glm::length(centroid) > 1e-9 * luminance(sum);
    SceneLight out;
    out.type = LightType::directional;
    out.direction = has_direction ? -glm::normalize(centroid) : glm::dvec3(0, -1, 0);
    out.side = perpendicular_side(out.direction);
    out.intensity = glm::vec3(sum);
    return out;
}

glm::dmat3 xyz_from_rgb(std::span<const float> xy) {
    const auto xyz = [&](std::size_t i) {
        const double x = xy[2 * i], y = xy[2 * i + 1];
        return glm::dvec3(x / y, 1.0, (1.0 - x - y) / y);
    };
    const glm::dmat3 primaries(xyz(0), xyz(1), xyz(2));
    const glm::dvec3 shares = glm::inverse(primaries) * xyz(3);
    return {primaries[0] * shares.x, primaries[1] * shares.y, primaries[2] * shares.z};
}

// To linear Rec. 709 from other primaries; white stays white (Bradford's adaptation: Lam 1985).
glm::dmat3 rec709_from(std::span<const float> chromaticities) {
    constexpr std::array<float, 8> kRec709 = {0.64f, 0.33f, 0.3f,    0.6f,
                                              0.15f, 0.06f, 0.3127f, 0.329f};
    const glm::dmat3 bradford(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367,
                              1.0296);
    const glm::dmat3 from = bradford * xyz_from_rgb(chromaticities);
    const glm::dmat3 to = bradford * xyz_from_rgb(kRec709);
    const glm::dvec3 adapted = (to * glm::dvec3(1.0)) / (from * glm::dvec3(1.0));
    glm::dmat3 scale(0.0);
    for (glm::length_t i = 0; i < 3; ++i) scale[i][i] = adapted[i];
    return glm::inverse(to) * scale * from;
}

// Integers are encoded in sRGB; a file's own primaries become Rec. 709's.
void make_linear_rec709(const ImageLayout& image, const RadianceHeader& header,
                        std::vector<glm::vec3>& rows) {
    const SampleType type = image.channels.front().type;
    if (type == SampleType::uint8 || type == SampleType::uint16) {
        for (glm::vec3& c : rows) {
            for (glm::length_t i = 0; i < 3; ++i) {
                c[i] = static_cast<float>(srgb_to_linear(double{c[i]}));
            }
        }
    }
    const std::vector<float>& primaries =
        header.chromaticities.empty() ? image.chromaticities : header.chromaticities;
    if (primaries.empty() && header.divisor == glm::dvec3(1.0)) return;
    const glm::dmat3 matrix = primaries.empty() ? glm::dmat3(1.0) : rec709_from(primaries);
    for (glm::vec3& c : rows) {
        c = glm::max(glm::vec3(matrix * (glm::dvec3(c) / header.divisor)), 0.0f);
    }
}

}  // namespace

double luminance(const glm::dvec3& light) {
    return glm::dot(light, glm::dvec3(0.2126, 0.7152, 0.0722));
}

glm::dvec3 Environment::direction(int x, int y) const {
    const double longitude = 2.0 * std::numbers::pi * ((x + 0.5) / width - 0.5);
    const double from_top = std::numbers::pi * (y + 0.5) / height;
    const double r = std::sin(from_top);
    return {r * std::sin(longitude), std::cos(from_top), -r * std::cos(longitude)};
}

double Environment::solid_angle(int y) const {
    return 2.0 * std::numbers::pi / width *
           (std::cos(std::numbers::pi * y / height) -
            std::cos(std::numbers::pi * (y + 1.0) / height));
}

glm::dvec3 Environment::light(int x, int y) const {
    return solid_angle(y) * glm::dvec3(rows[place(x, y)]);
}

Environment painted_environment(
    int height, const std::function<glm::dvec3(const glm::dvec3& direction)>& radiance) {
    Environment out{2 * height, height, {}};
    out.rows.resize(out.place(0, height));
    parallel_for(0, height, [&](int y) {
        for (int x = 0; x < out.width; ++x) {
            out.rows[out.place(x, y)] = glm::vec3(radiance(out.direction(x, y)));
        }
    });
    return out;
}

Environment read_environment(const std::filesystem::path& file, std::uint64_t max_memory_bytes) {
    const auto in = open_image(file);
    const ImageLayout& image = in->layout();
    Environment out{image.width, image.height, {}};
    if (out.width != 2 * out.height || image.channels.size() < 3) {
        throw Error(
            fmt::format("{}: an environment is twice as wide as high, in 3 channels, not "
                        "{}x{} in {}",
                        file.string(), out.width, out.height, image.channels.size()));
    }
    // Its light, and sums of it.
    const std::uint64_t need = image.pixels() * (sizeof(glm::vec3) + sizeof(double));
    const std::uint64_t most = loading_limit(max_memory_bytes);
    if (need > most) {
        throw Error(file.string() + ": " +
                    shortage_text(need, "memory as an environment", most, most));
    }
    out.rows.resize(out.place(0, out.height));
    in->read(0, 3, SampleType::float32, out.rows.data(), sizeof(glm::vec3));
    for (std::size_t i = 0; i < out.rows.size(); ++i) {
        const glm::vec3& c = out.rows[i];
        const float worst = std::min({c.x, c.y, c.z});
        if (std::isfinite(c.x + c.y + c.z) && worst >= 0.0f) continue;
        const auto width = static_cast<std::size_t>(out.width);
        throw Error(fmt::format("{}: pixel {},{} is {},{},{}, must be finite and >= 0",
                                file.string(), i % width, i / width, c.x, c.y, c.z));
    }
    make_linear_rec709(image, read_radiance_header(file), out.rows);
    return out;
}

std::vector<SceneLight> environment_lights(const Environment& environment, std::size_t count) {
    const SummedLuminance sums(environment);
    std::priority_queue<Region> regions;
    std::vector<SceneLight> lights;
    regions.push(sums.region(0, 0, environment.width, environment.height));
    while (!regions.empty() && lights.size() + regions.size() < count &&
           regions.top().luminance > 0.0) {
        const Region most = regions.top();
        regions.pop();
        if (most.pixels() == 1) {
            lights.push_back(light_of(environment, most));
            continue;
        }
        const auto [a, b] = cut(environment, sums, most);
        regions.push(a);
        regions.push(b);
    }
    for (; !regions.empty(); regions.pop()) lights.push_back(light_of(environment, regions.top()));
    std::erase_if(lights, [](const SceneLight& l) { return l.intensity == glm::vec3(0.0f); });
    return lights;
}

}  // namespace kilolux
