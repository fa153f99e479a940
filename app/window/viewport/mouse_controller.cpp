// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/mouse_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/live/picking.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_selection.h"
#include "app/window/toolkit/theme.h"
#include "app/window/viewport/marks.h"
#include "mercury/stopwatch.h"

namespace mercury::window {
namespace {

constexpr double details_delay = 0.25;  // the pointer rests this long before details appear [s]
constexpr double mark_delay = 0.05;     // the same for its name and for marks [s]
constexpr double pick_period = 0.05;    // between two looks at what is under a mouse that rests [s]
constexpr double pick_share = 0.1;      // of the time, for looking what is under a mouse that rests
constexpr float wheel_factor = 0.88f;   // of the distance to the target, per notch
constexpr float push_speed = 2;         // of a push, per length of its arrow [1/s]

render::Ray ray_at(const ViewportArea& area, const render::Camera& camera, ImVec2 p) {
  return camera.ray(p.x - area.low.x, p.y - area.low.y, static_cast<int>(area.width()),
                    static_cast<int>(area.height()));
}

render::Vector3 forward_of(const render::Camera& camera) { return (camera.target - camera.eye).normalized(); }

std::string force_text(float newtons) {
  return newtons >= 1000 ? fmt::format("{:.3g} kN", newtons / 1000) : fmt::format("{:.3g} N", newtons);
}

void label(ImVec2 at, const std::string& text) {
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float margin = 0.4f * ImGui::GetFontSize();
  list.AddRectFilled({at.x - margin, at.y - margin / 2}, {at.x + size.x + margin, at.y + size.y + margin / 2},
                     palette().on_view, margin);
  list.AddText(at, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
}

}  // namespace

void MouseController::update(const ViewportArea& area, const render::Camera& camera) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool free = !io.WantCaptureMouse && area.holds(io.MousePos);
  if (drag_ == Drag::none && free) press(area, camera);
  if (drag_ != Drag::none) {
    drag(area, camera);
    if (!ImGui::IsMouseDown(button_)) release(area, camera);
  }
  if (free && io.MouseWheel != 0) {
    camera_.zoom(std::pow(wheel_factor, io.MouseWheel));
    used_.zoomed = true;
  }
  if (drag_ == Drag::none && free)
    hover(area, camera);
  else
    hovered_.reset();
}

void MouseController::press(const ViewportArea& area, const render::Camera& camera) {
  const ImGuiIO& io = ImGui::GetIO();
  for (int button = 0; button < 3; ++button) {
    if (!ImGui::IsMouseClicked(button)) continue;
    button_ = button;
    dragged_ = false;
    pressed_at_ = io.MousePos;
    follows_ = button == 0 && ImGui::IsMouseDoubleClicked(0);
    drag_ = button == 0 ? (io.KeyShift && !io.KeyCtrl ? Drag::box : Drag::turn) : Drag::pan;
    if (button == 2 || !io.KeyCtrl) return;
    if (button == 1) {
      const std::optional<Hit> hit = scene_.mouse().pick(ray_at(area, camera, io.MousePos));
      if (!hit) return;
      drag_ = Drag::push;
      pushed_ = hit->point;
      pull_depth_ = (pushed_ - camera.eye).dot(forward_of(camera));
      return;
    }
    drag_ = Drag::pull;
    if (const std::optional<Hit> hit = scene_.mouse().pick(ray_at(area, camera, io.MousePos))) {
      pull_depth_ = (hit->point - camera.eye).dot(forward_of(camera));
      scene_.mouse().begin_perturbation(*hit);
      scene_.selection().select(hit->robot);
      log_.write("pull",
                 {{"robot", hit->robot}, {"mass", hit->mass}, {"at", {hit->point.x, hit->point.y, hit->point.z}}});
    }
    return;
  }
}

void MouseController::drag(const ViewportArea& area, const render::Camera& camera) {
  const ImGuiIO& io = ImGui::GetIO();
  const float moved = std::abs(io.MousePos.x - pressed_at_.x) + std::abs(io.MousePos.y - pressed_at_.y);
  if (moved > 4) dragged_ = true;
  if (drag_ == Drag::pull) {
    if (!scene_.mouse().perturbation()) return;
    const render::Ray ray = ray_at(area, camera, io.MousePos);
    const float along = pull_depth_ / std::max(0.05f, ray.direction.dot(forward_of(camera)));
    scene_.mouse().move_perturbation(ray.origin + along * ray.direction);
    used_.pulled = used_.pulled || dragged_;
    return;
  }
  if (drag_ == Drag::box || drag_ == Drag::push || !dragged_ || (io.MouseDelta.x == 0 && io.MouseDelta.y == 0)) return;
  const float right = io.MouseDelta.x / area.height(), up = -io.MouseDelta.y / area.height();
  (drag_ == Drag::turn ? used_.turned : used_.moved) = true;
  if (drag_ == Drag::turn) camera_.turn(right, up);
  if (drag_ == Drag::pan) camera_.pan(right, up);
}

void MouseController::release(const ViewportArea& area, const render::Camera& camera) {
  if (drag_ == Drag::pull) {
    if (const auto pull = scene_.mouse().perturbation())
      log_.write(
          "pulled",
          {{"force", pull->force}, {"at", {pull->at.x, pull->at.y, pull->at.z}}, {"stays", ImGui::GetIO().KeyShift}});
    if (ImGui::GetIO().KeyShift)
      scene_.mouse().attach_perturbation();
    else
      scene_.mouse().end_perturbation();
  } else if (drag_ == Drag::push) {
    const render::Vector3 velocity = push_speed * (pushed_to(area, camera) - pushed_);
    if (dragged_ && scene_.parameters().push({velocity.x, velocity.y, velocity.z})) {
      log_.write("push", {{"velocity", {velocity.x, velocity.y, velocity.z}}});
      toasts_.show(Tone::info, fmt::format("pushed all robots by {:.2f} m/s", velocity.norm()));
    }
  } else if (drag_ == Drag::box && dragged_) {
    select_box(area, camera);
  } else if (!dragged_) {
    click(area, camera);
  }
  drag_ = Drag::none;
}

void MouseController::click(const ViewportArea& area, const render::Camera& camera) {
  const std::optional<Hit> hit = scene_.mouse().pick(ray_at(area, camera, pressed_at_));
  if (drag_ == Drag::pan) {
    if (hit && button_ == 1 && actions_.menu) actions_.menu(*hit);
    return;
  }
  if (hit && actions_.click && actions_.click(*hit)) return;
  const bool add = ImGui::GetIO().KeyShift;
  if (!hit && !add) scene_.selection().clear();
  pinned_ = hit;
  if (hit) log_.write("pinned", {{"robot", hit->robot}, {"mass", hit->mass}});
  if (hit && add) scene_.selection().toggle(hit->robot);
  if (hit && !add) scene_.selection().select(hit->robot);
  if (hit && follows_) {
    camera_.follow(scene_.snapshot().robots->index_of(hit->robot));
    const DocumentRobot* robot = scene_.document().find(hit->robot);
    toasts_.show(Tone::info, fmt::format("following {} (G to stop)", robot ? robot->body.name : "it"));
  }
}

// Adds the robots whose middle is in the box.
void MouseController::select_box(const ViewportArea& area, const render::Camera& camera) {
  const ImVec2 end = ImGui::GetIO().MousePos;
  const ImVec2 low{std::min(pressed_at_.x, end.x), std::min(pressed_at_.y, end.y)};
  const ImVec2 high{std::max(pressed_at_.x, end.x), std::max(pressed_at_.y, end.y)};
  const std::span<const render::Bounds> bounds = scene_.mouse().pointed_drawn().bounds();
  const LiveRobots& robots = *scene_.snapshot().robots;
  std::vector<RobotId> selected = scene_.selection().robots();
  for (std::size_t i = 0; i < std::min(bounds.size(), robots.size()); ++i) {
    if (bounds[i].empty() || (bounds[i].center() - camera.eye).dot(forward_of(camera)) <= 0) continue;
    const ImVec2 at = on_screen(area, camera, bounds[i].center());
    if (at.x >= low.x && at.x <= high.x && at.y >= low.y && at.y <= high.y) selected.push_back(robots.robots[i].id);
  }
  scene_.selection().set(selected);
  log_.write("box", {{"selected", scene_.selection().robots().size()}});
}

void MouseController::hover(const ViewportArea& area, const render::Camera& camera) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.MousePos.x != last_position_.x || io.MousePos.y != last_position_.y) {
    last_position_ = io.MousePos;
    rest_time_ = next_pick_ = 0;
    hovered_.reset();
    return;
  }
  rest_time_ += static_cast<double>(io.DeltaTime);
  if (rest_time_ < mark_delay || ImGui::GetTime() < next_pick_) return;
  const double begin = wall_now();
  hovered_ = scene_.mouse().pick(ray_at(area, camera, io.MousePos));
  const double seconds = wall_now() - begin;
  next_pick_ = ImGui::GetTime() + std::max(pick_period, seconds / pick_share);
}

