// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/page_messages.h"

#include <GLFW/glfw3.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "present/window/serve/page_keys.h"

namespace kilolux {
namespace {

using PageJson = nlohmann::json;

constexpr int kMostPixels = 8192;      // of an edge; page.html keeps this and the scale's limits
constexpr double kFarthestMove = 1e5;  // from the page's corner [pixel]
constexpr double kMostClicks = 100.0;
constexpr std::size_t kLongestText = 512;  // characters
constexpr std::size_t kLongestName = 64;   // characters, of a tab or a key
constexpr int kModifiers = GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;

// What a message lacks of its form.
struct NoMessage {};

// The values of a message after its name; throws NoMessage.
class PageValues {
 public:
    explicit PageValues(const PageJson& json) : json_(json) {}

    void expect(std::size_t count) const {
        if (json_.size() != count + 1) throw NoMessage();
    }
    std::size_t count() const { return json_.size() - 1; }
    double number(std::size_t i, double least, double most) const {
        const PageJson& value = json_.at(i);
        if (!value.is_number()) throw NoMessage();
        const double out = value.get<double>();
        if (!(out >= least && out <= most)) throw NoMessage();
        return out;
    }
    int whole(std::size_t i, int least, int most) const {
        const double out = number(i, least, most);
        if (out != std::floor(out)) throw NoMessage();
        return static_cast<int>(out);
    }
    bool flag(std::size_t i) const {
        if (!json_.at(i).is_boolean()) throw NoMessage();
        return json_.at(i).get<bool>();
    }
    std::string text(std::size_t i, std::size_t longest) const {
        if (!json_.at(i).is_string()) throw NoMessage();
        std::string out = json_.at(i).get<std::string>();
        if (out.size() > longest) throw NoMessage();
        return out;
    }
    PageSize size(std::size_t first) const {
        return {whole(first, 1, kMostPixels), whole(first + 1, 1, kMostPixels),
                static_cast<float>(number(first + 2, 0.5, 4.0))};
    }

 private:
    const PageJson& json_;
};

PageMessage hello_message(const PageValues& values) {
    values.expect(5);
    return HelloMessage{values.text(1, kLongestPageMessage), values.text(2, kLongestName),
                        values.size(3)};
}

PageMessage size_message(const PageValues& values) {
    values.expect(3);
    return SizeMessage{values.size(1)};
}

PageMessage full_screen_message(const PageValues& values) {
    values.expect(1);
    return FullScreenMessage{values.flag(1)};
}

PageMessage shown_message(const PageValues& values) {
    values.expect(1);
    return ShownMessage{static_cast<std::uint32_t>(values.number(1, 0.0, 4294967295.0))};
}

PageMessage alive_message(const PageValues& values) {
    values.expect(0);
    return AliveMessage{};
}

PageMessage key_message(const PageValues& values) {
    values.expect(3);
    const std::optional<int> key = key_of_code(values.text(1, kLongestName));
    const KeyEvent event{key.value_or(GLFW_KEY_UNKNOWN), 0,
                         values.whole(2, GLFW_RELEASE, GLFW_REPEAT),
                         values.whole(3, 0, kModifiers)};
    return key ? InputMessage{event} : InputMessage{};
}

PageMessage text_message(const PageValues& values) {
    if (values.count() > kLongestText) throw NoMessage();
    InputMessage out;
    for (std::size_t i = 1; i <= values.count(); ++i) {
        out.emplace_back(TextEvent{static_cast<unsigned>(values.whole(i, 32, 0x10ffff))});
    }
    return out;
}

PageMessage button_message(const PageValues& values) {
    values.expect(3);
    return InputMessage{
        ButtonEvent{values.whole(1, GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_MIDDLE),
                    values.whole(2, GLFW_RELEASE, GLFW_PRESS), values.whole(3, 0, kModifiers)}};
}

PageMessage move_message(const PageValues& values) {
    values.expect(2);
    return InputMessage{MoveEvent{values.number(1, -kFarthestMove, kFarthestMove),
                                  values.number(2, -kFarthestMove, kFarthestMove)}};
}

PageMessage wheel_message(const PageValues& values) {
    values.expect(2);
    return InputMessage{WheelEvent{values.number(1, -kMostClicks, kMostClicks),
                                   values.number(2, -kMostClicks, kMostClicks)}};
}

PageMessage focus_message(const PageValues& values) {
    values.expect(1);
    return InputMessage{FocusEvent{values.flag(1)}};
}

const std::map<std::string, PageMessage (*)(const PageValues&)>& message_forms() {
    static const std::map<std::string, PageMessage (*)(const PageValues&)> forms = {
        {"hello", hello_message}, {"size", size_message},     {"full-screen", full_screen_message},
        {"shown", shown_message}, {"alive", alive_message},   {"key", key_message},
        {"text", text_message},   {"button", button_message}, {"move", move_message},
        {"wheel", wheel_message}, {"focus", focus_message}};
    return forms;
}

}  // namespace

std::optional<PageMessage> parse_page_message(std::string_view text) {
    if (text.size() > kLongestPageMessage) return std::nullopt;
    const PageJson json = PageJson::parse(text, nullptr, false);
    if (!json.is_array() || json.empty() || !json.at(0).is_string()) return std::nullopt;
    const auto form = message_forms().find(json.at(0).get<std::string>());
    if (form == message_forms().end()) return std::nullopt;
    try {
        return form->second(PageValues(json));
    } catch (const NoMessage&) {
        return std::nullopt;
    }
}

}  // namespace kilolux
