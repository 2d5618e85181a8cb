// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/render_worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "host/base/error.h"
#include "present/cli/names.h"

namespace kilolux {

double PictureProgress::now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double PictureProgress::seconds() const {
    const double began = began_;
    return began > 0.0 ? now() - began : 0.0;
}

void PictureProgress::begin() { began_ = now(); }

void PictureProgress::note(double share) {
    if (given_up_) throw Interrupted();
    if (share < first_share_) first_share_ = 0.0;  // another pass or sample
    if (!(share > 0.0)) return;
    if (first_share_ == 0.0) {
        first_share_ = share;
        first_end_ = now();
    } else if (share > first_share_) {
        estimate_ = (now() - first_end_) / (share - first_share_);
    }
}

std::string waiting_text(RendererKind renderer, double so_far_s, double whole_s) {
    constexpr double kPatienceSeconds = 2.0;
    const double longest = std::max(whole_s, so_far_s);
    if (longest < kPatienceSeconds) return "";
    const std::string time = fmt::format("{}: {:.0f} s so far", name_of(renderer), so_far_s);
    return whole_s > 0.0 ? fmt::format("{}, about {:.0f} s in all", time, longest) : time;
}

RenderWorker::RenderWorker(const Scene& scene, const RenderSettings& settings,
                           std::function<void(bool)> use_context, TaskThread::Call wake)
    : thread_(
          [this, &scene, settings, use_context] {
              use_context(true);
              renderer_ = std::make_unique<Renderer>(scene, settings, GlSource::current);
          },
          [this, use_context] {
              renderer_.reset();
              use_context(false);
          },
          std::move(wake)) {}

void RenderWorker::end_at_stop(bool may_end) const {
    if (may_end && is_stopping()) throw Interrupted();
}

std::future<Picture> RenderWorker::render(PictureRequest request) {
    return thread_.ask_latest([this, request = std::move(request)] {
        PictureProgress* progress = request.progress.get();
        const WorkWatch watch([this, progress](double share) {
            end_at_stop(true);
            if (progress != nullptr) progress->note(share);
        });
        if (progress != nullptr) progress->begin();
        Renderer& renderer = *renderer_;
        renderer.change(request.settings);
        Frame frame =
            renderer.render_to(request.pixels, request.camera, request.time, request.samples);
        return Picture{std::move(frame), renderer.device(), renderer.plan(),
                       renderer.gpu().budget->used};
    });
}

}  // namespace kilolux
