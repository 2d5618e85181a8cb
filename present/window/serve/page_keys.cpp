// SPDX-License-Identifier: Apache-2.0
#include "present/window/serve/page_keys.h"

#include <GLFW/glfw3.h>

#include <map>

namespace kilolux {
namespace {

// Names of the UI Events specification, "KeyboardEvent code Values".
const std::map<std::string_view, int>& named_codes() {
    static const std::map<std::string_view, int> codes = {{"Space", GLFW_KEY_SPACE},
                                                          {"Quote", GLFW_KEY_APOSTROPHE},
                                                          {"Comma", GLFW_KEY_COMMA},
                                                          {"Minus", GLFW_KEY_MINUS},
                                                          {"Period", GLFW_KEY_PERIOD},
                                                          {"Slash", GLFW_KEY_SLASH},
                                                          {"Semicolon", GLFW_KEY_SEMICOLON},
                                                          {"Equal", GLFW_KEY_EQUAL},
                                                          {"BracketLeft", GLFW_KEY_LEFT_BRACKET},
                                                          {"Backslash", GLFW_KEY_BACKSLASH},
                                                          {"BracketRight", GLFW_KEY_RIGHT_BRACKET},
                                                          {"Backquote", GLFW_KEY_GRAVE_ACCENT},
                                                          {"Escape", GLFW_KEY_ESCAPE},
                                                          {"Enter", GLFW_KEY_ENTER},
                                                          {"Tab", GLFW_KEY_TAB},
                                                          {"Backspace", GLFW_KEY_BACKSPACE},
                                                          {"Insert", GLFW_KEY_INSERT},
                                                          {"Delete", GLFW_KEY_DELETE},
                                                          {"ArrowRight", GLFW_KEY_RIGHT},
                                                          {"ArrowLeft", GLFW_KEY_LEFT},
                                                          {"ArrowDown", GLFW_KEY_DOWN},
                                                          {"ArrowUp", GLFW_KEY_UP},
                                                          {"PageUp", GLFW_KEY_PAGE_UP},
                                                          {"PageDown", GLFW_KEY_PAGE_DOWN},
                                                          {"Home", GLFW_KEY_HOME},
                                                          {"End", GLFW_KEY_END},
                                                          {"NumpadEnter", GLFW_KEY_KP_ENTER},
                                                          {"ShiftLeft", GLFW_KEY_LEFT_SHIFT},
                                                          {"ShiftRight", GLFW_KEY_RIGHT_SHIFT},
                                                          {"ControlLeft", GLFW_KEY_LEFT_CONTROL},
                                                          {"ControlRight", GLFW_KEY_RIGHT_CONTROL},
                                                          {"AltLeft", GLFW_KEY_LEFT_ALT},
                                                          {"AltRight", GLFW_KEY_RIGHT_ALT},
                                                          {"MetaLeft", GLFW_KEY_LEFT_SUPER},
                                                          {"MetaRight", GLFW_KEY_RIGHT_SUPER}};
    return codes;
}

}  // namespace

std::optional<int> key_of_code(std::string_view code) {
    const auto found = named_codes().find(code);
    if (found != named_codes().end()) return found->second;
    const auto ends_in = [&](std::string_view begin, char first, char last) {
        return code.size() == begin.size() + 1 && code.starts_with(begin) && code.back() >= first &&
               code.back() <= last;
    };
    // GLFW's codes of letters and digits are their ASCII ones.
    if (ends_in("Key", 'A', 'Z') || ends_in("Digit", '0', '9')) return code.back();
    if (ends_in("Numpad", '0', '9')) return GLFW_KEY_KP_0 + (code.back() - '0');
    if (ends_in("F", '1', '9')) return GLFW_KEY_F1 + (code.back() - '1');
    if (ends_in("F1", '0', '2')) return GLFW_KEY_F10 + (code.back() - '0');
    return std::nullopt;
}

}  // namespace kilolux
