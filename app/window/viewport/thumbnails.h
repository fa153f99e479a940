// SPDX-License-Identifier: Apache-2.0
// Small pictures of robots, drawn with the OpenGL context of the window.
#pragma once

#include <imgui.h>

#include <map>
#include <string>

#include "mercury/robot.h"
#include "render/gl_objects.h"
#include "render/renderer.h"

namespace mercury::window {

class Thumbnails {
 public:
  explicit Thumbnails(render::Context& gl_context) : gl_context_(gl_context) {}

  // The picture with this name; 0 until it is drawn.
  ImTextureID find(const std::string& name) const;
  // Draws a picture; replaces an earlier one with this name.
  void draw(const std::string& name, const Robot& robot, render::Theme theme);
  void clear() { pictures_.clear(); }

  static constexpr int width = 192, height = 144;  // [pixels]

 private:
  render::Context& gl_context_;
  std::unique_ptr<render::Renderer> renderer_;  // created with the first picture
  std::map<std::string, render::Texture> pictures_;
};

}  // namespace mercury::window
