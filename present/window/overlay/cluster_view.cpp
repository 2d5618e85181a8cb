// SPDX-License-Identifier: Apache-2.0
#include "present/window/overlay/cluster_view.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/picture/view_canvas.h"
#include "host/scene/lights/light_ranges.h"
#include "present/window/panel/panel_stats.h"

namespace kilolux {
namespace {

constexpr ImU32 kActiveColor = IM_COL32(255, 255, 255, 230);
constexpr ImU32 kCoarseColor = IM_COL32(90, 200, 255, 150);
constexpr std::size_t kShownLights = 12;
constexpr float kProbeWidth = 400.0f;  // for a font of 15 pixels

glm::dvec3 to_world(const Camera& camera, const glm::dvec3& view) {
    return camera.world_from_view * view + camera.position;
}

// Colour of a list with this share of the longest one's lights. Starts at a quarter, since the dark
// end of the heat map is invisible over dark pictures.
DisplayColor color_of_list(double share) { return heat_color(0.25 + 0.75 * share); }

double brightness(const glm::dvec3& radiance) {
    return std::max({radiance.x, radiance.y, radiance.z});
}

void draw_lights(const ProjectedPicture& picture, const ProbedPixel& pixel) {
    const double most = pixel.shares.empty() ? 0.0 : brightness(pixel.shares.front().radiance);
    for (const LightContribution& share : pixel.shares) {
        const auto found =
            std::find_if(pixel.probe.lights.begin(), pixel.probe.lights.end(),
                         [&](const ProbedLight& light) { return light.index == share.index; });
        const float4& relative = found->light.position_range;
        const glm::dvec3 world =
            pixel.camera.position + glm::dvec3(relative.x, relative.y, relative.z);
        const std::optional<glm::vec2> at = picture.place_of(world);
        if (!at) continue;
        const double part = most > 0.0 ? brightness(share.radiance) / most : 0.0;
        const float radius = 2.0f + 5.0f * static_cast<float>(std::sqrt(part));
        const ImU32 color = part > 0.0 ? IM_COL32(255, 190, 70, 220) : IM_COL32(160, 160, 160, 140);
        picture.draw().AddCircle({at->x, at->y}, radius, color, 12, 1.5f);
    }
}

void share_row(const LightContribution& share, double total) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::Text("%u", share.index);
    ImGui::TableNextColumn();
    ImGui::Text("%.2f m", share.distance);
    ImGui::TableNextColumn();
    // Kernels round a range down.
    const bool ends = share.range < 0.5 * double{kUnlimitedRange};
    ImGui::TextUnformatted(ends ? fmt::format("{:.2f} m", share.range).c_str() : "none");
    ImGui::TableNextColumn();
    if (*share.why_dark != '\0') return ImGui::TextWrapped("%s", share.why_dark);
    const double part = total > 0.0 ? brightness(share.radiance) / total : 0.0;
    const std::string text = fmt::format("{:.3g}", brightness(share.radiance));
    ImGui::ProgressBar(static_cast<float>(part), {-FLT_MIN, ImGui::GetFontSize()}, text.c_str());
}

// `most`: rows of the table.
void describe_lights(const ProbedPixel& pixel, std::size_t most) {
    double total = 0.0;
    std::size_t reaching = 0;
    for (const LightContribution& share : pixel.shares) {
        total += brightness(share.radiance);
        reaching += share.distance < share.range ? 1 : 0;
    }
    fact_line("List", fmt::format("{} lights, {} reach the pixel", pixel.shares.size(), reaching));
    if (pixel.shares.empty()) return;
    if (!ImGui::BeginTable("shares", 4, ImGuiTableFlags_SizingStretchProp)) return;
    constexpr std::pair<const char*, float> kColumns[] = {
        {"light", 0.6f}, {"distance", 0.9f}, {"range", 0.8f}, {"adds", 1.5f}};
    for (const auto& [text, weight] : kColumns) ImGui::TableSetupColumn(text, 0, weight);
    ImGui::TableNextRow();
    for (const auto& [text, weight] : kColumns) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", text);
    }
    const std::size_t shown = std::min(pixel.shares.size(), most);
    for (std::size_t i = 0; i < shown; ++i) share_row(pixel.shares[i], total);
    ImGui::EndTable();
    if (pixel.shares.size() > shown) {
        ImGui::TextDisabled("and %zu more", pixel.shares.size() - shown);
    }
}

