// SPDX-License-Identifier: Apache-2.0
// The messages of the page, page.html, to the server: JSON arrays that begin with a name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "present/window/screen/input.h"

namespace kilolux {

/// No message is longer [byte].
inline constexpr std::size_t kLongestPageMessage = 4096;

/// The edges of the page's picture [pixel], and the pixels of a CSS pixel: its scale.
struct PageSize {
    int width = 0;
    int height = 0;
    float scale = 1.0f;
};

/// The first message: ["hello", secret, tab, width, height, scale].
struct HelloMessage {
    std::string secret;
    std::string tab;  // the same when a page is loaded again, or has lost its connection
    PageSize size;
};
struct SizeMessage {  // ["size", width, height, scale]
    PageSize size;
};
struct FullScreenMessage {  // ["full-screen", on]
    bool on = false;
};
struct ShownMessage {  // ["shown", number]
    std::uint32_t picture = 0;
};
struct AliveMessage {};  // ["alive"]

/// ["key", code, action, modifiers], ["text", code points...], ["button", button, action,
/// modifiers], ["move", x, y], ["wheel", x, y], ["focus", focused].
using InputMessage = std::vector<InputEvent>;

using PageMessage = std::variant<HelloMessage, SizeMessage, FullScreenMessage, ShownMessage,
                                 AliveMessage, InputMessage>;

/// None where the text is not exactly one of the messages, with numbers in their ranges.
std::optional<PageMessage> parse_page_message(std::string_view text);

}  // namespace kilolux
