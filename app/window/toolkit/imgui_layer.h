// SPDX-License-Identifier: Apache-2.0
// Dear ImGui in a window: its context, fonts and style.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/window/toolkit/window.h"
#include "render/scene.h"

struct ImDrawList;
struct ImFont;

namespace mercury::window {

// Only one can exist at a time. The window must outlive it.
class ImGuiLayer {
 public:
  // `layout_file`: where ImGui keeps positions and sizes of floating windows; empty = nowhere.
  ImGuiLayer(Window& window, const std::filesystem::path& layout_file);
  ~ImGuiLayer();
  ImGuiLayer(const ImGuiLayer&) = delete;
  ImGuiLayer& operator=(const ImGuiLayer&) = delete;

  // Applied in the next frame. `text_scale`: 1 = the size that suits the screen.
  void set_appearance(render::Theme theme, float text_scale);

  // Starts a frame that receives these events.
  void begin_frame(const std::vector<InputEvent>& events);
  // Ends the frame. Returns whether it looks other than the last one that was drawn.
  bool end_frame();
  void draw();  // over the window's framebuffer, after end_frame()
  // Draws something more over the window's framebuffer, after draw().
  void draw_on_top(const std::function<void(ImDrawList& list)>& draw);
  // Ends the frame without drawing it.
  void discard_frame();

 private:
  void build_fonts();
  void feed(const InputEvent& event);

  Window& window_;
  std::string layout_file_;
  render::Theme theme_ = render::Theme::dark;
  float text_scale_ = 1, screen_scale_ = 0;
  bool changed_ = true;
  std::uint64_t frame_ = 0, drawn_ = 0;  // hashes of what the frame and the last drawn one look like
  float last_seconds_ = 0;               // of the last frame
  struct {
    float x = 0, y = 0;
    bool inside = false;
    std::array<bool, 5> down{};
  } pointer_;
};

// A font for large text. Valid while an ImGuiLayer exists.
ImFont* large_font();

}  // namespace mercury::window