void describe_lists(const ProbedPixel& pixel, std::size_t most) {
    const PixelProbe& p = pixel.probe;
    fact_line("Coarse", fmt::format("tile {}, {}  slice {}  {} lights", p.tile_x, p.tile_y, p.slice,
                                    p.coarse_count));
    if (p.active) {
        const ActiveCluster& a = *p.active;
        fact_line("Active", fmt::format("slice {}  {} pixels  {:.2f} x {:.2f} x {:.2f} m", a.slice,
                                        a.pixel_count, a.max_x - a.min_x, a.max_y - a.min_y,
                                        a.max_z - a.min_z));
    }
    if (p.has_list) {
        describe_lights(pixel, most);
    } else {
        ImGui::TextDisabled("this renderer evaluates every light at every pixel");
    }
}

// The box's edges. Bits 0, 1, 2 of a corner's index: x, y, z.
void draw_edges(const ProjectedPicture& picture, const std::array<glm::dvec3, 8>& corners,
                ImU32 color) {
    for (std::size_t from = 0; from < 8; ++from) {
        for (const std::size_t bit : {1u, 2u, 4u}) {
            if ((from & bit) == 0) picture.line(corners[from], corners[from | bit], {color});
        }
    }
}

// World positions of a box whose corner i is corner(x, y, z) in view space, bits 0 to 2 of i.
template <typename Corner>
std::array<glm::dvec3, 8> corners_of(const Camera& camera, Corner corner) {
    std::array<glm::dvec3, 8> corners;
    for (uint i = 0; i < 8; ++i) corners[i] = to_world(camera, corner(i & 1, i >> 1 & 1, i >> 2));
    return corners;
}

std::array<glm::dvec3, 8> active_corners(const ProbedPixel& pixel) {
    const ActiveCluster& a = *pixel.probe.active;
    return corners_of(pixel.camera, [&](uint x, uint y, uint z) {
        return glm::dvec3(x ? a.max_x : a.min_x, y ? a.max_y : a.min_y, z ? a.max_z : a.min_z);
    });
}

std::array<glm::dvec3, 8> coarse_corners(const ProbedPixel& pixel) {
    const PixelProbe& p = pixel.probe;
    const View view = view_of(pixel.camera, pixel.width, pixel.height);
    return corners_of(pixel.camera, [&](uint x, uint y, uint z) {
        const auto right = static_cast<float>((p.tile_x + x) * p.grid.tile_width);
        const auto down = static_cast<float>((p.tile_y + y) * p.grid.tile_height);
        const FV3 at = view_position(view, std::min(right, static_cast<float>(pixel.width)),
                                     std::min(down, static_cast<float>(pixel.height)),
                                     depth_of_slice(p.grid, p.slice + z));
        return glm::dvec3(at.x, at.y, at.z);
    });
}

}  // namespace

void draw_probe(ImDrawList& draw, const ProbedPixel& pixel, const Camera& camera,
                const ScreenPlace& place) {
    if (!pixel.probe.has_surface()) return;
    const ProjectedPicture picture(draw, camera, place);
    if (pixel.probe.has_list) draw_edges(picture, coarse_corners(pixel), kCoarseColor);
    if (pixel.probe.active) draw_edges(picture, active_corners(pixel), kActiveColor);
    draw_lights(picture, pixel);
}

std::string pixel_line(const ProbedPixel& pixel) {
    const std::string place = fmt::format("{},{}  ", pixel.x, pixel.y);
    if (!pixel.probe.has_surface()) return place + "nothing is there";
    return place + fmt::format("depth {:.2f} m", pixel.probe.surface[SURFACE_DEPTH]);
}

