// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/gui.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace kilolux {
namespace {

constexpr float kFontPixels = 15.0f;

// DejaVu Sans where distributions put it, else the built-in font.
void load_font(float scale) {
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    const float size = std::round(kFontPixels * scale);
    for (const char* file :
         {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf",
          "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf"}) {
        std::error_code error;
        if (std::filesystem::is_regular_file(file, error) &&
            fonts.AddFontFromFileTTF(file, size) != nullptr) {
            return;
        }
    }
    ImFontConfig config;
    config.SizePixels = std::round(13.0f * scale);
    fonts.AddFontDefault(&config);
}

struct ThemeColor {
    ImGuiCol_ color;
    float value;
    float alpha;
};

constexpr ThemeColor kGrays[] = {
    {ImGuiCol_WindowBg, 0.085f, 0.97f},     {ImGuiCol_PopupBg, 0.10f, 0.98f},
    {ImGuiCol_Border, 0.24f, 0.6f},         {ImGuiCol_FrameBg, 0.17f, 1.0f},
    {ImGuiCol_FrameBgHovered, 0.23f, 1.0f}, {ImGuiCol_FrameBgActive, 0.27f, 1.0f},
    {ImGuiCol_Header, 0.20f, 1.0f},         {ImGuiCol_HeaderHovered, 0.26f, 1.0f},
    {ImGuiCol_HeaderActive, 0.30f, 1.0f},   {ImGuiCol_Button, 0.24f, 1.0f},
    {ImGuiCol_ScrollbarBg, 0.06f, 0.4f},    {ImGuiCol_Separator, 0.28f, 0.8f}};

constexpr ThemeColor kAmbers[] = {{ImGuiCol_ButtonHovered, 0.62f, 1.0f},
                                  {ImGuiCol_ButtonActive, 0.8f, 1.0f},
                                  // A slider's grip is under white digits.
                                  {ImGuiCol_SliderGrab, 0.48f, 1.0f},
                                  {ImGuiCol_SliderGrabActive, 0.56f, 1.0f},
                                  {ImGuiCol_CheckMark, 1.0f, 1.0f},
                                  {ImGuiCol_PlotHistogram, 0.9f, 1.0f}};

void set_colors() {
    ImGui::StyleColorsDark();
    ImVec4* colors = ImGui::GetStyle().Colors;
    for (const auto [color, v, alpha] : kGrays) colors[color] = {v, v, 1.06f * v, alpha};
    for (const auto [color, v, alpha] : kAmbers) {
        colors[color] = {0.95f * v, 0.66f * v, 0.24f * v, alpha};
    }
}

void set_style(float scale) {
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    set_colors();
    style.WindowPadding = {12.0f, 10.0f};
    style.FramePadding = {7.0f, 3.0f};
    style.ItemSpacing = {8.0f, 5.0f};
    style.FrameRounding = 4.0f;
    style.GrabRounding = 4.0f;
    style.PopupRounding = 5.0f;
    style.WindowRounding = 0.0f;
    style.WindowBorderSize = 0.0f;
    style.GrabMinSize = 12.0f;
    style.ScrollbarSize = 12.0f;
    style.ScaleAllSizes(scale);
}

struct KeyPair {
    ImGuiKey_ gui;
    int glfw;
};

// The keys that text fields know.
constexpr KeyPair kKeys[] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                             {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                             {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                             {ImGuiKey_UpArrow, GLFW_KEY_UP},
                             {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                             {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                             {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                             {ImGuiKey_Home, GLFW_KEY_HOME},
                             {ImGuiKey_End, GLFW_KEY_END},
                             {ImGuiKey_Insert, GLFW_KEY_INSERT},
                             {ImGuiKey_Delete, GLFW_KEY_DELETE},
                             {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                             {ImGuiKey_Space, GLFW_KEY_SPACE},
                             {ImGuiKey_Enter, GLFW_KEY_ENTER},
                             {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                             {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
                             {ImGuiKey_A, GLFW_KEY_A},
                             {ImGuiKey_C, GLFW_KEY_C},
                             {ImGuiKey_V, GLFW_KEY_V},
                             {ImGuiKey_X, GLFW_KEY_X},
                             {ImGuiKey_Y, GLFW_KEY_Y},
                             {ImGuiKey_Z, GLFW_KEY_Z}};

Cursor cursor_of(ImGuiMouseCursor cursor) {
    switch (cursor) {
        case ImGuiMouseCursor_TextInput:
            return Cursor::text;
        case ImGuiMouseCursor_ResizeNS:
            return Cursor::vertical;
        case ImGuiMouseCursor_ResizeEW:
            return Cursor::horizontal;
        case ImGuiMouseCursor_Hand:
            return Cursor::hand;
        default:
            return Cursor::arrow;
    }
}

void take_key(const KeyEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    if (event.key < 0 || event.key >= IM_ARRAYSIZE(io.KeysDown)) return;
    if (event.action != GLFW_REPEAT) io.KeysDown[event.key] = event.action == GLFW_PRESS;
    const auto either = [&io](int a, int b) { return io.KeysDown[a] || io.KeysDown[b]; };
    io.KeyCtrl = either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
    io.KeyShift = either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
    io.KeyAlt = either(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
    io.KeySuper = either(GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER);
}

}  // namespace

Gui::Gui(Screen& screen) : screen_(screen) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // the program keeps its own settings
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    io.BackendFlags |= ImGuiBackendFlags_HasMouseCursors;
    for (const auto [gui, glfw] : kKeys) io.KeyMap[gui] = glfw;
    install_callbacks();
    ImGui_ImplOpenGL3_Init("#version 450");
    fit_fonts();
}

Gui::~Gui() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

void Gui::install_callbacks() {
    ImGuiIO& io = ImGui::GetIO();
    io.ClipboardUserData = this;
    io.SetClipboardTextFn = [](void* gui, const char* text) {
        static_cast<Gui*>(gui)->screen_.set_clipboard(text);
    };
    io.GetClipboardTextFn = [](void* gui) {
        Gui& self = *static_cast<Gui*>(gui);
        self.clipboard_ = self.screen_.clipboard();
        return self.clipboard_.c_str();
    };
}

// Loads the fonts for the screen's density. A page can move to a screen of another one.
void Gui::fit_fonts() {
    const float scale = screen_.content_scale();
    if (scale == scale_) return;
    const bool first = scale_ == 0.0f;
    scale_ = scale;
    ImGui::GetIO().Fonts->Clear();
    load_font(scale);
    set_style(scale);
    if (first) return;  // the first frame makes the texture
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Gui::take(const InputEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
        take_key(*key);
    } else if (const auto* text = std::get_if<TextEvent>(&event)) {
        io.AddInputCharacter(text->code_point);
    } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
        io.MouseWheelH += static_cast<float>(wheel->x);
        io.MouseWheel += static_cast<float>(wheel->y);
    } else if (const auto* focus = std::get_if<FocusEvent>(&event)) {
        io.AddFocusEvent(focus->focused);
    }
}

void Gui::begin(const InputState& input, std::optional<double> seconds) {
    fit_fonts();
    ImGui_ImplOpenGL3_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    const auto size = screen_.size(), pixels = screen_.framebuffer();
    io.DisplaySize = {static_cast<float>(size[0]), static_cast<float>(size[1])};
    if (size[0] > 0 && size[1] > 0) {
        io.DisplayFramebufferScale = {static_cast<float>(pixels[0]) / io.DisplaySize.x,
                                      static_cast<float>(pixels[1]) / io.DisplaySize.y};
    }
    io.MousePos = {static_cast<float>(input.mouse().x), static_cast<float>(input.mouse().y)};
    for (std::size_t i = 0; i < InputState::kButtons; ++i) {
        io.MouseDown[i] = input.was_button_down(i);
    }
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> measured = now - std::exchange(last_frame_, now);
    // Dear ImGui takes no frame of length 0.
    io.DeltaTime = static_cast<float>(std::max(seconds.value_or(measured.count()), 1e-6));
    screen_.set_cursor(cursor_of(ImGui::GetMouseCursor()));
    ImGui::NewFrame();
}

void Gui::draw() {
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Gui::skip() { ImGui::EndFrame(); }

bool Gui::wants_mouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool Gui::wants_keys() const { return ImGui::GetIO().WantTextInput; }

}  // namespace kilolux
