// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "present/commands/scene_renderer.h"
#include "present/window/app/task_thread.h"

namespace kilolux {

/// The options of a renderer, from the words of a command line.
struct RendererOptions {
    SharedOptions shared;
    BudgetOptions budget;
    std::string scene_words, light_words;  // the given options of the scene, and of lights
};

/// The options of a renderer with their values in `options`.
void visit_settings(RendererOptions& options, const SettingVisitor& visit);

/// Throws UsageError or CLI::ParseError as the command line would. `scene`: a generated scene, a
/// file, or the name of a scene made from arrays.
RendererOptions parse_renderer_options(const std::string& scene,
                                       const std::vector<std::string>& words);

/// A SceneRenderer in its own thread, to which its OpenGL context belongs. Any thread of Python may
/// call it; a call releases the GIL while it waits. An interruption from the keyboard ends the call
/// of the thread that receives it, and no other's.
class ThreadRenderer {
 public:
    using Lights = std::vector<SceneLight>;

    ThreadRenderer(RendererOptions options, std::optional<Scene> made, Lights lights);
    ~ThreadRenderer();
    ThreadRenderer(const ThreadRenderer&) = delete;
    ThreadRenderer& operator=(const ThreadRenderer&) = delete;

    /// `lights`: replace the former ones; none: those stay.
    void change(RendererOptions next, std::optional<Lights> lights);

    /// `time` [s]; none: that of the options. `counts`: also the counts of --stats that take passes
    /// and measurements of their own.
    struct Rendered {
        std::shared_ptr<Frame> frame;
        std::string stats;  // JSON
    };
    Rendered render(std::optional<double> time, bool counts);

    /// A pixel of the last picture; without one since the last change, a picture is made first.
    struct Probed {
        PixelProbe probe;
        Camera camera;
    };
    Probed probe(int x, int y);

    /// The float64 reference of that picture's surfaces and lights, and how many lights reach a
    /// pixel. Throws Error where the picture has what the reference does not model.
    ReferencePicture reference();

 private:
    // A call of Python on its way through the thread.
    struct Call {
        enum State { waiting, running, dropped };
        std::atomic<State> state = waiting;
        std::atomic<bool> cancelled = false;
    };
    // `work` owns its data: after an interruption it ends on its own.
    template <typename Work>
    auto run(Work work);
    // The same, but `work` may refer to the caller's variables: a call that has begun is waited
    // for.
    template <typename Work>
    auto run_to_end(Work work);
    template <typename Result>
    Result wait_for(std::future<Result> result, const std::shared_ptr<Call>& call, bool to_end);
    template <typename Work>
    auto begin(Work work, const std::shared_ptr<Call>& call);
    void check(const Call& call) const;
    Frame render_now(double time);

    RendererOptions options_;
    const Call* running_ = nullptr;            // set in the thread
    double last_time_ = 0.0;                   // [s] of the last picture
    bool rendered_ = false;                    // whether there is one
    pid_t process_ = ::getpid();               // that the thread and OpenCL belong to
    std::unique_ptr<SceneRenderer> pictures_;  // used in the thread only
    std::unique_ptr<TaskThread> thread_;       // last: it ends first
};

}  // namespace kilolux
