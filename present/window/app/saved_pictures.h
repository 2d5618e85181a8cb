// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>

#include "present/cli/options.h"
#include "present/window/app/awaited.h"
#include "present/window/app/render_worker.h"

namespace kilolux {

/// Pictures that the worker renders in full and writes to the current folder.
class SavedPictures {
 public:
    /// Saves the request's picture as the first of kilolux-001, kilolux-002, ... that does not
    /// exist. `options`: all that its notes tell but the settings.
    void begin(RenderWorker& worker, const PictureRequest& request, SharedOptions options,
               const std::string& extension);

    /// Passes the line of each picture that is written to `written`.
    void take(const std::function<void(const std::string&)>& written, const OnFailure& failed);

    bool are_open() const { return !saving_.empty(); }

 private:
    std::deque<Awaited<std::string>> saving_;
};

}  // namespace kilolux
