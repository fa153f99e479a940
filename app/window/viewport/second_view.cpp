// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/second_view.h"

#include "app/window/viewport/comparison_view.h"
#include "app/window/viewport/viewport_text.h"

namespace mercury::window {

ViewportArea SecondView::split(LiveScene& scene, const ViewportArea& whole) {
  const bool two = scene.second_picture() != nullptr;
  changed_ = two != area_.has_value();
  area_.reset();
  if (!two) {
    viewport_.reset();
    return whole;
  }
  const Halves halves = halves_of(whole);
  area_ = halves.second;
  return halves.first;
}

bool SecondView::update(LiveScene& scene, render::Quality quality, ImVec2 scale) {
  if (!area_) return false;
  if (!viewport_) {
    viewport_.emplace(gl_context_, quality);
    revision_ = 0;
  }
  viewport_->place(static_cast<int>(area_->low.x * scale.x), static_cast<int>(area_->low.y * scale.y),
                   static_cast<int>(area_->width() * scale.x), static_cast<int>(area_->height() * scale.y));
  if (viewport_->renderer().quality() != quality) viewport_->renderer().set_quality(quality);
  const LivePicture& picture = *scene.second_picture();
  if (revision_ == picture.bodies_revision()) return false;
  picture.set_bodies(viewport_->renderer());
  revision_ = picture.bodies_revision();
  return true;
}

void SecondView::draw(LiveScene& scene, const render::Camera& camera, bool moving) {
  if (viewport_) viewport_->draw(without_text(scene.second_picture()->scene()), camera, moving);
}

void SecondView::present(int framebuffer_height) const {
  if (viewport_) viewport_->present(framebuffer_height);
}

}  // namespace mercury::window
