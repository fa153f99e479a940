// SPDX-License-Identifier: Apache-2.0
// Frames, time, the list of robots, selection and measures of the window's scene.
#include "app/live/live_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

#include "app/live/live_scene_parts.h"
#include "app/live/stepping.h"

namespace mercury {
namespace {

// Speeds in simulated seconds per second.
constexpr double slowest = 1e-3, fastest = 100;

constexpr std::array speeds{0.001, 0.002, 0.005, 0.01, 0.02,  0.05,           0.1, 0.2, 0.5, 1.0, 2.0,
                            5.0,   10.0,  20.0,  50.0, 100.0, unlimited_speed};

}  // namespace

LiveScene::LiveScene(const LiveSceneOptions& options) : parts_(std::make_unique<Parts>(options)) {
  parts_->document.configuration = options.configuration;
  parts_->document.start = options.start;
  parts_->physics.set_start(options.start);
  parts_->physics.set_view(options.view);
  parts_->physics.set_second(options.view.compare);
  frame();
}

LiveScene::~LiveScene() = default;

void LiveScene::watch_brain(RobotId robot) {
  parts_->brain_frames = 30;
  if (robot != parts_->watched_brain) parts_->physics.watch_brain(parts_->watched_brain = robot);
}

void LiveScene::frame(float aspect) {
  Parts& parts = *parts_;
  if (std::isfinite(aspect) && aspect > 0) parts.aspect = aspect;
  parts.background.finish_done();
  if (parts.described > 0 && --parts.described == 0) parts.physics.watch_velocities(false);
  if (parts.brain_frames > 0 && --parts.brain_frames == 0) parts.physics.watch_brain(parts.watched_brain = 0);
  parts.snapshot = parts.physics.newest();
  parts.goes_on = parts.goes_on && parts.snapshot->timeline.viewing;
  if (parts.snapshot->stops != parts.stops) {
    parts.stops = parts.snapshot->stops;
    parts.playing = false;
  }
  if (parts.snapshot->failed_seconds != parts.failed_seconds) {
    parts.failed_seconds = parts.snapshot->failed_seconds;
    set_second(std::nullopt);
  }
  if (parts.snapshot->failed_ghosts != parts.failed_ghosts) {
    parts.failed_ghosts = parts.snapshot->failed_ghosts;
    hide_ghosts();
  }
  parts.selection.keep(parts.document);
  const std::optional<LivePerturbation>& pull = parts.pulls.by_mouse();
  if (pull && !parts.document.find(pull->robot)) end_perturbation();
  const bool complete = parts.background.work().empty();
  if (parts.hold_opened(complete)) parts.apply_document();
  parts.pulls.attach_opened(complete, parts.messages);
  parts.pulls.update(*parts.snapshot);
  parts.update_ghosts();
  ViewSettings shown = parts.view;
  if (parts.from_above) shown.camera.mode = *parts.from_above ? CameraMode::top : CameraMode::group;
  if (parts.facing) {
    constexpr float flattest = 0.35f;  // a view of the ground in which rows are apart [rad]
    const bool land = has_ground(parts.document.configuration.environment);
    shown.camera.azimuth = parts.facing->azimuth;
    shown.camera.elevation = land ? std::max(flattest, parts.facing->elevation) : parts.facing->elevation;
  }
  const std::optional<RobotId> held = pull ? std::optional(pull->robot) : std::nullopt;
  parts.drawn.update(parts.snapshot, shown, parts.aspect, parts.selection.set(), parts.hidden, held, wall_now());
  parts.update_second_drawn(shown, held);
}

void LiveScene::face(bool from_above, const std::optional<render::Orbit>& direction) {
  parts_->from_above = from_above;
  parts_->facing = direction;
}
const Snapshot& LiveScene::snapshot() const { return *parts_->snapshot; }
std::shared_ptr<const Snapshot> LiveScene::hold_snapshot() const { return parts_->snapshot; }
DrawnScene& LiveScene::drawn() { return parts_->drawn; }
std::vector<Message> LiveScene::take_messages() { return parts_->messages.take(); }
std::string LiveScene::device_name() const { return parts_->physics.device_name(); }
int LiveScene::cuda_device() const { return parts_->physics.cuda_device(); }
void LiveScene::set_bridge(std::shared_ptr<PositionBridge> bridge) {
  parts_->drawn.set_bridge(bridge);
  parts_->physics.set_bridge(std::move(bridge));
}

void LiveScene::play() {
  parts_->playing = true;
  parts_->physics.play();
}
void LiveScene::pause() {
  parts_->playing = false;
  parts_->physics.pause();
}
void LiveScene::toggle() { parts_->playing ? pause() : play(); }
bool LiveScene::playing() const { return parts_->playing; }
void LiveScene::step(std::int64_t count) {
  parts_->playing = false;
  parts_->physics.step(count);
}
void LiveScene::reset() { parts_->reset(); }

void LiveScene::set_speed(double speed) {
  if (std::isnan(speed)) return;
  parts_->speed = speed == unlimited_speed ? speed : std::clamp(speed, slowest, fastest);
  parts_->physics.set_speed(parts_->speed);
}
double LiveScene::speed() const { return parts_->speed; }

void LiveScene::change_speed(int notches) {
  for (; notches > 0; --notches) {
    const auto next = std::upper_bound(speeds.begin(), speeds.end(), parts_->speed * (1 + 1e-9));
    if (next != speeds.end()) set_speed(*next);
  }
  for (; notches < 0; ++notches) {
    const auto next = std::lower_bound(speeds.begin(), speeds.end(), parts_->speed * (1 - 1e-9));
    if (next != speeds.begin()) set_speed(*(next - 1));
  }
}

void SceneSelection::keep(const SceneDocument& document) {
  if (ids_.empty()) return;
  std::unordered_set<RobotId> there;
  for (const DocumentRobot& robot : document.robots) there.insert(robot.body.id);
  std::erase_if(ids_, [&](RobotId id) { return !there.contains(id); });
}

std::vector<RobotEntry> LiveScene::entries() const {
  const Parts& parts = *parts_;
  const std::set<RobotId> selected = parts.selection.set();
  std::vector<RobotEntry> entries;
  entries.reserve(parts.document.robots.size());
  for (const DocumentRobot& robot : parts.document.robots) {
    const Robot& body = *robot.body.robot;
    RobotEntry entry{.id = robot.body.id,
                     .name = robot.body.name,
                     .masses = body.masses.size(),
                     .springs = body.springs.size(),
                     .faces = body.faces.size(),
                     .file = parts.saved.file_of(robot.body.id).value_or(""),
                     .unsaved = !parts.saved.holds(robot.body),
                     .selected = selected.contains(robot.body.id),
                     .hidden = parts.hidden.contains(robot.body.id),
                     .tuned = robot.body.materials != nullptr};
    if (const auto index = parts.snapshot->robots->index_of(robot.body.id)) {
      const Telemetry& telemetry = parts.snapshot->telemetry[*index];
      entry.exploded = telemetry.exploded;
      entry.exploded_at = telemetry.exploded_at;
      entry.culprit_spring = telemetry.culprit_spring;
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::size_t LiveScene::robot_count() const { return parts_->document.robots.size(); }

const SceneDocument& LiveScene::document() const { return parts_->document; }

void LiveScene::select(RobotId robot, bool alone) {
  if (!parts_->document.find(robot)) return;
  if (alone) parts_->selection.set({});
  parts_->selection.add(robot);
}
void LiveScene::toggle_selected(RobotId robot) {
  if (is_selected(robot))
    parts_->selection.remove(robot);
  else
    select(robot, false);
}
void LiveScene::select_all() {
  std::vector<RobotId> all = parts_->selection.ids();
  const std::set<RobotId> before = parts_->selection.set();
  for (const DocumentRobot& robot : parts_->document.robots)
    if (!before.contains(robot.body.id)) all.push_back(robot.body.id);
  parts_->selection.set(std::move(all));
}
void LiveScene::clear_selection() { parts_->selection.set({}); }
void LiveScene::set_selection(const std::vector<RobotId>& robots) {
  std::unordered_set<RobotId> free;
  for (const DocumentRobot& robot : parts_->document.robots) free.insert(robot.body.id);
  std::vector<RobotId> known;
  for (const RobotId id : robots)
    if (free.erase(id) > 0) known.push_back(id);
  parts_->selection.set(std::move(known));
}
bool LiveScene::is_selected(RobotId robot) const { return parts_->selection.contains(robot); }

std::vector<RobotId> LiveScene::selection() const {
  std::vector<RobotId> ordered;
  const std::set<RobotId> selected = parts_->selection.set();
  for (const DocumentRobot& robot : parts_->document.robots)
    if (selected.contains(robot.body.id)) ordered.push_back(robot.body.id);
  return ordered;
}
std::optional<RobotId> LiveScene::current() const {
  const std::vector<RobotId>& ids = parts_->selection.ids();
  const auto last = std::find_if(ids.rbegin(), ids.rend(), [&](RobotId id) { return parts_->document.find(id); });
  return last == ids.rend() ? std::nullopt : std::optional(*last);
}
void LiveScene::set_hidden(RobotId robot, bool hidden) {
  if (hidden)
    parts_->hidden.insert(robot);
  else
    parts_->hidden.erase(robot);
}

bool LiveScene::is_hidden(RobotId robot) const { return parts_->hidden.contains(robot); }

std::vector<Work> LiveScene::work() const { return parts_->background.work(); }
void LiveScene::cancel_work(std::uint64_t work) { parts_->background.cancel(work); }
void LiveScene::wait_for_work() {
  // A result may begin more work: that of a scene makes its random robots.
  do parts_->background.wait();
  while (parts_->background.finish_done());
}
void LiveScene::wait_until_done() {
  wait_for_work();
  parts_->physics.wait_until_done();
  frame(parts_->aspect);
}

Series LiveScene::second_series(RobotId robot) const {
  return parts_->snapshot->second ? parts_->physics.second_measurements().series(robot) : Series{};
}
Series LiveScene::ghost_series(RobotId robot) const {
  return parts_->snapshot->ghosts ? parts_->physics.ghost_measurements().series(robot) : Series{};
}
Series LiveScene::series(RobotId robot) const { return parts_->physics.measurements().series(robot); }
std::vector<RankingRow> LiveScene::ranking() const { return parts_->physics.measurements().ranking(); }

std::vector<ExplodedRobot> LiveScene::exploded() const {
  std::vector<ExplodedRobot> robots = exploded_robots(*parts_->snapshot, parts_->drawn.last_boxes());
  std::erase_if(robots, [&](const ExplodedRobot& robot) { return parts_->hidden.contains(robot.robot); });
  return robots;
}
std::vector<Explosion> LiveScene::take_explosions() { return parts_->physics.take_explosions(); }
void LiveScene::pause_on_explosion(bool pause) {
  if (std::exchange(parts_->pauses_on_explosion, pause) != pause) parts_->physics.pause_on_explosion(pause);
}

}  // namespace mercury
