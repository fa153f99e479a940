// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/second_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/live/scene_comparison.h"
#include "app/live/scene_selection.h"
#include "app/scene/side_difference.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "app/window/viewport/viewport_text.h"
#include "render/text/label_layout.h"

namespace mercury::window {
namespace {

// In meters, centimeters or millimeters, with a sign.
std::string signed_length(double meters, const char* per = "") {
  const double size = std::abs(meters);
  if (size < 0.01) return fmt::format("{:+.1f} mm{}", 1000 * meters, per);
  if (size < 1) return fmt::format("{:+.1f} cm{}", 100 * meters, per);
  return fmt::format("{:+.2f} m{}", meters, per);
}

// Text with a background, centered below `at`. Returns its lower edge.
float centered(ImVec2 at, const std::string& text, ImU32 color, EventLog& log, const std::string& name) {
  const float font = ImGui::GetFontSize(), margin = 0.4f * font;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const ImVec2 low{at.x - size.x / 2 - margin, at.y}, high{at.x + size.x / 2 + margin, at.y + size.y + margin};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(low, high, palette().on_view, 0.35f * font);
  list.AddText({low.x + margin, low.y + margin / 2}, color, text.c_str());
  log.item(name, low, high);
  return high.y;
}

// The middle of a box in the view, and the lowest of its corners.
struct Place {
  float x = 0, low = 0;
};
Place place_of(const render::Bounds& box, const ViewportArea& area, const render::Camera& camera) {
  const int width = static_cast<int>(area.width()), height = static_cast<int>(area.height());
  Place place{camera.project(box.center(), width, height).x, 0};
  for (int corner = 0; corner < 8; ++corner) {
    const render::Vector3 at((corner & 1) ? box.high.x : box.low.x, (corner & 2) ? box.high.y : box.low.y,
                             (corner & 4) ? box.high.z : box.low.z);
    place.low = std::max(place.low, camera.project(at, width, height).y);
  }
  return place;
}

// Where a text of this size goes without covering earlier ones: at `wanted`, or below.
ViewportArea free_place(ImVec2 wanted, ImVec2 size, const ViewportArea& area, std::vector<ViewportArea>& taken) {
  wanted.x =
      std::clamp(wanted.x, std::min(area.low.x, area.high.x - size.x), std::max(area.low.x, area.high.x - size.x));
  wanted.y = std::clamp(wanted.y, area.low.y, std::max(area.low.y, area.high.y - size.y));
  ViewportArea place{wanted, {wanted.x + size.x, wanted.y + size.y}};
  for (bool moved = true; moved;) {
    moved = false;
    for (const ViewportArea& other : taken) {
      const bool apart = place.high.x <= other.low.x || other.high.x <= place.low.x || place.high.y <= other.low.y ||
                         other.high.y <= place.low.y;
      if (apart) continue;
      place = {{place.low.x, other.high.y}, {place.high.x, other.high.y + size.y}};
      moved = true;
    }
  }
  taken.push_back(place);
  return place;
}

}  // namespace

Halves halves_of(const ViewportArea& area) {
  constexpr float gap = 2;  // [pixels]
  const float middle = std::round((area.low.x + area.high.x) / 2);
  return {{area.low, {middle - gap / 2, area.high.y}}, {{middle + gap / 2, area.low.y}, area.high}};
}

float draw_side_titles(const LiveScene& scene, const Halves& halves, EventLog& log) {
  const Snapshot& snapshot = scene.snapshot();
  if (!snapshot.second) return 0;
  auto [first, second] = differences(snapshot.configuration, snapshot.second->configuration);
  if (first.empty()) first = second = "no difference";
  const float font = ImGui::GetFontSize();
  const ImU32 color = ImGui::GetColorU32(ImGuiCol_Text);
  float low = 0;
  const auto title = [&](const ViewportArea& half, const std::string& text, const char* name) {
    const float middle = (half.low.x + half.high.x) / 2;
    low = centered({middle, half.low.y + 0.5f * font}, shortened(text, half.width() - 2 * font), color, log, name);
  };
  title(halves.first, first, "title.first");
  title(halves.second, second, "title.second");
  ImGui::GetBackgroundDrawList()->AddRectFilled({halves.first.high.x, halves.first.low.y},
                                                {halves.second.low.x, halves.second.high.y}, palette().accent);
  return low - halves.first.low.y;
}

std::string text_of(const GhostFigures& figures) {
  const char* other = figures.of_parent ? "its parent" : "itself unchanged";
  if (figures.ghost_exploded) return fmt::format("{} exploded", figures.of_parent ? "its parent" : "unchanged, it");
  const double farther = figures.robot_distance - figures.ghost_distance;
  if (farther == 0 && !figures.of_parent) return "as it was";
  std::string text = signed_length(farther);
  if (figures.ghost_distance > 1e-6) text += fmt::format(" ({:+.0f} %)", 100 * farther / figures.ghost_distance);
  text += fmt::format("\n{} to {}", signed_length(figures.robot_speed - figures.ghost_speed, "/s"), other);
  if (!figures.same_age) text += fmt::format(" at {:.1f} s", figures.age);
  return text;
}

void draw_ghost_figures(LiveScene& scene, const ViewportArea& area, float top, const render::Camera& camera,
                        EventLog& log) {
  const ViewportArea free{{area.low.x, area.low.y + top}, area.high};
  const auto boxes = scene.drawn().last_boxes();
  const float font = ImGui::GetFontSize();
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(area.low, area.high);
  std::vector<ViewportArea> taken;
  for (const GhostFigures& figures : scene.comparison().ghost_figures()) {
    const auto robot = scene.snapshot().robots->index_of(figures.robot);
    if (!robot || *robot >= boxes.size() || boxes[*robot].empty() || scene.selection().is_hidden(figures.robot))
      continue;
    if (!render::covered_by(boxes[*robot], camera, static_cast<int>(area.width()), static_cast<int>(area.height())))
      continue;
    const Place place = place_of(boxes[*robot], area, camera);
    const std::string text = text_of(figures);
    const ImVec2 bare = ImGui::CalcTextSize(text.c_str()), size{bare.x + 0.8f * font, bare.y + 0.4f * font};
    const ViewportArea at =
        free_place({area.low.x + place.x - size.x / 2, area.low.y + place.low + 0.2f * font}, size, free, taken);
    centered({(at.low.x + at.high.x) / 2, at.low.y}, text, ImGui::GetColorU32(ImGuiCol_Text), log,
             fmt::format("ghost.{}", *robot));
  }
  list.PopClipRect();
}

ViewportArea SecondView::split(LiveScene& scene, const ViewportArea& whole) {
  const bool two = scene.comparison().second_drawn() != nullptr;
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

void SecondView::place(ImVec2 scale) {
  if (!area_ || !viewport_) return;
  viewport_->place(static_cast<int>(area_->low.x * scale.x), static_cast<int>(area_->low.y * scale.y),
                   static_cast<int>(area_->width() * scale.x), static_cast<int>(area_->height() * scale.y));
}

bool SecondView::update(LiveScene& scene, render::Quality quality) {
  if (!area_) return false;
  if (!viewport_) {
    viewport_.emplace(gl_context_, quality);
    revision_ = 0;
    place(ImGui::GetIO().DisplayFramebufferScale);
  }
  if (viewport_->renderer().quality() != quality) viewport_->renderer().set_quality(quality);
  const DrawnScene& drawn = *scene.comparison().second_drawn();
  if (revision_ == drawn.bodies_revision()) return false;
  drawn.set_bodies(viewport_->renderer());
  revision_ = drawn.bodies_revision();
  return true;
}

void SecondView::draw(LiveScene& scene, const render::Camera& camera, bool moving) {
  if (viewport_) viewport_->draw(without_text(scene.comparison().second_drawn()->scene()), camera, moving);
}

void SecondView::finish() {
  if (viewport_) viewport_->finish();
}

void SecondView::present(int framebuffer_height) const {
  if (viewport_) viewport_->present(framebuffer_height);
}

}  // namespace mercury::window
