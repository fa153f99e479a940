// SPDX-License-Identifier: Apache-2.0
// Small pictures of robots, drawn with the OpenGL context of the window.
#pragma once

#include <imgui.h>

#include <memory>
#include <string>

#include "mercury/robot.h"
#include "render/renderer.h"

namespace mercury::window {

class Thumbnails {
 public:
  explicit Thumbnails(render::Context& gl_context);
  ~Thumbnails();

  // A picture by its name; 0 until it is drawn.
  ImTextureID find(const std::string& name) const;
  // Draws a picture; replaces an earlier one with this name.
  void draw(const std::string& name, const Robot& robot, render::Theme theme);
  void clear();

  static constexpr int width = 192, height = 144;  // [pixels]

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury::window
