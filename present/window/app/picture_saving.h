// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <string>

#include "present/cli/options.h"
#include "present/window/app/awaited.h"
#include "present/window/app/render_worker.h"

namespace kilolux {

/// Has the worker render pictures in full and write them to the current folder.
class PictureSaving {
 public:
    /// Saves the request's picture as kilolux-001, or the next number that no file has, with this
    /// extension. `options`: for the notes in the file; their settings are the request's.
    void begin(RenderWorker& worker, const PictureRequest& request, SharedOptions options,
               const std::string& extension);

    /// Calls `written` with a message for each picture that was written since the last call.
    void take(const std::function<void(const std::string&)>& written, const OnFailure& failed);

    bool is_open() const { return !saving_.empty(); }

 private:
    std::deque<Awaited<std::string>> saving_;
};

}  // namespace kilolux
