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
    std::string scene_words, light_words;  // what was said of the scene, of the lights
};

/// The options of a renderer with their values in `options`.
std::vector<Setting> settings_of(RendererOptions& options);

/// Throws UsageError or CLI::ParseError as the command line would. `scene`: a generated scene, a
/// file, or the name of a scene that was made.
RendererOptions parse_renderer_options(const std::string& scene,
                                       const std::vector<std::string>& words);

/// A SceneRenderer in a thread of its own, which its OpenGL context belongs to: any thread of
/// Python may use it, and other threads of Python run while one waits for it. An interruption from
/// the keyboard ends the call of the thread that gets it, and no other's.
class ThreadRenderer {
 public:
    using Lights = std::vector<SceneLight>;

    ThreadRenderer(RendererOptions options, std::optional<Scene> made, Lights lights);
    ~ThreadRenderer();
    ThreadRenderer(const ThreadRenderer&) = delete;
    ThreadRenderer& operator=(const ThreadRenderer&) = delete;

    /// `lights`: in place of the former; none: those stay.
    void change(RendererOptions next, std::optional<Lights> lights);

    /// `time` [s]; none: that of the options. `counts`: also what --stats counts with passes and
    /// measurements of its own.
    struct Rendered {
        std::shared_ptr<Frame> frame;
        std::string stats;  // JSON
    };
    Rendered render(std::optional<double> time, bool counts);

    /// A pixel of the last picture; without one since the last change, of one that is made.
    struct Probed {
        PixelProbe probe;
        Camera camera;
    };
    Probed probe(int x, int y);

    /// The float64 reference of what that picture shaded, and how many lights reach a pixel.
    ReferencePicture reference();

 private:
    // A call of Python's on its way through the thread.
    struct Call {
        enum State { waiting, running, dropped };
        std::atomic<State> state = waiting;
        std::atomic<bool> cancelled = false;
    };
    // `work` holds what it needs itself: after an interruption it ends on its own.
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
