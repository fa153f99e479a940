// SPDX-License-Identifier: Apache-2.0
#include "app/live/drawn_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/base/frame_places.h"
#include "app/video/group_drawing.h"

namespace mercury {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(float), "the renderer reads positions as plain floats");

bool same_layout(const ViewSettings& a, const ViewSettings& b) {
  const auto grid = [](const ViewSettings& s) {
    return s.grid ? std::pair{s.grid->columns, s.grid->rows} : std::pair{0, 0};
  };
  return a.layout == b.layout && grid(a) == grid(b) && a.camera.azimuth == b.camera.azimuth &&
         a.camera.elevation == b.camera.elevation &&
         (a.camera.mode == CameraMode::top) == (b.camera.mode == CameraMode::top);
}

// The settings that match the details of the snapshot.
ViewSettings fitting(const ViewSettings& settings, const Snapshot& snapshot) {
  ViewSettings fitted = settings;
  fitted.color = snapshot.color;
  if (snapshot.color != settings.color) fitted.scale.reset();
  fitted.speed = std::isfinite(snapshot.speed) ? snapshot.speed : 1;
  return fitted;
}

Group group_of(const Snapshot& snapshot) {
  Group group{.telemetry = snapshot.telemetry,
              .environment = snapshot.configuration.environment,
              .shapes = snapshot.robots->shapes,
              .bodies = snapshot.robots->bodies};
  for (const LiveRobot& robot : snapshot.robots->robots) {
    group.robots.push_back(robot.robot.get());
    group.materials.push_back(materials_of(robot));
    group.names.push_back(robot.name);
  }
  return group;
}

std::vector<render::Vector3> offsets_of(const Snapshot& snapshot, const ViewSettings& settings, float aspect) {
  std::vector<render::Bounds> bounds;
  for (std::size_t i = 0; i < snapshot.robots->size(); ++i)
    bounds.push_back(i < snapshot.robots->shapes.size() ? snapshot.robots->shapes[i]->box
                                                        : rest_bounds(*snapshot.robots->robots[i].robot));
  std::vector<Room> rooms;
  for (std::size_t i = 0; i < snapshot.robots->size(); ++i)
    rooms.push_back(i < snapshot.robots->shapes.size() ? snapshot.robots->shapes[i]->room
                                                       : room_of(*snapshot.robots->robots[i].robot));
  ViewSettings fitting = settings;
  // Ignore a grid that has become too small.
  if (fitting.grid &&
      static_cast<std::size_t>(fitting.grid->columns) * static_cast<std::size_t>(fitting.grid->rows) < bounds.size())
    fitting.grid.reset();
  return group_offsets(bounds, rooms, fitting, snapshot.configuration.environment, aspect);
}

constexpr std::size_t most_snapshots = 5;

// Steps per second of wall time; 0 = paused or unlimited.
double rate_of(const Snapshot& snapshot) {
  return snapshot.playing && std::isfinite(snapshot.speed) ? snapshot.speed / snapshot.configuration.dt : 0;
}

bool is_slow(const Snapshot& snapshot) {
  const double rate = rate_of(snapshot);
  return rate > 0 && rate <= SlowMotion::most_rate;
}

}  // namespace

render::Color ghost_color(render::Theme theme) {
  return theme == render::Theme::dark ? render::Color{215, 235, 255, 255} : render::Color{30, 60, 105, 255};
}

struct DrawnScene::Parts {
  std::shared_ptr<const Snapshot> snapshot;
  ViewSettings settings;  // of the last update()
  std::optional<GroupScene> scene;
  std::optional<std::pair<render::Camera, float>> seen;
  double wall = 0;  // of the last update() [s]
  std::uint64_t revision = 0;
  // Of the last update(), to see whether the next one changes the view.
  struct Look {
    std::shared_ptr<const Snapshot> snapshot;
    ViewSettings settings;
    std::set<RobotId> selected, hidden;
    std::vector<render::Vector3> offsets;
    std::pair<float, float> scale;
    double time = 0;

    friend bool operator==(const Look&, const Look&) = default;
  };
  Look look;
  std::uint64_t changes = 0;
  SlowMotion slow_motion;
  SlowMotion::Shown shown;
  std::shared_ptr<PositionBridge> bridge;  // or null
  SlowMotion ghost_motion;
  std::vector<render::Ghost> ghosts;

  void show_ghosts(const std::set<RobotId>& hidden, double now);
  void keep_trails(const GroupScene& old, const Snapshot& before) {
    for (std::size_t i = 0; i < snapshot->robots->size(); ++i)
      if (const auto index = before.robots->index_of(snapshot->robots->robots[i].id)) {
        scene->set_trail(i, old.trails()[*index]);
        scene->set_footprints(i, old.footprints()[*index]);
      }
  }
};

