// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/theme.h"

namespace mercury::window {
namespace {

Palette chosen{};

ImVec4 hex(unsigned rgb, float alpha = 1) {
  return {static_cast<float>(rgb >> 16 & 255) / 255, static_cast<float>(rgb >> 8 & 255) / 255,
          static_cast<float>(rgb & 255) / 255, alpha};
}

// The colors that differ between the themes. All others derive from them.
struct BaseColors {
  unsigned panel, raised, hovered, pressed, line, text, faint, accent, on_accent;
};
constexpr BaseColors dark_colors{0x141a21, 0x222b35, 0x2e3a47, 0x3a4a5a, 0x33404d,
                                 0xe8edf2, 0x93a1af, 0x2f9fd6, 0xffffff};
constexpr BaseColors light_colors{0xf7f9fa, 0xe4e9ee, 0xd4dce4, 0xc2cdd8, 0xc6d0d9,
                                  0x17202a, 0x5b6875, 0x1b7fb5, 0xffffff};

void set_spacing(ImGuiStyle& style, float scale) {
  style = ImGuiStyle();
  style.WindowPadding = {12, 10};
  style.FramePadding = {8, 5};
  style.ItemSpacing = {8, 7};
  style.ItemInnerSpacing = {6, 5};
  style.CellPadding = {6, 3};
  style.IndentSpacing = 14;
  style.ScrollbarSize = 12;
  style.GrabMinSize = 12;
  style.WindowRounding = 7;
  style.ChildRounding = 5;
  style.FrameRounding = 5;
  style.PopupRounding = 6;
  style.ScrollbarRounding = 6;
  style.GrabRounding = 5;
  style.TabRounding = 5;
  style.WindowBorderSize = 1;
  style.FrameBorderSize = 0;
  style.TabBorderSize = 0;
  style.PopupBorderSize = 1;
  style.WindowTitleAlign = {0.02f, 0.5f};
  style.WindowMenuButtonPosition = ImGuiDir_None;
  style.ScaleAllSizes(scale);
}

void set_colors(ImGuiStyle& style, const BaseColors& base) {
  ImVec4* colors = style.Colors;
  const ImVec4 accent = hex(base.accent);
  colors[ImGuiCol_Text] = hex(base.text);
  colors[ImGuiCol_TextDisabled] = hex(base.faint);
  colors[ImGuiCol_WindowBg] = hex(base.panel, 0.97f);
  colors[ImGuiCol_ChildBg] = hex(base.panel, 0);
  colors[ImGuiCol_PopupBg] = hex(base.panel, 0.99f);
  colors[ImGuiCol_Border] = hex(base.line);
  colors[ImGuiCol_FrameBg] = hex(base.raised);
  colors[ImGuiCol_FrameBgHovered] = hex(base.hovered);
  colors[ImGuiCol_FrameBgActive] = hex(base.pressed);
  colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgActive] = hex(base.raised);
  colors[ImGuiCol_TitleBgCollapsed] = hex(base.raised);
  colors[ImGuiCol_MenuBarBg] = hex(base.panel);
  colors[ImGuiCol_ScrollbarBg] = hex(base.panel, 0);
  colors[ImGuiCol_ScrollbarGrab] = hex(base.hovered);
  colors[ImGuiCol_ScrollbarGrabHovered] = colors[ImGuiCol_ScrollbarGrabActive] = hex(base.pressed);
  colors[ImGuiCol_CheckMark] = accent;
  colors[ImGuiCol_SliderGrab] = hex(base.accent, 0.5f);  // translucent: a number may be under it
  colors[ImGuiCol_SliderGrabActive] = hex(base.accent, 0.7f);
  colors[ImGuiCol_Button] = hex(base.raised);
  colors[ImGuiCol_ButtonHovered] = hex(base.hovered);
  colors[ImGuiCol_ButtonActive] = hex(base.pressed);
  colors[ImGuiCol_Header] = hex(base.accent, 0.28f);
  colors[ImGuiCol_HeaderHovered] = hex(base.accent, 0.20f);
  colors[ImGuiCol_HeaderActive] = hex(base.accent, 0.38f);
  colors[ImGuiCol_Separator] = hex(base.line);
  colors[ImGuiCol_SeparatorHovered] = colors[ImGuiCol_SeparatorActive] = accent;
  colors[ImGuiCol_ResizeGrip] = hex(base.hovered, 0.6f);
  colors[ImGuiCol_ResizeGripHovered] = colors[ImGuiCol_ResizeGripActive] = accent;
  colors[ImGuiCol_Tab] = hex(base.panel);
  colors[ImGuiCol_TabHovered] = hex(base.hovered);
  colors[ImGuiCol_TabActive] = hex(base.pressed);
  colors[ImGuiCol_TabUnfocused] = hex(base.panel);
  colors[ImGuiCol_TabUnfocusedActive] = hex(base.hovered);
  colors[ImGuiCol_PlotHistogram] = colors[ImGuiCol_PlotLines] = accent;
  colors[ImGuiCol_TableHeaderBg] = hex(base.raised);
  colors[ImGuiCol_TableBorderStrong] = colors[ImGuiCol_TableBorderLight] = hex(base.line);
  colors[ImGuiCol_TableRowBgAlt] = hex(base.raised, 0.35f);
  colors[ImGuiCol_TextSelectedBg] = hex(base.accent, 0.4f);
  colors[ImGuiCol_DragDropTarget] = accent;
  colors[ImGuiCol_NavHighlight] = accent;
  colors[ImGuiCol_ModalWindowDimBg] = hex(0x000000, 0.45f);
}

}  // namespace

void apply_theme(render::Theme theme, float scale) {
  const bool dark = theme == render::Theme::dark;
  const BaseColors& base = dark ? dark_colors : light_colors;
  ImGuiStyle& style = ImGui::GetStyle();
  set_spacing(style, scale);
  set_colors(style, base);
  chosen.accent = ImGui::GetColorU32(hex(base.accent));
  chosen.accent_hovered = ImGui::GetColorU32(hex(dark ? 0x46b1e6 : 0x2b90c8));
  chosen.good = ImGui::GetColorU32(hex(dark ? 0x4cc38a : 0x1c7f4d));
  chosen.warning = ImGui::GetColorU32(hex(dark ? 0xe9b44c : 0x9a6700));
  chosen.bad = ImGui::GetColorU32(hex(dark ? 0xf0705f : 0xc2301f));
  chosen.faint = ImGui::GetColorU32(hex(base.faint));
  chosen.grid = ImGui::GetColorU32(hex(base.line, 0.7f));
  chosen.panel = ImGui::GetColorU32(hex(base.panel));
  chosen.on_view = ImGui::GetColorU32(hex(base.panel, 0.88f));
  chosen.mark = ImGui::GetColorU32(hex(dark ? 0xffe14a : 0xd1006c));
  chosen.mark_outline = ImGui::GetColorU32(hex(dark ? 0x14060a : 0xffffff, 0.9f));
}

ImVec4 panel_background() {
  const ImVec4 panel = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
  const float dark = 1 - panel.w;  // of what is behind panels, which shines through a little
  return {panel.w * panel.x + dark * 0.08f, panel.w * panel.y + dark * 0.10f, panel.w * panel.z + dark * 0.13f, 1};
}

const Palette& palette() { return chosen; }

}  // namespace mercury::window
