// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "present/commands/picture_files.h"

namespace kilolux {

/// The pictures that `kilolux render` is asked for, computed one at a time: a sequence may have
/// 2^31 of them.
class PictureTasks {
 public:
    explicit PictureTasks(const RenderOptions& options);

    std::size_t size() const { return numbers_ ? numbers_->size() : 1; }
    PictureTask operator[](std::size_t i) const;

    /// Whether --skip-existing finds the picture.
    bool is_done(const PictureTask& task) const;
    std::size_t first_to_do() const;

 private:
    const RenderOptions& options_;
    std::optional<ShardNumbers> numbers_;  // of the frames or tiles
    bool has_video_ = false;               // the one that is asked for is there
};

/// The note of a picture's time.
std::string noted_time(double time);

}  // namespace kilolux
