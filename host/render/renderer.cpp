// SPDX-License-Identifier: Apache-2.0
#include "host/render/renderer.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstring>
#include <utility>

#include "host/render/frame.h"
#include "host/render/pipeline.h"
#include "host/render/plan/kernel_choice.h"

namespace kilolux {
namespace {

// Throws for a picture in bands: the device has only the last one.
void require_whole(const Pipeline& pipeline, const char* what) {
    if (pipeline.context.is_whole()) return;
    throw Error(fmt::format(
        "{}: the picture is made in bands of {} rows; it needs the whole (--max-memory)", what,
        pipeline.context.memory.band_rows));
}

std::unique_ptr<Pipeline> make_pipeline(std::shared_ptr<RenderScene> scene,
                                        const RenderSettings& settings, const auto& device) {
    return in_stage("renderer", [&] {
        scene->make_current();
        return std::make_unique<Pipeline>(std::move(scene), settings, device());
    });
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const cl::Device& device : all_devices()) infos.push_back(describe(device));
    return infos;
}

std::shared_ptr<RenderScene> shared_scene(const Scene& scene, GlSource gl) {
    return std::make_shared<RenderScene>(scene, gl == GlSource::headless);
}

Renderer::Renderer(const Scene& scene, const RenderSettings& settings, GlSource gl)
    : Renderer(shared_scene(scene, gl), settings) {}
Renderer::Renderer(const Scene& scene, const RenderSettings& settings, const Gpu& opened)
    : pipeline_(make_pipeline(shared_scene(scene, GlSource::headless), settings,
                              [&] { return device_for(settings, opened); })) {}
Renderer::Renderer(std::shared_ptr<RenderScene> scene, const RenderSettings& settings)
    : pipeline_(make_pipeline(std::move(scene), settings, [&] { return open_device(settings); })) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::change(const RenderSettings& settings) {
    if (settings == pipeline_->context.settings) return;
    pipeline_->context.scene->make_current();
    in_stage("settings", [&] { Pipeline::change(pipeline_, pipeline_->context.scene, settings); });
}

void Renderer::refit() {
    pipeline_->context.scene->make_current();
    const RenderSettings settings = pipeline_->context.settings;
    in_stage("lights", [&] { Pipeline::change(pipeline_, pipeline_->context.scene, settings); });
}

std::size_t display_stride(int width) { return view_of(Camera{}, width, 1).stride; }

Frame Renderer::render(const Camera& camera, double time) {
    return in_stage("render", [&] { return render_frame(*pipeline_, {camera, time}); });
}

Frame Renderer::render_to(std::span<uint> pixels, const Camera& camera, double time, int samples) {
    const RenderSettings& s = settings();
    const std::size_t stride = display_stride(s.width);
    pixels = pixels.first(stride * static_cast<std::size_t>(s.height));
    const bool direct = s.want.view == ViewKind::lit && pipeline_->context.is_whole();
    return in_stage("render", [&] {
        Frame frame =
            render_frame(*pipeline_, {camera, time, direct ? pixels : DisplayMemory(), samples});
        if (direct) return frame;
        const auto row = static_cast<std::size_t>(s.width);
        for (std::size_t y = 0; y < static_cast<std::size_t>(s.height); ++y) {
            std::memcpy(&pixels[y * stride], &frame.display[4 * y * row], 4 * row);
        }
        frame.display.clear();
        return frame;
    });
}

Frame Renderer::render_strip(const Camera& camera, double time, Band rows) {
    if (!can_make_strips(settings())) {
        throw Error("render: a view or a stage such as bloom needs the whole picture, not a strip");
    }
    return in_stage("render", [&] {
        return kilolux::render_strip(*pipeline_, {camera, time, {}, 0, rows});
    });
}

Frame Renderer::render_crop(const Camera& camera, double time, const PixelRect& rect) {
    return in_stage("render", [&] {
        return kilolux::render_crop(*pipeline_, {camera, time}, rect);
    });
}

std::vector<Band> Renderer::strips() const {
    const int height = settings().height;
    const int rows = memory().strip_rows;
    std::vector<Band> out;
    for (int row = 0; row < height; row += rows) out.push_back({row, std::min(rows, height - row)});
    return out;
}

std::unique_ptr<SharedPicture> Renderer::begin_rows() const {
    return kilolux::begin_rows(*pipeline_);
}

FrameStats Renderer::render_rows(SharedPicture& picture, const Camera& camera, double time,
                                 Band rows) {
    return in_stage("render", [&] {
        return kilolux::render_rows(*pipeline_, {camera, time, {}, 0, rows}, picture);
    });
}

FrameStats Renderer::finish_rows(SharedPicture& picture, const Camera& camera, double time) {
    const Band all{0, settings().height};
    return in_stage("render", [&] {
        return kilolux::finish_rows(*pipeline_, {camera, time, {}, 0, all}, picture);
    });
}

LitSurfaces Renderer::lit_surfaces() {
    require_whole(*pipeline_, "lit surfaces");
    return in_stage("lit surfaces",
                    [&] { return pipeline_->reader.lit_surfaces(pipeline_->last_sample()); });
}

std::shared_ptr<Spares<Frame>> Renderer::spare_frames() const {
    return pipeline_->picture.spares();
}

std::span<uint> Renderer::display_memory() {
    return in_stage("display memory", [&] { return pipeline_->picture.display_memory(); });
}

PixelProbe Renderer::probe(int x, int y) {
    require_whole(*pipeline_, "probe");
    pipeline_->context.scene->make_current();
    return in_stage("probe", [&] {
        const LightRows rows = pipeline_->lights.rows(pipeline_->last.camera.position);
        return pipeline_->reader.probe(pipeline_->last_sample(), rows, x, y);
    });
}

std::vector<ActiveCluster> Renderer::active_clusters() const {
    const LightLists* lists = pipeline_->current_stages().lists();
    if (lists == nullptr) return {};
    return in_stage("active clusters",
                    [&] { return lists->active_clusters(pipeline_->last.band.lists); });
}

std::uint64_t Renderer::light_count(const RenderSettings& settings) const {
    return settings.lights.count + pipeline_->context.scene->scene().lights.size();
}

const Scene& Renderer::scene() const { return pipeline_->context.scene->scene(); }
const RenderSettings& Renderer::settings() const { return pipeline_->context.settings; }
const DeviceInfo& Renderer::device() const { return pipeline_->context.gpu.info; }
const ScenePlan& Renderer::plan() const { return pipeline_->context.plan; }
const MemoryPlan& Renderer::memory() const { return pipeline_->context.memory; }
const Gpu& Renderer::gpu() const { return pipeline_->context.gpu; }

}  // namespace kilolux
