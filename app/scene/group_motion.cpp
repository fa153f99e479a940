// SPDX-License-Identifier: Apache-2.0
#include "app/scene/group_motion.h"

#include <algorithm>
#include <cmath>

#include "app/scene/camera_controller.h"
#include "app/scene/hero_style.h"
#include "mercury/distance.h"

namespace mercury {

using render::Vector3;

Layout motion_of(const ViewSettings& settings) {
  if (settings.hero) return Layout::cells;
  return settings.board ? Layout::grid : settings.layout;
}

std::vector<Vector3> group_offsets(std::span<const render::Bounds> boxes, std::span<const Room> rooms,
                                   const ViewSettings& settings, const Environment& environment, float aspect) {
  if (boxes.empty()) return {};
  if (settings.hero) return hero_layout(rooms, settings, environment);
  const bool land = has_ground(environment);
  const bool race = settings.layout == Layout::race;
  // From straight above, and in lanes, robots that swim are laid out as if on the ground.
  const bool flat = land || race || settings.camera.mode == CameraMode::top;
  auto offsets = grid_layout(boxes, {.layout = settings.layout,
                                     .grid = settings.grid,
                                     .aspect = aspect,
                                     .view = direction_of(settings.camera, land),
                                     .rooms = settings.layout == Layout::grid ? std::span<const Room>() : rooms,
                                     .on_ground = flat});
  // Swimmers of a flat layout are level with each other.
  for (std::size_t i = 0; i < offsets.size() && !land && flat && settings.layout != Layout::grid; ++i)
    offsets[i].z = -rooms[i].center.z;
  return offsets;
}

void GroupMotion::set(Layout layout, const Environment& environment, const Vector3& along) {
  layout_ = layout;
  environment_ = environment;
  on_land_ = has_ground(environment);
  along_ = along;
}

Vector3 GroupMotion::offset_of(const Vector3& offset, const Room& room, const Trail& trail) const {
  if (layout_ == Layout::grid) return offset;
  Vector3 drift = Vector3(trail.last()) - room.center;
  if (on_land_) drift.z = 0;
  Vector3 shown = offset - drift;
  if (layout_ == Layout::race) shown += progress_of(trail) * along_;
  return shown;
}

Vector3 GroupMotion::ghost_offset(const Vector3& shown, const Room& room, const Trail& trail, Vec3 ghost) const {
  Vector3 apart = Vector3(ghost) - Vector3(trail.last());
  if (on_land_) apart.z = 0;
  if (layout_ == Layout::grid || !apart.is_finite()) return shown;
  if (layout_ == Layout::cells) return shown - std::max(0.0f, 1 - room.radius / std::max(1e-9f, apart.norm())) * apart;
  const auto way = static_cast<float>(distance_between(trail.start(), ghost, environment_));
  return shown - apart + (way - progress_of(trail)) * along_;
}

float GroupMotion::progress_of(const Trail& trail) const {
  return static_cast<float>(distance_between(trail.start(), trail.last(), environment_));
}

render::Bounds GroupMotion::camera_box(const render::Bounds& box, const Vector3& offset, const Room& room) const {
  if (layout_ == Layout::grid || box.empty()) return box;
  // A cylinder's box would leave much room at its corners, where the robot comes only if it lies along a diagonal.
  constexpr float share = 0.75f;
  render::Bounds all = box, cell;
  const Vector3 middle = offset + room.center;
  const Vector3 half(share * room.radius, share * room.radius, room.half_height);
  cell.extend(middle - half);
  cell.extend(middle + half);
  if (on_land_) {
    cell.low.z = std::min(box.low.z, 0.0f);
    cell.high.z = box.high.z;
  }
  all.extend(cell);
  return all;
}

void HeldRobot::hold(std::optional<std::size_t> robot, double elapsed) {
  constexpr double lag = 0.2;          // of the glide [s]
  constexpr float negligible = 1e-4f;  // [m]
  for (Offset& offset : offsets_) {
    offset.held = robot == offset.robot;
    if (offset.held) continue;
    offset.kept.reset();
    offset.correction *= static_cast<float>(std::exp(-std::max(0.0, elapsed) / lag));
  }
  std::erase_if(offsets_, [&](const Offset& one) { return !one.held && one.correction.norm() < negligible; });
  const auto same = [&](const Offset& one) { return robot == one.robot; };
  if (robot && std::ranges::none_of(offsets_, same)) offsets_.push_back({.robot = *robot});
}

Vector3 HeldRobot::correction(std::size_t robot, const Vector3& wanted) {
  const auto found = std::ranges::find(offsets_, robot, &Offset::robot);
  if (found == offsets_.end()) return Vector3::all(0);
  if (!found->held) return found->correction;
  if (!found->kept) found->kept = wanted + found->correction;
  return found->correction = *found->kept - wanted;
}

}  // namespace mercury