void MouseController::draw(const ViewportArea& area, const render::Camera& camera, bool figures) {
  draw_springs(area, camera);
  draw_pull(area, camera);
  draw_push(area, camera);
  draw_box();
  const bool stays = pinned_ && scene_.selection().contains(pinned_->robot) &&
                     scene_.mouse().pointed_snapshot().robots->index_of(pinned_->robot);
  if (!stays) pinned_.reset();
  if (!figures) return;
  if (pinned_) draw_hit_mark(scene_, *pinned_, area, camera);
  if (!hovered_) return;
  draw_hit_mark(scene_, *hovered_, area, camera);
  const bool is_pinned = pinned_ && pinned_->robot == hovered_->robot && pinned_->mass == hovered_->mass;
  if (rest_time_ >= details_delay && !is_pinned) draw_details(area);
}

std::optional<std::size_t> MouseController::hovered() const {
  return hovered_ ? scene_.snapshot().robots->index_of(hovered_->robot) : std::nullopt;
}

// Where there is ground, a push is along it.
render::Vector3 MouseController::pushed_to(const ViewportArea& area, const render::Camera& camera) const {
  const render::Ray ray = ray_at(area, camera, ImGui::GetIO().MousePos);
  const float drop = (pushed_.z - ray.origin.z) / ray.direction.z;
  if (has_ground(scene_.document().configuration.environment) && drop > 0 && std::isfinite(drop))
    return ray.origin + std::min(drop, 4 * pull_depth_) * ray.direction;
  return ray.origin + pull_depth_ / std::max(0.05f, ray.direction.dot(forward_of(camera))) * ray.direction;
}

