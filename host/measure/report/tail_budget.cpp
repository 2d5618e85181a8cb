// SPDX-License-Identifier: Apache-2.0
#include "host/measure/report/tail_budget.h"

#include <algorithm>
#include <cmath>

#include "host/render/renderer.h"

namespace kilolux {
namespace {

constexpr int kLeastBudgetLog2 = -20;

}  // namespace

TailChoice tails_within(const ReportView& view, const RenderSettings& asked, double max_bound,
                        const std::function<void()>& step) {
    TailChoice out{asked, 0.0};
    out.settings.tails = Tails::exact;
    if (std::ranges::none_of(view.scene.lights, lacks_range)) return out;
    RenderSettings bounded = asked;
    bounded.tails = Tails::bounded;
    bounded.renderer = RendererKind::deferred;
    bounded.samples = 1;
    bounded.auto_samples.on = false;
    bounded.shadows = Shadows::off;
    bounded.want = {};
    bounded.want.display = false;
    bounded.want.aovs = {"error-bound"};
    Renderer renderer(view.opened, bounded);
    for (int log2 = -2; log2 >= kLeastBudgetLog2; --log2) {
        step();
        bounded.range_budget = std::ldexp(1.0, log2);
        renderer.change(bounded);
        const Frame frame = renderer.render(view.camera, view.time);
        const float worst = std::ranges::max(frame.aovs.front().values);
        if (!(worst <= max_bound)) continue;
        out.settings.tails = Tails::bounded;
        out.settings.range_budget = bounded.range_budget;
        out.bound = worst;
        return out;
    }
    return out;
}

}  // namespace kilolux
