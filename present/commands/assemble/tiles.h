// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace kilolux {

/// Joins the files of a picture's tiles (render --tiles or --crop), in any order, to the file of
/// the picture: the bytes that render writes for the whole without --png-level. Holds 256 rows at a
/// time, and one row of tiles open. `on_rows` is called after rows are written, with the share that
/// is done, 0 to 1.
///
/// Throws Error for files that are no parts of one picture, that overlap or leave pixels out, that
/// are not arranged in rows and columns, or whose format is not that of `out` or loses digits.
void join_tiles(const std::filesystem::path& out, const std::vector<std::filesystem::path>& tiles,
                const std::function<void(double)>& on_rows);

}  // namespace kilolux
