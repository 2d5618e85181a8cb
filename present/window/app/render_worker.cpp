// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/render_worker.h"

#include <utility>

namespace kilolux {

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

std::future<Picture> RenderWorker::render(PictureRequest request) {
    return thread_.ask_latest([this, request = std::move(request)] {
        Renderer& renderer = *renderer_;
        renderer.change(request.settings);
        Frame frame =
            renderer.render_to(request.pixels, request.camera, request.time, request.samples);
        return Picture{std::move(frame), renderer.device(), renderer.plan(),
                       renderer.gpu().budget->used};
    });
}

}  // namespace kilolux