void DrawnScene::Parts::show_ghosts(const std::set<RobotId>& hidden, double now) {
  ghosts.clear();
  const std::shared_ptr<const Snapshot>& all = snapshot->ghosts;
  if (all) ghost_motion.take(all);
  const SlowMotion::Shown at = all ? ghost_motion.at(now) : SlowMotion::Shown{};
  for (std::size_t i = 0; all && i < all->robots->size(); ++i) {
    const RobotId id = all->robots->robots[i].id;
    const auto robot = snapshot->robots->index_of(id);
    if (!robot || hidden.contains(id) || at.telemetry[i].exploded) continue;
    const std::size_t first = all->robots->mass_offsets[i], last = all->robots->mass_offsets[i + 1];
    ghosts.push_back({.positions = {&at.positions.data()[first].x, 3 * (last - first)},
                      .faces = all->robots->shapes[i]->body->faces,
                      .offset = scene->ghost_offset(*robot, at.telemetry[i].center_of_mass),
                      .color = ghost_color(settings.theme)});
  }
  scene->scene().ghosts = ghosts;
}

DrawnScene::DrawnScene() : parts_(std::make_unique<Parts>()) {}
DrawnScene::~DrawnScene() = default;

void DrawnScene::update(std::shared_ptr<const Snapshot> snapshot, const ViewSettings& settings, float aspect,
                        const std::set<RobotId>& selected, const std::set<RobotId>& hidden, std::optional<RobotId> held,
                        double wall) {
  Parts& parts = *parts_;
  const std::shared_ptr<const Snapshot> before = std::exchange(parts.snapshot, snapshot);
  const ViewSettings old_settings = std::exchange(parts.settings, settings);
  const bool others = !before || before->robots->revision != snapshot->robots->revision;
  const bool moved = before && !same_parts(before->configuration.environment, snapshot->configuration.environment);
  // The timeline jumps, too, but trails know where the robots were.
  const bool restarted =
      before && before->resets != snapshot->resets && !before->timeline.viewing && !snapshot->timeline.viewing;
  if (others) {
    const std::optional<GroupScene> old = std::exchange(parts.scene, std::nullopt);
    parts.scene.emplace(group_of(*snapshot), offsets_of(*snapshot, settings, aspect), fitting(settings, *snapshot));
    if (old && !restarted) parts.keep_trails(*old, *before);
    ++parts.revision;
  } else {
    parts.scene->set_settings(fitting(settings, *snapshot));
    if (before->configuration.environment != snapshot->configuration.environment)
      parts.scene->set_environment(snapshot->configuration.environment);
    if (moved || !same_layout(old_settings, settings)) lay_out(aspect);
    if (restarted) parts.scene->restart(snapshot->telemetry);
    for (std::size_t i = 0; i < snapshot->robots->size() && before->robots != snapshot->robots; ++i) {
      const LiveRobot &now = snapshot->robots->robots[i], &then = before->robots->robots[i];
      if (now.materials != then.materials) parts.scene->set_materials(i, materials_of(now));
      if (now.name != then.name) parts.scene->set_name(i, now.name);
    }
  }
  for (std::size_t i = 0; i < snapshot->robots->size(); ++i) {
    const RobotId id = snapshot->robots->robots[i].id;
    parts.scene->mark(i, selected.contains(id), hidden.contains(id));
  }
  if (parts.seen) parts.scene->see(parts.seen->first, parts.seen->second);
  if (before != snapshot) parts.slow_motion.take(snapshot);
  parts.shown = parts.slow_motion.at(wall);
  parts.scene->hold(held ? snapshot->robots->index_of(*held) : std::nullopt, wall - std::exchange(parts.wall, wall));
  // Steps that were not shown, as when a recording is dragged forward, leave no straight line in its path.
  const bool jumped = before && std::abs(snapshot->steps - before->steps) > 1 && !snapshot->playing;
  const bool returned = before && before->timeline.viewing && snapshot->time >= before->timeline.head;
  parts.scene->set_later(!snapshot->timeline.viewing && !returned ? Later::forget : jumped ? Later::skip : Later::keep);
  parts.scene->update(parts.shown.time, parts.shown.telemetry, snapshot->details);
  const auto positions = parts.shown.positions;
  parts.scene->scene().positions = {positions.empty() ? nullptr : &positions.data()->x, 3 * positions.size()};
  parts.show_ghosts(hidden, wall);
  const std::span<const render::Vector3> offsets = parts.scene->offsets();
  const render::Scale& scale = parts.scene->scene().scale;
  Parts::Look look{std::move(snapshot),     settings,        selected, hidden, {offsets.begin(), offsets.end()},
                   {scale.low, scale.high}, parts.shown.time};
  if (look == parts.look) return;
  parts.look = std::move(look);
  ++parts.changes;
}

