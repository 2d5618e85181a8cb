// SPDX-License-Identifier: Apache-2.0
#include "present/window/panel/gui.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>

#include <cmath>
#include <filesystem>

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

}  // namespace

Gui::Gui(const Window& window) : window_(window), scale_(window.content_scale()) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // the program keeps its own settings
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    load_font(scale_);
    set_style(scale_);
    ImGui_ImplGlfw_InitForOpenGL(window.handle(), false);
    ImGui_ImplOpenGL3_Init("#version 450");
}

Gui::~Gui() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void Gui::take(const InputEvent& event) {
    GLFWwindow* window = window_.handle();
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
        ImGui_ImplGlfw_KeyCallback(window, key->key, key->scancode, key->action, key->modifiers);
    } else if (const auto* text = std::get_if<TextEvent>(&event)) {
        ImGui_ImplGlfw_CharCallback(window, text->code_point);
    } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
        ImGui_ImplGlfw_MouseButtonCallback(window, button->button, button->action,
                                           button->modifiers);
    } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
        ImGui_ImplGlfw_ScrollCallback(window, wheel->x, wheel->y);
    } else if (const auto* focus = std::get_if<FocusEvent>(&event)) {
        ImGui_ImplGlfw_WindowFocusCallback(window, focus->focused ? 1 : 0);
    }
}

void Gui::begin(const InputState& input, std::optional<double> seconds) {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    // The backend would ask the window system for the mouse. Ours comes from events, also a
    // script's.
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {static_cast<float>(input.mouse().x), static_cast<float>(input.mouse().y)};
    for (std::size_t i = 0; i < InputState::kButtons; ++i) {
        io.MouseDown[i] = input.was_button_down(i);
    }
    if (seconds) io.DeltaTime = static_cast<float>(*seconds);
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