void describe_probe(const ProbedPixel& pixel, const ScreenPlace& place, float scale) {
    const float margin = 10.0f * scale;
    const float height = place.y1 - place.y0 - 2.0f * margin;
    ImGui::SetNextWindowPos({place.x1 - margin, place.y1 - margin}, ImGuiCond_Always, {1.0f, 1.0f});
    ImGui::SetNextWindowSize(
        {std::min(kProbeWidth * scale, place.x1 - place.x0 - 2.0f * margin), 0.0f});
    ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {FLT_MAX, height});
    ImGui::SetNextWindowBgAlpha(0.85f);
    ImGui::Begin("probe", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                     ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing);
    fact_line("Pixel", pixel_line(pixel));
    for (const ProbedLayer& layer : pixel.probe.layers) {
        fact_line("Through",
                  fmt::format("{} at {:.2f} m", layer.material, layer.surface[SURFACE_DEPTH]));
    }
    if (pixel.probe.has_surface()) {
        const auto& s = pixel.probe.surface;
        const glm::dvec3 world = to_world(
            pixel.camera, {s[SURFACE_POSITION], s[SURFACE_POSITION + 1], s[SURFACE_POSITION + 2]});
        fact_line("Position", fmt::format("{:.2f}, {:.2f}, {:.2f} m", world.x, world.y, world.z));
        // Ten lines stand around the table, and the layers; long ones wrap.
        const float lines = 10.0f + static_cast<float>(pixel.probe.layers.size());
        const float rows = height / ImGui::GetTextLineHeightWithSpacing() - lines;
        describe_lists(pixel,
                       static_cast<std::size_t>(std::clamp(rows, 1.0f, 1.0f * kShownLights)));
    }
    ImGui::End();
}

uint longest_list(const FrozenClusters& frozen) {
    uint most = 1;
    for (const ActiveCluster& c : frozen.clusters) most = std::max(most, c.list_count);
    return most;
}

void describe_box_colors(uint most, const ScreenPlace& place, float scale) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const std::string ends[2] = {"1 light", fmt::format("{}", most)};
    const float line = ImGui::GetTextLineHeight(), margin = 10.0f * scale;
    const float step = 5.0f * scale;
    constexpr int kSteps = 24;
    const float left = place.x0 + margin, top = place.y1 - margin - line;
    const float bar = left + ImGui::CalcTextSize(ends[0].c_str()).x + margin;
    const float right = bar + kSteps * step + margin;
    draw.AddRectFilled(
        {left - 0.5f * margin, top - 0.5f * margin},
        {right + ImGui::CalcTextSize(ends[1].c_str()).x + 0.5f * margin, place.y1 - 0.5f * margin},
        IM_COL32(0, 0, 0, 170), 4.0f * scale);
    for (int i = 0; i < kSteps; ++i) {
        const DisplayColor c = color_of_list(i / (kSteps - 1.0));
        draw.AddRectFilled({bar + step * static_cast<float>(i), top},
                           {bar + step * static_cast<float>(i + 1), top + line},
                           IM_COL32(c[0], c[1], c[2], 255));
    }
    draw.AddText({left, top}, IM_COL32_WHITE, ends[0].c_str());
    draw.AddText({right, top}, IM_COL32_WHITE, ends[1].c_str());
}

std::vector<DrawnBox> boxes_of(const FrozenClusters& frozen, uint least) {
    const uint most = longest_list(frozen);
    std::vector<DrawnBox> boxes;
    for (const ActiveCluster& c : frozen.clusters) {
        if (c.list_count < least) continue;
        const DisplayColor code = color_of_list(1.0 * c.list_count / most);
        const glm::vec3 color = glm::vec3(code[0], code[1], code[2]) / 255.0f;
        boxes.push_back(
            {{c.min_x, c.min_y, c.min_z}, {c.max_x, c.max_y, c.max_z}, glm::vec4(color, 0.85f)});
    }
    return boxes;
}

}  // namespace kilolux
