// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/picture_saving.h"

#include <fmt/format.h>
#include <filesystem>

#include "present/cli/frame_summary.h"
#include "present/image/image_file.h"

namespace kilolux {
namespace {

namespace fs = std::filesystem;

fs::path free_file(const std::string& extension) {
    for (int i = 1;; ++i) {
        fs::path file = fmt::format("kilolux-{:03}{}", i, extension);
        if (!fs::exists(file)) return file;
    }
}

}  // namespace

void PictureSaving::begin(RenderWorker& worker, const PictureRequest& request,
                          SharedOptions options, const std::string& extension) {
    options.settings = request.settings;
    options.settings.want.radiance = true;  // EXR holds it; pictures that are shown do without
    const auto save = [request, options, extension](Renderer& renderer) {
        renderer.change(options.settings);
        const Frame frame = renderer.render(request.camera, request.time);
        ImageNotes notes = picture_notes(options, renderer.device(), frame.stats);
        notes.camera = request.camera;
        const fs::path file = free_file(extension);
        write_image(file, frame, notes);
        return "wrote " + file.string();
    };
    saving_.emplace_back(worker.ask(save, AtStop::finish));
}

void PictureSaving::take(const std::function<void(const std::string&)>& written,
                         const OnFailure& failed) {
    for (auto& saving : saving_) saving.take(written, failed);
    std::erase_if(saving_, [](const auto& saving) { return !saving.is_open(); });
}

}  // namespace kilolux
