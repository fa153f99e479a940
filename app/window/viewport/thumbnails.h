// SPDX-License-Identifier: Apache-2.0
// Small thumbnails of robots, drawn with the OpenGL context of the window: a few per frame, and only of what a panel
// shows.
#pragma once

#include <imgui.h>

#include <functional>
#include <memory>
#include <string>

#include "mercury/robot.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace mercury::window {

class Thumbnails {
 public:
  explicit Thumbnails(render::Context& gl_context);
  ~Thumbnails();

  // The robot of a thumbnail; null if it is not there yet, without masses if it never will be.
  using Source = std::function<std::shared_ptr<const Robot>()>;

  // The thumbnail with this name; 0 until it is drawn. Call it in each frame in which it is on the screen.
  ImTextureID find(const std::string& name, const Source& robot);
  // Draws thumbnails that were looked for and not found since the last call: one, and more for about `seconds`.
  void work(render::Theme theme, double seconds);
  bool busy() const;

  static constexpr int width = 192, height = 144;  // [pixels]
  static constexpr std::size_t most = 400;         // thumbnails that are kept, those that were looked for last

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// A row of a list or table with a thumbnail at its left and a text beside it, of thumbnail_row_height(). Returns true
// when it was clicked.
bool thumbnail_row(const char* id, ImTextureID thumbnail, const std::string& text, bool selected,
                   ImGuiSelectableFlags flags = 0);
float thumbnail_row_height();  // [pixels]
// Text at the right edge of another cell of such a row.
void thumbnail_row_cell(const std::string& text);

// Draws a thumbnail of find() in a rectangle of ImGui's window, and an empty frame as long as there is none.
void draw_thumbnail(ImTextureID thumbnail, ImVec2 low, ImVec2 high, ImDrawFlags corners = ImDrawFlags_RoundCornersAll);

}  // namespace mercury::window
