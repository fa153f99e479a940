// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/viewport.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mercury/stopwatch.h"

namespace mercury::window {
namespace {

constexpr double slow = 0.045, fast = 0.015;  // time per frame [s]
constexpr std::array<float, 3> shares{1, 0.75f, 0.5f};

}  // namespace

ImVec2 on_screen(const ViewportArea& area, const render::Camera& camera, const render::Vector3& point) {
  const render::Vector3 p = camera.project(point, static_cast<int>(area.width()), static_cast<int>(area.height()));
  return {area.low.x + p.x, area.low.y + p.y};
}

Viewport::Viewport(render::Context& gl_context, render::Quality quality)
    : renderer_(gl_context, {.width = 64, .height = 64, .quality = quality}), software_(gl_context.is_software()) {
  if (software_) moving_share_ = shares[2];
}

void Viewport::place(int x, int y, int width, int height) {
  x_ = x;
  y_ = y;
  width_ = std::max(16, width);
  height_ = std::max(16, height);
}

// During motion, steps to a lower or higher resolution if the last frame was too slow or fast.
void Viewport::adapt(bool moving) {
  if (!moving) {
    share_ = 1;
    return;
  }
  if (share_ == moving_share_ && draw_seconds_ > 0) {
    const auto now = std::find(shares.begin(), shares.end(), moving_share_);
    if (draw_seconds_ > slow && now + 1 != shares.end()) moving_share_ = *(now + 1);
    if (draw_seconds_ < fast && now != shares.begin()) moving_share_ = *(now - 1);
  }
  share_ = moving_share_;
}

void Viewport::draw(const render::Scene& scene, const render::Camera& camera, bool moving) {
  adapt(moving);
  begun_ = wall_now();
  const int width = std::max(16, static_cast<int>(std::lround(share_ * static_cast<float>(width_))));
  const int height = std::max(16, static_cast<int>(std::lround(share_ * static_cast<float>(height_))));
  if (width != renderer_.width() || height != renderer_.height()) renderer_.resize(width, height);
  renderer_.draw(scene, camera);
  glFlush();
  drawing_ = true;
}

void Viewport::finish() {
  if (!std::exchange(drawing_, false)) return;
  glFinish();
  draw_seconds_ = wall_now() - begun_;
}

void Viewport::present(int framebuffer_height) const {
  renderer_.present(0, x_, framebuffer_height - y_ - height_, width_, height_);
}

}  // namespace mercury::window
