// SPDX-License-Identifier: Apache-2.0
#include "host/picture/views.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

#include "host/base/error.h"
#include "host/base/formats/srgb.h"
#include "host/picture/view_canvas.h"

namespace kilolux {
namespace {

// A pixel of the picture, and its index in the planes.
struct Pixel {
    uint x, y;
    std::size_t index;
};

std::uint8_t code_of(double v) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0, 1.0) * 255.0));
}

DisplayColor color_of(const glm::dvec3& v) { return {code_of(v.x), code_of(v.y), code_of(v.z)}; }

using Paint = std::function<DisplayColor(const Pixel& pixel)>;
using Magnitude = std::function<double(const Pixel& pixel)>;

// Calls each(pixel) for pixels that show a surface.
template <typename Each>
void for_each_surface(const DecodedSurfaces& surfaces, const Each& each) {
    const View& view = surfaces.view;
    for (uint y = 0; y < view.height; ++y) {
        for (uint x = 0; x < view.width; ++x) {
            const Pixel pixel{x, y, std::size_t{y} * view.stride + x};
            if (surfaces.shows_surface(pixel.index)) each(pixel);
        }
    }
}

// Paints the pixels that show a surface; the background stays black.
Canvas painted(const ViewInput& input, const Paint& paint) {
    const View& view = input.pixels.view;
    Canvas canvas = make_canvas(static_cast<int>(view.width), static_cast<int>(view.height));
    for_each_surface(input.pixels, [&](const Pixel& p) {
        canvas.set(static_cast<int>(p.x), static_cast<int>(p.y), paint(p));
    });
    return canvas;
}

double largest(const ViewInput& input, const Magnitude& magnitude) {
    double out = 0.0;
    for_each_surface(input.pixels, [&](const Pixel& p) { out = std::max(out, magnitude(p)); });
    return out;
}

Canvas heat_map(const ViewInput& input, const HeatScale& scale, const Magnitude& magnitude) {
    Canvas canvas = painted(
        input, [&](const Pixel& p) { return heat_color(position_on(scale, magnitude(p))); });
    draw_legend(canvas, scale);
    return canvas;
}

// Even colours in steps of 1, 2, 5 and 10, with lines between neighbouring steps. Values below four
// powers of ten under the largest are black.
Canvas step_map(const ViewInput& input, std::string_view unit, const Magnitude& magnitude) {
    constexpr DisplayColor kLine = {128, 128, 128};
    const HeatScale scale = scale_in_steps(largest(input, magnitude), unit);
    const View& view = input.pixels.view;
    const auto place = [&](uint x, uint y) {
        const Pixel p{x, y, std::size_t{y} * view.stride + x};
        return position_on(scale, input.pixels.shows_surface(p.index) ? magnitude(p) : 0.0);
    };
    Canvas canvas = painted(input, [&](const Pixel& p) {
        const double t = place(p.x, p.y);
        const bool is_line =
            (p.x + 1 < view.width && are_neighbour_steps(scale, t, place(p.x + 1, p.y))) ||
            (p.y + 1 < view.height && are_neighbour_steps(scale, t, place(p.x, p.y + 1)));
        return is_line ? kLine : heat_color(t);
    });
    draw_legend(canvas, scale);
    return canvas;
}

// From 0 to the largest count, at least 1.
Canvas count_map(const ViewInput& input, std::string_view unit, const Magnitude& count) {
    return heat_map(input, {0.0, std::max(largest(input, count), 1.0), false, unit}, count);
}

// Colours by number, darker where the surface turns away from the eye, so that shapes are seen.
Canvas id_map(const ViewInput& input, const std::function<uint(const Pixel& pixel)>& id) {
    return painted(input, [&](const Pixel& p) {
        DisplayColor color = id_color(id(p));
        const double facing = 0.5 + 0.5 * std::abs(input.pixels.at(SURFACE_NORMAL + 2, p.index));
        for (std::uint8_t& c : color) c = code_of(c / 255.0 * facing);
        return color;
    });
}

Canvas albedo(const ViewInput& input) {
    return painted(input, [&](const Pixel& p) {
        const glm::dvec3 v = input.pixels.vector(SURFACE_ALBEDO, p.index);
        return color_of({linear_to_srgb(v.x), linear_to_srgb(v.y), linear_to_srgb(v.z)});
    });
}

