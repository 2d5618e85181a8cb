// SPDX-License-Identifier: Apache-2.0
#include "present/window/app/render_worker.h"

#include <GLFW/glfw3.h>

#include <utility>

#include "host/base/error.h"

namespace kilolux {

RenderWorker::RenderWorker(const Scene& scene, const RenderSettings& settings,
                           const Window& context)
    : scene_(scene), first_settings_(settings), context_(context), thread_([this] { run(); }) {}

RenderWorker::~RenderWorker() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

std::optional<std::size_t> RenderWorker::request(PictureRequest request) {
    std::optional<std::size_t> replaced;
    {
        const std::lock_guard lock(mutex_);
        if (request_) replaced = request_->slot;
        request_ = std::move(request);
    }
    changed_.notify_all();
    return replaced;
}

void RenderWorker::post(Job job) {
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back(std::move(job));
    }
    changed_.notify_all();
}

std::optional<Picture> RenderWorker::take_picture() {
    const std::lock_guard lock(mutex_);
    if (pictures_.empty()) return std::nullopt;
    std::optional<Picture> out(std::move(pictures_.front()));
    pictures_.pop_front();
    return out;
}

std::optional<RenderWorker::Failure> RenderWorker::take_failure() {
    const std::lock_guard lock(mutex_);
    if (failures_.empty()) return std::nullopt;
    std::optional<Failure> out(std::move(failures_.front()));
    failures_.pop_front();
    return out;
}

void RenderWorker::check_alive() const {
    const std::lock_guard lock(mutex_);
    if (fatal_) std::rethrow_exception(fatal_);
}

bool RenderWorker::is_idle() const {
    const std::lock_guard lock(mutex_);
    return !working_ && !request_ && jobs_.empty() && pictures_.empty();
}

void RenderWorker::run() {
    context_.make_current();
    try {
        Renderer renderer(scene_, first_settings_, GlSource::current);
        work(renderer);
    } catch (...) {
        const std::lock_guard lock(mutex_);
        fatal_ = std::current_exception();
    }
    glfwMakeContextCurrent(nullptr);
    wake_windows();
}

void RenderWorker::work(Renderer& renderer) {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        if (!jobs_.empty()) {
            const Job job = std::move(jobs_.front());
            jobs_.pop_front();
            working_ = true;
            lock.unlock();
            do_job(renderer, job);
            lock.lock();
        } else if (request_) {
            PictureRequest request = std::move(*request_);
            request_.reset();
            working_ = true;
            lock.unlock();
            do_picture(renderer, std::move(request));
            lock.lock();
        } else {
            working_ = false;
            changed_.wait(lock);
        }
    }
}

void RenderWorker::do_job(Renderer& renderer, const Job& job) {
    try {
        job(renderer);
    } catch (const std::exception& error) {
        fail(error.what(), nullptr);
    }
    wake_windows();
}

void RenderWorker::do_picture(Renderer& renderer, PictureRequest request) {
    try {
        renderer.change(request.settings);
        Frame frame = renderer.render_to(request.pixels, request.camera, request.time);
        Picture picture{std::move(request), std::move(frame), renderer.device(), renderer.plan(),
                        renderer.gpu().budget->used};
        const std::lock_guard lock(mutex_);
        pictures_.push_back(std::move(picture));
    } catch (const std::exception& error) {
        fail(error.what(), &request);
    }
    wake_windows();
}

void RenderWorker::fail(const std::string& what, const PictureRequest* request) {
    Failure failure{what, std::nullopt, 0};
    if (request != nullptr) {
        failure.slot = request->slot;
        failure.serial = request->serial;
    }
    const std::lock_guard lock(mutex_);
    failures_.push_back(std::move(failure));
}

}  // namespace kilolux
