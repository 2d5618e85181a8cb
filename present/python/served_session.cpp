// SPDX-License-Identifier: Apache-2.0
#include "present/python/served_session.h"

#include <signal.h>

#include <atomic>
#include <exception>
#include <future>
#include <utility>

#include "host/base/error.h"
#include "host/base/log.h"
#include "present/cli/scene_choice.h"
#include "present/window/app/session.h"
#include "present/window/serve/served_screen.h"

namespace kilolux {
namespace {

// Dear ImGui has one context a process.
std::atomic<bool> is_served = false;

// The scene of the options with more lights of its own.
Scene scene_with(const SharedOptions& options, std::optional<Scene> made,
                 const std::vector<SceneLight>& lights) {
    Scene out = made ? std::move(*made) : open_animated_scene(options).take();
    out.lights.insert(out.lights.end(), lights.begin(), lights.end());
    return out;
}

}  // namespace

ServedSession::ServedSession(RendererOptions options, std::optional<Scene> made,
                             std::vector<SceneLight> lights, const ServerOptions& server) {
    if (is_served.exchange(true)) throw Error("show: there is a live view already: close() it");
    std::promise<std::string> ready;
    std::future<std::string> address = ready.get_future();
    thread_ = std::thread([this, server, ready = std::move(ready), options = std::move(options),
                           made = std::move(made), lights = std::move(lights)]() mutable {
        sigset_t signals;  // are Python's
        sigfillset(&signals);
        pthread_sigmask(SIG_BLOCK, &signals, nullptr);
        try {
            screen_ = std::make_unique<ServedScreen>(server, "Kilolux - " + options.shared.scene);
            screen_->begin({options.shared.settings.width, options.shared.settings.height});
            ready.set_value(screen_->address());
        } catch (...) {
            ready.set_exception(std::current_exception());
            return;
        }
        try {
            run(std::move(options), std::move(made), std::move(lights));
        } catch (const std::exception& error) {
            warn(std::string("show: ") + error.what());
            screen_->end(std::string("The session has ended: ") + error.what());
        }
        screen_->hide();
        closing_.get_future().wait();
        screen_.reset();  // its OpenGL objects are this thread's
    });
    try {
        address_ = address.get();
    } catch (...) {
        thread_.join();
        is_served = false;
        throw;
    }
}

void ServedSession::close() {
    if (!thread_.joinable()) return;
    screen_->close();
    screen_->wake();
    closing_.set_value();
    thread_.join();
    is_served = false;
}

void ServedSession::run(RendererOptions options, std::optional<Scene> made,
                        std::vector<SceneLight> lights) {
    SessionOptions session;
    options.shared.takes_light_layers = false;
    session.asked = options.shared;
    AnimatedScene scene = made || !lights.empty()
                              ? AnimatedScene(scene_with(options.shared, std::move(made), lights))
                              : open_animated_scene(options.shared);
    note(light_scene(options.shared, scene));
    session.shared = options.shared;
    session.state = first_state(session.asked, options.shared);
    StateFile nothing_kept({});
    ViewSession view(scene, std::move(session), nothing_kept, *screen_);
    view.run();
    view.stop();
}

}  // namespace kilolux
