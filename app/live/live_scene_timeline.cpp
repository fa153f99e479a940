// SPDX-License-Identifier: Apache-2.0
// What the window's scene shows besides the present: earlier moments, loops, bookmarks, the second side, and ghosts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/live/live_scene_parts.h"
#include "app/live/stepping.h"

namespace mercury {
namespace {

constexpr double same_moment = 1e-9;  // [s]

}  // namespace

bool TimelineMarks::toggle_bookmark(double now) {
  const auto there = std::ranges::find_if(bookmarks_, [&](double time) { return std::abs(time - now) <= same_moment; });
  if (there != bookmarks_.end()) {
    bookmarks_.erase(there);
    return false;
  }
  bookmarks_.insert(std::ranges::upper_bound(bookmarks_, now), now);
  return true;
}

std::optional<double> TimelineMarks::next_bookmark(double now, int direction) const {
  if (direction > 0) {
    const auto next = std::ranges::upper_bound(bookmarks_, now + same_moment);
    return next == bookmarks_.end() ? std::nullopt : std::optional(*next);
  }
  const auto next = std::ranges::lower_bound(bookmarks_, now - same_moment);
  return next == bookmarks_.begin() ? std::nullopt : std::optional(*std::prev(next));
}

void TimelineMarks::forget_bookmarks_after(double moment) {
  std::erase_if(bookmarks_, [&](double time) { return time > moment + same_moment; });
}

std::optional<std::pair<double, double>> TimelineMarks::mark_loop(double now) {
  if (loop_begin_)
    if (const auto loop = loop_between(*loop_begin_, now)) return loop;
  loop_begin_ = now;
  return std::nullopt;
}

std::optional<std::pair<double, double>> TimelineMarks::loop_between(double a, double b) {
  if (!(std::isfinite(std::min(a, b)) && std::abs(b - a) > same_moment)) return std::nullopt;
  return std::minmax(a, b);
}

// The document takes the robots and parameters of the moment that is shown, as an edit if they differ. Call it before
// an edit: what the user changes then is what the view shows.
void LiveScene::Parts::adopt_moment() {
  if (!snapshot || !snapshot->timeline.viewing || goes_on) return;
  SceneDocument then{
      .robots = {}, .attachments = pulls.attached_at(*snapshot), .configuration = snapshot->configuration};
  then.configuration.device = document.configuration.device;
  bool same = then.configuration == document.configuration && snapshot->robots->size() == document.robots.size();
  for (const LiveRobot& body : snapshot->robots->robots) {
    const DocumentRobot* known = document.find(body.id);
    DocumentRobot robot{.body = body, .source = known ? known->source : RobotProvenance{}};
    if (known) robot.body.name = known->body.name;
    if (known) robot.made = known->made, robot.parent = known->parent;
    same = same && known && known->body.robot == body.robot && known->body.materials == body.materials &&
           known->body.by_hand == body.by_hand;
    then.robots.push_back(std::move(robot));
  }
  same =
      same && std::ranges::equal(then.attachments, document.attachments, {}, &Attachment::spring, &Attachment::spring);
  physics.go_on();
  goes_on = true;
  forget_later_bookmarks();
  pulls.send();  // what the mouse did at that moment is over
  if (same) return;
  history.before_change(document, fmt::format("go back to {:.4g} s", snapshot->time), {});
  document = std::move(then);
  apply_document();
  pulls.send();
}

void LiveScene::Parts::forget_later_bookmarks() {
  if (!snapshot->timeline.recording) marks.forget_bookmarks_after(snapshot->time);
}

void LiveScene::seek(double time) {
  if (!std::isfinite(time)) return;
  parts_->goes_on = false;
  parts_->physics.seek(time);
}
void LiveScene::step_back(std::int64_t count) {
  parts_->playing = parts_->goes_on = false;
  parts_->physics.step_back(count);
}
void LiveScene::go_on() { parts_->adopt_moment(); }

std::vector<RobotId> LiveScene::fork(const std::vector<RobotId>& robots) {
  Parts& parts = *parts_;
  parts.adopt_moment();
  std::vector<DocumentRobot> copies;
  for (const RobotId id : robots)
    if (const DocumentRobot* robot = parts.document.find(id)) copies.push_back(*robot);
  if (copies.empty()) return {};
  parts.edit("fork " + robot_count_text(copies.size()));
  std::vector<RobotId> ids;
  for (DocumentRobot& copy : copies) {
    copy.body.begins_as = copy.body.id;
    copy.body.id = ++parts.last_id;
    copy.body.name = parts.free_name(copy.body.name);
    ids.push_back(copy.body.id);
    parts.document.robots.push_back(std::move(copy));
  }
  parts.apply_document();
  return ids;
}

void LiveScene::set_loop(std::optional<std::pair<double, double>> times) {
  if (times && !(times = TimelineMarks::loop_between(times->first, times->second))) return;
  parts_->marks.forget_loop();
  parts_->physics.set_loop(times);
}

LoopMark LiveScene::mark_loop() {
  if (parts_->snapshot->timeline.looping) {
    set_loop({});
    return LoopMark::ended;
  }
  const auto loop = parts_->marks.mark_loop(parts_->snapshot->time);
  if (!loop) return LoopMark::begun;
  set_loop(loop);
  return LoopMark::closed;
}
std::optional<double> LiveScene::loop_begin() const { return parts_->marks.loop_begin(); }

const std::vector<double>& LiveScene::bookmarks() const { return parts_->marks.bookmarks(); }

bool LiveScene::toggle_bookmark() { return parts_->marks.toggle_bookmark(parts_->snapshot->time); }

bool LiveScene::seek_bookmark(int direction) {
  const TimelineState& timeline = parts_->snapshot->timeline;
  const auto next = parts_->marks.next_bookmark(timeline.seeking ? timeline.target : parts_->snapshot->time, direction);
  if (next) seek(*next);
  return next.has_value();
}

void LiveScene::set_timeline_budget(std::size_t bytes) { parts_->physics.set_timeline_budget(bytes); }

void LiveScene::Parts::play_recording(const std::shared_ptr<TrajectoryReader>& recording,
                                      const std::filesystem::path& file) {
  edit("open " + file.filename().string());
  marks = {};
  document.robots.clear();
  document.surroundings = ++last_surroundings;  // undo brings back the clock and the states of now
  const Device device = document.configuration.device;
  document.configuration = recording->configuration();
  document.configuration.device = device;
  std::vector<LiveRobot> bodies;
  for (const RecordedRobot& recorded : recording->robots()) {
    append(recorded.robot, {});
    saved.note(document.robots.back().body, "");
    bodies.push_back(document.robots.back().body);
  }
  physics.set_recording(std::move(bodies), document.configuration, document.surroundings, recording);
  report(Severity::note,
         fmt::format("{}: {:.4g} s of {}, recorded on {}; any change goes on simulating from there",
                     file.filename().string(), recording->time(recording->frames() - 1) - recording->time(0),
                     robot_count_text(recording->robots().size()), recording->device_name()));
}

void LiveScene::set_second(const std::optional<SideDifference>& difference) {
  ViewSettings settings = parts_->view;
  settings.compare = difference;
  set_view(settings);
}
const std::optional<SideDifference>& LiveScene::second() const { return parts_->view.compare; }
DrawnScene* LiveScene::second_drawn() { return parts_->second_drawn.get(); }

void LiveScene::point_at_second(bool second) { parts_->pointed_second = second; }
bool LiveScene::points_at_second() const { return parts_->points_at_second(); }
const Snapshot& LiveScene::pointed_snapshot() const { return parts_->pointed_snapshot(); }
const DrawnScene& LiveScene::pointed_drawn() const { return parts_->pointed_drawn(); }

// Both sides have the same layout, colors and scale, so that what differs is the robots.
void LiveScene::Parts::update_second_drawn(ViewSettings shown, const std::optional<RobotId>& held) {
  const auto on_land = [](const Snapshot& one) { return has_ground(one.configuration.environment); };
  if (!snapshot->second) {
    second_drawn.reset();
    return;
  }
  if (!second_drawn) second_drawn = std::make_unique<DrawnScene>();
  const render::Scene& first = drawn.scene();
  if (shown.color->has_values() && first.scale.low < first.scale.high)
    shown.scale = std::pair(first.scale.low, first.scale.high);
  if (on_land(*snapshot) && !on_land(*snapshot->second)) shown.camera.mode = CameraMode::top;  // side by side, as there
  second_drawn->update(snapshot->second, shown, aspect, selection.set(), hidden, held, wall_now());
}

std::size_t LiveScene::show_ghosts(const std::vector<RobotId>& robots, GhostOf of) {
  parts_->ghosts.clear();
  for (const RobotId id : robots) {
    const DocumentRobot* robot = parts_->document.find(id);
    if (!robot) continue;
    const LiveRobot& unchanged = robot->made ? *robot->made : robot->body;
    const bool changed = unchanged.robot != robot->body.robot || unchanged.materials != robot->body.materials ||
                         unchanged.by_hand != robot->body.by_hand || robot->body.by_hand;
    const bool of_parent = of == GhostOf::parent || (of == GhostOf::automatic && !changed && robot->parent);
    if (of_parent && !robot->parent) continue;
    LiveGhost ghost{id, of_parent, of_parent ? *robot->parent : unchanged};
    ghost.body.id = id;
    ghost.body.begins_as = 0;
    ghost.body.by_hand.reset();
    parts_->ghosts.push_back(std::move(ghost));
  }
  std::vector<LiveRobot> bodies;
  for (const LiveGhost& ghost : parts_->ghosts) bodies.push_back(ghost.body);
  parts_->physics.set_ghosts(std::move(bodies));
  return parts_->ghosts.size();
}

void LiveScene::hide_ghosts() { show_ghosts({}); }
const std::vector<LiveGhost>& LiveScene::ghosts() const { return parts_->ghosts; }

void LiveScene::Parts::update_ghosts() {
  std::erase_if(ghosts, [&](const LiveGhost& ghost) { return !document.find(ghost.robot); });
}

std::vector<GhostFigures> LiveScene::ghost_figures() const {
  std::vector<GhostFigures> all;
  if (!parts_->snapshot->ghosts) return all;
  const std::vector<RankingRow> robots = parts_->physics.measurements().ranking();
  for (const RankingRow& ghost : parts_->physics.ghost_measurements().ranking()) {
    const auto robot = std::ranges::find(robots, ghost.robot, &RankingRow::robot);
    const auto wanted = std::ranges::find(parts_->ghosts, ghost.robot, &LiveGhost::robot);
    if (robot == robots.end() || wanted == parts_->ghosts.end()) continue;
    const double age = std::min(ghost.age, robot->age);
    GhostFigures figures{.robot = ghost.robot, .of_parent = wanted->of_parent, .age = age};
    figures.robot_distance = parts_->physics.measurements().distance_at_age(ghost.robot, age);
    figures.ghost_distance = parts_->physics.ghost_measurements().distance_at_age(ghost.robot, age);
    if (age > 0) {
      figures.robot_speed = figures.robot_distance / age;
      figures.ghost_speed = figures.ghost_distance / age;
    }
    figures.same_age = std::abs(robot->age - ghost.age) < 1e-6;
    figures.ghost_exploded = ghost.exploded;
    all.push_back(figures);
  }
  return all;
}

}  // namespace mercury