std::uint64_t DrawnScene::changes() const { return parts_->changes; }

void DrawnScene::see(const render::Camera& camera, float aspect) { parts_->seen = {camera, aspect}; }

void DrawnScene::lay_out(float aspect) {
  Parts& parts = *parts_;
  if (!parts.snapshot || !parts.scene) return;
  parts.scene->set_offsets(offsets_of(*parts.snapshot, parts.settings, aspect));
}

std::uint64_t DrawnScene::bodies_revision() const { return parts_->revision; }
void DrawnScene::set_bodies(render::Renderer& renderer) const { parts_->scene->set_bodies(renderer); }
render::Scene& DrawnScene::scene() { return parts_->scene->scene(); }
std::span<const render::Bounds> DrawnScene::bounds() const {
  return parts_->scene ? parts_->scene->bounds() : std::span<const render::Bounds>{};
}
void DrawnScene::set_bridge(std::shared_ptr<PositionBridge> bridge) { parts_->bridge = std::move(bridge); }
void DrawnScene::show_positions(render::Renderer& renderer) {
  if (parts_->shown.device) parts_->bridge->show(*parts_->shown.device, renderer, scene());
}
bool DrawnScene::positions_on_device() const { return parts_->shown.device != nullptr; }
std::span<const Vec3> DrawnScene::positions_of(std::size_t robot) const {
  if (parts_->shown.device) return parts_->snapshot->positions_of(robot);
  const std::vector<std::size_t>& offsets = parts_->snapshot->robots->mass_offsets;
  return parts_->shown.positions.subspan(offsets[robot], offsets[robot + 1] - offsets[robot]);
}
std::span<const render::Vector3> DrawnScene::offsets() const {
  return parts_->scene ? parts_->scene->offsets() : std::span<const render::Vector3>{};
}
render::Vector3 DrawnScene::cell_center(std::size_t robot) const { return parts_->scene->cell_center(robot); }
bool DrawnScene::is_hidden(std::size_t robot) const {
  if (!parts_->scene) return false;
  const std::span<const render::Placement> placements = parts_->scene->scene().placements;
  return robot < placements.size() && placements[robot].hidden;
}
std::span<const render::Bounds> DrawnScene::last_boxes() const {
  return parts_->scene ? parts_->scene->last_boxes() : std::span<const render::Bounds>{};
}
std::span<const render::Bounds> DrawnScene::camera_boxes() const {
  return parts_->scene ? parts_->scene->camera_boxes() : std::span<const render::Bounds>{};
}

void SlowMotion::take(std::shared_ptr<const Snapshot> snapshot) {
  if (!snapshots_.empty()) {
    const Snapshot& last = *snapshots_.back();
    const bool other = last.robots->revision != snapshot->robots->revision || last.resets != snapshot->resets ||
                       snapshot->steps < last.steps;
    if (other || !is_slow(*snapshot))
      snapshots_.clear();
    else if (last.steps == snapshot->steps)
      snapshots_.pop_back();
  }
  snapshots_.push_back(std::move(snapshot));
  if (snapshots_.size() > most_snapshots) snapshots_.pop_front();
  if (snapshots_.size() == 1) shown_ = snapshots_.back()->time;
}

double SlowMotion::wanted(double wall) const {
  const Snapshot& newest = *snapshots_.back();
  const double lag = 1 / rate_of(newest) + allowance;
  const double time = newest.time + (wall - newest.due_at - lag) * newest.speed;
  return std::clamp(std::max(time, shown_), snapshots_.front()->time, newest.time);
}

SlowMotion::Shown SlowMotion::at(double wall) {
  const Snapshot& newest = *snapshots_.back();
  if (snapshots_.size() < 2 || !is_slow(newest)) {
    shown_ = newest.time;
    if (newest.positions.device())
      return {.time = newest.time, .positions = {}, .device = newest.positions.device(), .telemetry = newest.telemetry};
    return {.time = newest.time, .positions = newest.positions.host(), .telemetry = newest.telemetry};
  }
  shown_ = wanted(wall);
  std::size_t next = 1;
  while (next + 1 < snapshots_.size() && snapshots_[next]->time < shown_) ++next;
  const Snapshot &a = *snapshots_[next - 1], &b = *snapshots_[next];
  const auto share = static_cast<float>(std::clamp((shown_ - a.time) / (b.time - a.time), 0.0, 1.0));
  const std::span<const Vec3> from = a.positions.host(), to = b.positions.host();
  positions_.resize(to.size());
  for (std::size_t i = 0; i < positions_.size(); ++i) positions_[i] = interpolated(from[i], to[i], share);
  telemetry_ = newest.telemetry;
  interpolate_centers(a.telemetry, b.telemetry, share, telemetry_);
  return {.time = shown_, .positions = positions_, .telemetry = telemetry_};
}

}  // namespace mercury