void MouseController::draw_push(const ViewportArea& area, const render::Camera& camera) const {
  if (drag_ != Drag::push || !dragged_) return;
  const render::Vector3 to = pushed_to(area, camera);
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const ImVec2 tail = on_screen(area, camera, pushed_), tip = on_screen(area, camera, to);
  const float text = ImGui::GetFontSize(), length = std::hypot(tip.x - tail.x, tip.y - tail.y);
  if (length < 1) return;
  const ImVec2 along{0.6f * text * (tip.x - tail.x) / length, 0.6f * text * (tip.y - tail.y) / length};
  list.AddLine(tail, {tip.x - along.x, tip.y - along.y}, palette().accent, 0.2f * text);
  list.AddTriangleFilled(tip, {tip.x - 1.5f * along.x + along.y, tip.y - 1.5f * along.y - along.x},
                         {tip.x - 1.5f * along.x - along.y, tip.y - 1.5f * along.y + along.x}, palette().accent);
  label({tip.x + text, tip.y - 0.5f * text}, fmt::format("{:.2f} m/s", push_speed * (to - pushed_).norm()));
}

void MouseController::draw_pull(const ViewportArea& area, const render::Camera& camera) const {
  if (const auto pull = scene_.mouse().perturbation()) {
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const ImVec2 at = on_screen(area, camera, pull->at), target = on_screen(area, camera, pull->target);
    const float text = ImGui::GetFontSize();
    list.AddLine(at, target, palette().warning, 0.13f * text);
    list.AddCircleFilled(at, 0.28f * text, palette().warning);
    list.AddCircle(target, 0.4f * text, palette().warning, 0, 0.12f * text);
    label({target.x + text, target.y - 0.5f * text}, force_text(pull->force));
  }
}

// Springs that stay attached, and pins.
void MouseController::draw_springs(const ViewportArea& area, const render::Camera& camera) const {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float text = ImGui::GetFontSize();
  list.PushClipRect(area.low, area.high);
  for (const PerturbationDetails& spring : scene_.mouse().attachments()) {
    const ImVec2 at = on_screen(area, camera, spring.at), target = on_screen(area, camera, spring.target);
    list.AddLine(at, target, palette().warning, 0.1f * text);
    list.AddCircleFilled(at, 0.2f * text, palette().warning);
    list.AddNgonFilled(target, 0.35f * text, palette().mark_outline, 4);
    list.AddNgonFilled(target, 0.25f * text, palette().warning, 4);
  }
  list.PopClipRect();
}

void MouseController::draw_box() const {
  if (drag_ != Drag::box || !dragged_) return;
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const ImVec2 end = ImGui::GetIO().MousePos;
  const ImVec2 low{std::min(pressed_at_.x, end.x), std::min(pressed_at_.y, end.y)};
  const ImVec2 high{std::max(pressed_at_.x, end.x), std::max(pressed_at_.y, end.y)};
  ImVec4 inside = ImGui::ColorConvertU32ToFloat4(palette().accent);
  inside.w = 0.15f;
  list.AddRectFilled(low, high, ImGui::ColorConvertFloat4ToU32(inside));
  list.AddRect(low, high, palette().accent);
}

void MouseController::draw_details(const ViewportArea& area) const {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const float text_height = ImGui::GetFontSize(), width = 18 * text_height,
              height = figures_height() + 2 * ImGui::GetStyle().WindowPadding.y;
  const bool left = mouse.x + width > area.high.x, above = mouse.y + text_height + height > area.high.y;
  // Beside the mouse where there is no room above or below.
  const float y = above ? mouse.y - text_height - height : mouse.y + text_height;
  ImGui::SetNextWindowPos({mouse.x + (left ? -text_height : text_height), std::max(y, 0.0f)}, ImGuiCond_Always,
                          {left ? 1.0f : 0.0f, 0});
  // Dear ImGui widens a tooltip a frame late, and these numbers change in every frame.
  ImGui::SetNextWindowSizeConstraints({width, 0}, {FLT_MAX, FLT_MAX});
  ImGui::BeginTooltip();
  write_figures(scene_, *hovered_);
  ImGui::EndTooltip();
}

}  // namespace mercury::window
