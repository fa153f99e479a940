// SPDX-License-Identifier: Apache-2.0
// Dear ImGui in a window: its context, fonts and looks.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "app/window/toolkit/window.h"
#include "render/scene.h"

struct ImFont;

namespace mercury::window {

// One at a time; the window must outlive it.
class ImGuiLayer {
 public:
  // `layout_file`: where sizes and places of what floats are kept; empty = nowhere.
  ImGuiLayer(Window& window, const std::filesystem::path& layout_file);
  ~ImGuiLayer();
  ImGuiLayer(const ImGuiLayer&) = delete;
  ImGuiLayer& operator=(const ImGuiLayer&) = delete;

  // Takes hold in the next frame. `text_scale`: 1 = as the screen suggests.
  void set_appearance(render::Theme theme, float text_scale);

  // With what the user did for it.
  void begin_frame(const std::vector<InputEvent>& events);
  void end_frame();      // draws it over the window's framebuffer
  void discard_frame();  // or does not draw it

 private:
  void build_fonts();
  void feed(const InputEvent& event);

  Window& window_;
  std::string layout_file_;
  render::Theme theme_ = render::Theme::dark;
  float text_scale_ = 1, screen_scale_ = 0;
  bool changed_ = true;
  struct {
    float x = 0, y = 0;
    bool inside = false;
    std::array<bool, 5> down{};
  } pointer_;
};

// Valid between frames of the interface.
ImFont* large_font();

}  // namespace mercury::window