// World space: right, up and towards +Z are red, green and blue.
Canvas normal(const ViewInput& input) {
    return painted(input, [&](const Pixel& p) {
        const glm::dvec3 n =
            input.camera.world_from_view * input.pixels.vector(SURFACE_NORMAL, p.index);
        return color_of(0.5 * n + 0.5);
    });
}

// World space: from one corner of the scene's box to the other.
Canvas position(const ViewInput& input) {
    const glm::dvec3 size = glm::max(input.box.size(), glm::dvec3(1e-9));
    return painted(input, [&](const Pixel& p) {
        const glm::dvec3 view = input.pixels.vector(SURFACE_POSITION, p.index);
        const glm::dvec3 world = input.camera.world_from_view * view + input.camera.position;
        return color_of((world - input.box.min) / size);
    });
}

Canvas depth(const ViewInput& input) {
    const auto z = [&](const Pixel& p) {
        return std::abs(double{input.pixels.at(SURFACE_DEPTH, p.index)});
    };
    const double farthest = std::max(largest(input, z), 1e-9);
    // The least value is the farthest depth less the largest distance from it.
    const double nearest =
        farthest - largest(input, [&](const Pixel& p) { return farthest - z(p); });
    const double low = std::max(nearest, farthest * 1e-6);
    return heat_map(input, {low, std::max(farthest, low * 1.001), true, "M"}, z);
}

Canvas roughness(const ViewInput& input) {
    return heat_map(input, {0.0, 1.0, false, "ROUGHNESS"},
                    [&](const Pixel& p) { return input.pixels.at(SURFACE_ROUGHNESS, p.index); });
}

Canvas lights(const ViewInput& input) {
    return count_map(input, "LIGHTS",
                     [&](const Pixel& p) { return input.pixels.evaluated[p.index]; });
}

Canvas false_positives(const ViewInput& input) {
    const DecodedSurfaces& pixels = input.pixels;
    if (pixels.covering.empty()) {
        throw UsageError("--show false-positives: shows the lists of --renderer deferred only");
    }
    return count_map(input, "LIGHTS IN VAIN", [&](const Pixel& p) {
        const std::size_t i = p.index;
        return pixels.evaluated[i] - pixels.covering[i];
    });
}

// The hidden share of the lights that a pixel faces within their range.
Canvas shadows(const ViewInput& input) {
    const DecodedSurfaces& pixels = input.pixels;
    if (pixels.seen.empty()) {
        throw UsageError("--show shadows: needs --shadows exact and --renderer deferred");
    }
    return heat_map(input, {0.0, 1.0, false, "SHARE HIDDEN"},
                    [&](const Pixel& p) { return hidden_share(pixels, p.index); });
}

Canvas clusters(const ViewInput& input) {
    return id_map(input, [&](const Pixel& p) {
        return coarse_cluster_at(input.pixels, p.index).value_or(0);
    });
}

Canvas slices(const ViewInput& input) {
    return id_map(input, [&](const Pixel& p) {
        return slice_of_depth(input.pixels.grid, input.pixels.at(SURFACE_DEPTH, p.index));
    });
}

Canvas active(const ViewInput& input) {
    const ClusterGrid& grid = input.pixels.grid;
    const uint tiles_x = (input.pixels.view.width + FINE_TILE - 1) / FINE_TILE;
    return id_map(input, [&](const Pixel& p) {
        const uint tile = p.y / FINE_TILE * tiles_x + p.x / FINE_TILE;
        const uint slice = fine_slice_of_depth(grid, input.pixels.at(SURFACE_DEPTH, p.index));
        return tile * (grid.slices << grid.fine_slice_bits) + slice;
    });
}

Canvas overdraw(const ViewInput& input) {
    return count_map(input, "FRAGMENTS", [&](const Pixel& p) {
        return input.overdraw[std::size_t{p.y} * input.pixels.view.width + p.x];
    });
}

// Also over background, unlike other views.
Canvas layers(const ViewInput& input) {
    const View& view = input.pixels.view;
    const std::vector<uint>& counts = input.pixels.layers;
    const HeatScale scale{0.0, std::max<double>(std::ranges::max(counts), 1.0), false, "LAYERS"};
    Canvas canvas = make_canvas(static_cast<int>(view.width), static_cast<int>(view.height));
    for (int y = 0; y < static_cast<int>(view.height); ++y) {
        for (int x = 0; x < static_cast<int>(view.width); ++x) {
            const std::size_t i =
                static_cast<std::size_t>(y) * view.stride + static_cast<std::size_t>(x);
            canvas.set(x, y, heat_color(position_on(scale, counts[i])));
        }
    }
    draw_legend(canvas, scale);
    return canvas;
}

