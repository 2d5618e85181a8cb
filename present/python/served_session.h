// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "present/python/thread_renderer.h"
#include "present/window/serve/page_server.h"

namespace kilolux {

class ServedScreen;

/// The window of `kilolux view --serve` in a thread of its own, for a notebook beside it.
class ServedSession {
 public:
    /// Returns when the address can be opened. `lights` count as the scene's own. Throws Error
    /// where there is another one in this process, and as the command does.
    ServedSession(RendererOptions options, std::optional<Scene> made,
                  std::vector<SceneLight> lights, const ServerOptions& server);
    ~ServedSession() { close(); }
    ServedSession(const ServedSession&) = delete;
    ServedSession& operator=(const ServedSession&) = delete;

    const std::string& address() const { return address_; }

    /// Ends it, after the picture that is being made.
    void close();

 private:
    void run(RendererOptions options, std::optional<Scene> made, std::vector<SceneLight> lights);

    std::unique_ptr<ServedScreen> screen_;  // used in the thread, but for its end
    std::string address_;
    std::promise<void> closing_;
    std::thread thread_;
};

}  // namespace kilolux
