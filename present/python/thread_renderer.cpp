// SPDX-License-Identifier: Apache-2.0
#include "present/python/thread_renderer.h"

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <signal.h>

#include <utility>

#include "host/base/error.h"
#include "host/base/system/interrupt.h"
#include "host/base/text.h"
#include "host/measure/reference/decoded_samples.h"
#include "host/measure/reference/frame_error.h"
#include "present/cli/option_builder.h"
#include "present/program.h"

namespace py = pybind11;

namespace kilolux {
namespace {

// The options given under headings that begin so.
std::string said_under(const CLI::App& app, std::string_view heading) {
    std::string out;
    for (const CLI::Option* option : app.get_options()) {
        if (option->count() == 0 || !option->get_group().starts_with(heading)) continue;
        out += option->get_name() + "=" + joined(option->results(), ",") + "\n";
    }
    return out;
}

// Python's main thread handles signals.
void block_signals() {
    sigset_t signals;
    sigfillset(&signals);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

// The contents of Python's arrays, and the inputs of probes.
FrameRequest request_of(const SharedOptions& shared, bool counts, bool probes) {
    FrameRequest want = shared.settings.want;
    want.counts = counts;
    want.probes = probes;
    return want;
}

}  // namespace

void visit_settings(RendererOptions& options, const SettingVisitor& visit) {
    visit_settings(options.shared, visit);
    visit_settings(options.budget, visit);
}

RendererOptions parse_renderer_options(const std::string& scene,
                                       const std::vector<std::string>& words) {
    RendererOptions options;
    CLI::App app;
    app.set_help_flag();
    app.allow_extras();
    options.shared.takes_automatic_exposure = true;
    options.shared.takes_automatic_samples = true;
    options.shared.takes_light_layers = true;
    options.shared.shows_environment = true;
    add_options(app, options);
    add_device_question(app);
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    refuse_extras(app, app.remaining());
    if (app.get_option("--list-devices")->count() > 0) {
        throw UsageError("--list-devices is for the command line; devices() lists them here");
    }
    begin_command(options.shared);
    check_budget(options.shared, options.budget);
    options.shared.scene = scene;
    options.scene_words = scene + "\n" + said_under(app, "Scene");
    options.light_words = said_under(app, "Lights");
    // light_scene() depends on these, too.
    for (const char* name : {"--ambient", "--background", "--renderer", "--max-error"}) {
        options.light_words += joined(app.get_option(name)->results(), ",") + "\n";
    }
    return options;
}

void ThreadRenderer::check(const Call& call) const {
    if (call.cancelled || thread_->is_stopping()) throw Interrupted();
}

template <typename Work>
auto ThreadRenderer::begin(Work work, const std::shared_ptr<Call>& call) {
    if (::getpid() != process_) {
        throw Error(
            "a renderer is of no use in a process that was forked after it was made: take "
            "multiprocessing's start method 'spawn'");
    }
    return thread_->ask([this, call, work = std::move(work)]() mutable {
        Call::State waiting = Call::waiting;
        if (!call->state.compare_exchange_strong(waiting, Call::running)) throw Interrupted();
        const WorkWatch watch([this, &call](double) { check(*call); });
        running_ = call.get();
        return work();
    });
}

template <typename Result>
Result ThreadRenderer::wait_for(std::future<Result> result, const std::shared_ptr<Call>& call,
                                bool to_end) {
    std::exception_ptr interruption;
    for (;;) {
        {
            const py::gil_scoped_release other_threads_run;
            if (result.wait_for(std::chrono::milliseconds(50)) == std::future_status::ready) break;
        }
        if (interruption || PyErr_CheckSignals() == 0) continue;
        interruption = std::make_exception_ptr(py::error_already_set());
        call->cancelled = true;
        Call::State waiting = Call::waiting;
        if (call->state.compare_exchange_strong(waiting, Call::dropped) || !to_end) break;
    }
    if (interruption) std::rethrow_exception(interruption);
    return result.get();
}

template <typename Work>
auto ThreadRenderer::run(Work work) {
    const auto call = std::make_shared<Call>();
    return wait_for(begin(std::move(work), call), call, false);
}

template <typename Work>
auto ThreadRenderer::run_to_end(Work work) {
    const auto call = std::make_shared<Call>();
    return wait_for(begin(std::move(work), call), call, true);
}

ThreadRenderer::ThreadRenderer(RendererOptions options, std::optional<Scene> made, Lights lights)
    : options_(std::move(options)),
      thread_(std::make_unique<TaskThread>(
          block_signals, [this] { pictures_.reset(); }, [] {})) {
    run_to_end([&] {
        const SharedOptions& shared = options_.shared;
        pictures_ = std::make_unique<SceneRenderer>(
            options_.shared, options_.budget,
            FirstPicture{request_of(shared, false, false), shared.time, 0, {}, std::move(made)});
        if (!lights.empty()) pictures_->set_lights(std::move(lights));
        if (shared.automatic_exposure) pictures_->expose_automatically(shared.time);
    });
}

ThreadRenderer::~ThreadRenderer() {
    if (::getpid() != process_) {  // a forked child has neither this thread nor the driver's
        (void)pictures_.release();
        (void)thread_.release();
        return;
    }
    const py::gil_scoped_release other_threads_run;
    thread_->stop(std::chrono::hours(1));
}

void ThreadRenderer::change(RendererOptions next, std::optional<Lights> lights) {
    if (next.scene_words != options_.scene_words) {
        throw UsageError("a renderer keeps its scene and how that is read; make a new one for '" +
                         next.shared.scene + "'");
    }
    run_to_end([&] {
        rendered_ = false;
        const bool relights = next.light_words != options_.light_words;
        if (!relights) {  // keep the values that light_scene() chose for the lights
            const SharedOptions& present = options_.shared;
            next.shared.rig = present.rig;
            next.shared.settings.ambient = present.settings.ambient;
            next.shared.settings.lights.count = present.settings.lights.count;
            next.shared.environment = present.environment;
            next.shared.reflections = present.reflections;
            next.shared.maps = present.maps;
            next.shared.background = present.background;
            next.shared.shown_background = present.shown_background;
        }
        // pictures_ refers to options_.shared, and sets it to `next`.
        pictures_->change(next.shared, next.budget, request_of(next.shared, false, false),
                          relights);
        options_.budget = next.budget;
        options_.light_words = next.light_words;
        if (lights) pictures_->set_lights(std::move(*lights));
        if (options_.shared.automatic_exposure) {
            pictures_->expose_automatically(options_.shared.time);
        }
    });
}

Frame ThreadRenderer::render_now(double time) {
    Frame frame = pictures_->render(time);
    last_time_ = time;
    rendered_ = true;
    return frame;
}

ThreadRenderer::Rendered ThreadRenderer::render(std::optional<double> time, bool counts) {
    return run([this, time, counts] {
        const double at = time.value_or(options_.shared.time);
        RenderSettings settings = pictures_->renderer().settings();
        settings.want.counts = counts;
        pictures_->renderer().change(settings);
        Frame frame = render_now(at);
        const std::string stats =
            pictures_->stats({0, at, "", frame.stats, std::nullopt}, counts).dump();
        return Rendered{std::make_shared<Frame>(std::move(frame)), stats};
    });
}

ThreadRenderer::Probed ThreadRenderer::probe(int x, int y) {
    return run([this, x, y] {
        RenderSettings settings = pictures_->renderer().settings();
        if (x < 0 || y < 0 || x >= settings.width || y >= settings.height) {
            throw UsageError(fmt::format("probe: pixel {},{} is not in the picture of {}x{}", x, y,
                                         settings.width, settings.height));
        }
        if (!settings.want.probes || !rendered_) {
            settings.want.probes = true;
            pictures_->renderer().change(settings);
            render_now(rendered_ ? last_time_ : options_.shared.time);
        }
        return Probed{pictures_->renderer().probe(x, y), pictures_->camera()};
    });
}

ReferencePicture ThreadRenderer::reference() {
    return run([this] {
        if (!rendered_) render_now(options_.shared.time);
        Renderer& renderer = pictures_->renderer();
        if (const auto word = beyond_reference(renderer.settings()); !word.empty()) {
            throw Error("reference(): the picture has " + std::string(word) +
                        ", which its reference does not model: change(samples=1, "
                        "background=\"none\", reflections=False) first");
        }
        ReferenceOptions model = reference_options(renderer, pictures_->camera());
        model.progress = [this](double) { check(*running_); };
        return picture_reference(renderer, pictures_->camera(), model);
    });
}

}  // namespace kilolux