// The largest channel's difference, over six decades below the picture's largest; where there is
// none at all, a scale to 1.
Canvas difference(const ViewInput& input) {
    const auto magnitude = [&](const Pixel& p) {
        const std::size_t i = 3 * (std::size_t{p.y} * input.pixels.view.width + p.x);
        double out = 0.0;
        for (std::size_t c = i; c < i + 3; ++c) {
            out = std::max(out, std::abs(double{input.radiance[c]} - input.reference[c]));
        }
        return out;
    };
    const double high = largest(input, magnitude);
    HeatScale scale{0.0, 1.0, false, "DIFFERENCE"};
    if (high > 0.0) scale = {high * 1e-6, high, true, "DIFFERENCE"};
    return heat_map(input, scale, magnitude);
}

Canvas luminance(const ViewInput& input) {
    return step_map(input, "CD/M2", [&](const Pixel& p) {
        const std::size_t i = 3 * (std::size_t{p.y} * input.pixels.view.width + p.x);
        return luminance_of({input.radiance[i], input.radiance[i + 1], input.radiance[i + 2]});
    });
}

Canvas illuminance(const ViewInput& input) {
    return step_map(input, "LX",
                    [&](const Pixel& p) { return illuminance_at(input.pixels, p.index); });
}

struct ViewRow {
    ViewKind kind;
    std::string_view name;
    Canvas (*draw)(const ViewInput& input);
    std::string_view meaning;
};

// In the enumeration's order.
constexpr ViewRow kViews[] = {
    {ViewKind::lit, "lit", nullptr, "the lit picture"},
    {ViewKind::albedo, "albedo", albedo, "base colour"},
    {ViewKind::normal, "normal", normal, "world normal as colour"},
    {ViewKind::depth, "depth", depth, "heat map of the distance, in metres"},
    {ViewKind::position, "position", position, "place in the scene's box as colour"},
    {ViewKind::roughness, "roughness", roughness, "heat map from 0 to 1"},
    {ViewKind::lights, "lights", lights, "heat map of lights evaluated a pixel"},
    {ViewKind::clusters, "clusters", clusters, "coarse clusters in random colours"},
    {ViewKind::slices, "slices", slices, "depth slices of the coarse grid in random colours"},
    {ViewKind::active, "active", active, "active clusters in random colours"},
    {ViewKind::overdraw, "overdraw", overdraw, "heat map of fragments drawn a pixel"},
    {ViewKind::difference, "difference", difference, "heat map of the difference to deferred-all"},
    {ViewKind::false_positives, "false-positives", false_positives,
     "heat map of lights evaluated in vain (deferred only)"},
    {ViewKind::shadows, "shadows", shadows,
     "heat map of the share of lights hidden (deferred only)"},
    {ViewKind::layers, "layers", layers, "heat map of surfaces that blend over a pixel"},
    {ViewKind::luminance, "luminance", luminance, "luminance in false colours, in cd/m2"},
    {ViewKind::illuminance, "illuminance", illuminance,
     "illuminance by lights in false colours, in lux"}};

// A text of each row.
std::vector<std::string> texts(std::string_view ViewRow::*text) {
    std::vector<std::string> out;
    for (const ViewRow& view : kViews) out.emplace_back(view.*text);
    return out;
}

}  // namespace

const std::vector<std::string>& view_names() {
    static const std::vector<std::string> names = texts(&ViewRow::name);
    return names;
}

const std::vector<std::string>& view_meanings() {
    static const std::vector<std::string> meanings = texts(&ViewRow::meaning);
    return meanings;
}

const std::string& name_of(ViewKind view) {
    return view_names().at(static_cast<std::size_t>(view));
}

ViewKind parse_view(std::string_view name) {
    for (const ViewRow& view : kViews) {
        if (view.name == name) return view.kind;
    }
    throw UsageError("--show: '" + std::string(name) + "' is not a view");
}

std::vector<std::uint8_t> make_view(ViewKind view, const ViewInput& input) {
    assert(view != ViewKind::lit);
    return kViews[static_cast<std::size_t>(view)].draw(input).rgba;
}

}  // namespace kilolux
