// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/bench_job.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "host/base/atomic_write.h"
#include "host/base/error.h"
#include "present/cli/names.h"
#include "present/window/panel/stage_history.h"

namespace kilolux {
namespace {

// Ends a measurement from within.
struct Cancelled {};

constexpr std::uint64_t kFewestLights = 256;

// Powers of ten that hold all values.
struct Decades {
    double low = 1e300;
    double high = 0.0;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    void round() {
        low = std::pow(10.0, std::floor(std::log10(low)));
        high = std::max(std::pow(10.0, std::ceil(std::log10(high))), 10.0 * low);
    }
    double place(double value) const { return std::log(value / low) / std::log(high / low); }
};

struct Curve {
    std::vector<std::pair<double, double>> points;  // lights, ms
};

std::map<RendererKind, Curve> curves_of(const std::vector<BenchRow>& rows) {
    std::map<RendererKind, Curve> curves;
    for (const BenchRow& row : rows) {
        if (row.stage != kFrameStage || !(row.ms.median > 0.0)) continue;
        curves[row.point.renderer].points.emplace_back(row.point.lights, row.ms.median);
    }
    return curves;
}

void draw_grid(ImDrawList& draw, const ImVec2& low, const ImVec2& high, const Decades& y) {
    for (double value = y.low; value <= y.high * 1.001; value *= 10.0) {
        const float at = high.y + (low.y - high.y) * static_cast<float>(y.place(value));
        draw.AddLine({low.x, at}, {high.x, at}, 0x28ffffff);
        char text[24];
        std::snprintf(text, sizeof text, "%g ms", value);
        draw.AddText({low.x + 3.0f, at - ImGui::GetFontSize()}, 0xa0ffffff, text);
    }
}

}  // namespace

std::vector<SweepPoint> points_of(const BenchRequest& request) {
    SweepAxes axes;
    axes.renderers = request.renderers;
    axes.resolutions = {{request.settings.width, request.settings.height}};
    axes.lights.clear();
    for (std::uint64_t n = kFewestLights; n <= std::max(request.most_lights, kFewestLights);
         n *= 4) {
        axes.lights.push_back(n);
    }
    const GridSettings& grid = request.settings.grid;
    axes.grids = {{grid.tiles_x, grid.tiles_y, grid.slices_per_octave}};
    axes.lanes = {request.settings.kernels.lanes};
    axes.gbuffers = {request.settings.gbuffer};
    return sweep_points(axes);
}

void run_bench_job(const Scene& scene, const BenchRequest& request, BenchProgress& progress) {
    try {
        RenderSettings base = request.settings;
        base.want.view = ViewKind::lit;
        BenchRun run(scene, base, request.camera, request.time, GlSource::current);
        const std::vector<SweepPoint> points = points_of(request);
        progress.frames_total = run.frame_count(points, request.frames);
        run.on_frame([&progress] {
            ++progress.frames_done;
            if (progress.cancelled) throw Cancelled();
        });
        for (const SweepPoint& point : points) {
            const std::vector<BenchRow> rows = run.measure(point, request.frames);
            const std::lock_guard lock(progress.mutex);
            progress.rows.insert(progress.rows.end(), rows.begin(), rows.end());
            write_whole_file(request.csv, to_csv(bench_table(progress.rows)));
        }
    } catch (const Cancelled&) {
        // Its rows so far stay.
    } catch (const std::exception& error) {
        const std::lock_guard lock(progress.mutex);
        progress.failure = error.what();
    }
    progress.running = false;
}

void draw_bench_plot(const std::vector<BenchRow>& rows, float height) {
    const std::map<RendererKind, Curve> curves = curves_of(rows);
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 high = {low.x + ImGui::GetContentRegionAvail().x, low.y + height};
    ImGui::Dummy({high.x - low.x, height});
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(low, high, 0xff161414, 4.0f);
    Decades x, y;
    for (const auto& [renderer, curve] : curves) {
        for (const auto& [lights, ms] : curve.points) {
            x.add(lights);
            y.add(ms);
        }
    }
    if (curves.empty()) return;
    x.low *= 0.8;
    x.high = std::max(x.high, 2.0 * x.low) * 1.25;
    y.round();
    draw_grid(draw, low, high, y);
    std::size_t color = 0;
    for (const auto& [renderer, curve] : curves) {
        ImVec2 last{};
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const auto& [lights, ms] = curve.points[i];
            const ImVec2 at = {low.x + (high.x - low.x) * static_cast<float>(x.place(lights)),
                               high.y + (low.y - high.y) * static_cast<float>(y.place(ms))};
            if (i > 0) draw.AddLine(last, at, stage_color(color), 2.0f);
            draw.AddCircleFilled(at, 3.5f, stage_color(color));
            last = at;
        }
        const std::string name = name_of(renderer);
        const float line = ImGui::GetFontSize() * static_cast<float>(color);
        draw.AddText({high.x - ImGui::CalcTextSize(name.c_str()).x - 6.0f, low.y + 4.0f + line},
                     stage_color(color), name.c_str());
        ++color;
    }
}

}  // namespace kilolux
