// SPDX-License-Identifier: Apache-2.0
// The timeline of the window's scene: earlier moments, loops, bookmarks, and going on from a moment.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/live/live_scene_parts.h"

namespace mercury {
namespace {

constexpr double same_moment = 1e-9;  // [s]

}  // namespace

// The document takes the robots and parameters of the moment that is shown, as an edit if they differ. Call it before
// an edit: what the user changes then is what the picture shows.
void LiveScene::Parts::adopt_moment() {
  if (!snapshot || !snapshot->timeline.viewing || goes_on) return;
  SceneDocument then{.robots = {}, .attachments = attachments_then(), .configuration = snapshot->configuration};
  then.configuration.device = document.configuration.device;
  bool same = then.configuration == document.configuration && snapshot->robots->size() == document.robots.size();
  for (const LiveRobot& body : snapshot->robots->robots) {
    const DocumentRobot* known = document.find(body.id);
    DocumentRobot robot{.body = body, .source = known ? known->source : RobotProvenance{}};
    if (known) robot.body.name = known->body.name;
    if (known) robot.made = known->made, robot.parent = known->parent;
    same = same && known && known->body.robot == body.robot && known->body.materials == body.materials;
    then.robots.push_back(std::move(robot));
  }
  same =
      same && std::ranges::equal(then.attachments, document.attachments, {}, &Attachment::spring, &Attachment::spring);
  physics.go_on();
  goes_on = true;
  forget_later_bookmarks();
  send_perturbation();  // what the mouse did at that moment is over
  if (same) return;
  history.before_change(document, fmt::format("go back to {:.4g} s", snapshot->time), {});
  document = std::move(then);
  apply_document();
  send_perturbation();
}

void LiveScene::Parts::forget_later_bookmarks() {
  if (!snapshot->timeline.recording)
    std::erase_if(bookmarks, [&](double time) { return time > snapshot->time + same_moment; });
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
  if (times && times->second < times->first) std::swap(times->first, times->second);
  if (times && !(std::isfinite(times->first) && times->second - times->first > same_moment)) return;
  parts_->loop_begin.reset();
  parts_->physics.set_loop(times);
}

LoopMark LiveScene::mark_loop() {
  Parts& parts = *parts_;
  const double now = parts.snapshot->time;
  if (parts.snapshot->timeline.looping) {
    set_loop({});
    return LoopMark::ended;
  }
  if (!parts.loop_begin || std::abs(*parts.loop_begin - now) <= same_moment) {
    parts.loop_begin = now;
    return LoopMark::begun;
  }
  set_loop(std::pair{*parts.loop_begin, now});
  return LoopMark::closed;
}
std::optional<double> LiveScene::loop_begin() const { return parts_->loop_begin; }

const std::vector<double>& LiveScene::bookmarks() const { return parts_->bookmarks; }

bool LiveScene::toggle_bookmark() {
  std::vector<double>& marks = parts_->bookmarks;
  const double now = parts_->snapshot->time;
  const auto there = std::ranges::find_if(marks, [&](double time) { return std::abs(time - now) <= same_moment; });
  if (there != marks.end()) {
    marks.erase(there);
    return false;
  }
  marks.insert(std::ranges::upper_bound(marks, now), now);
  return true;
}

bool LiveScene::seek_bookmark(int direction) {
  const std::vector<double>& marks = parts_->bookmarks;
  const TimelineState& timeline = parts_->snapshot->timeline;
  const double now = timeline.seeking ? timeline.target : parts_->snapshot->time;
  auto next = direction > 0 ? std::ranges::upper_bound(marks, now + same_moment)
                            : std::ranges::lower_bound(marks, now - same_moment);
  if (direction > 0 ? next == marks.end() : next == marks.begin()) return false;
  seek(direction > 0 ? *next : *std::prev(next));
  return true;
}

void LiveScene::set_timeline_budget(std::size_t bytes) { parts_->physics.set_timeline_budget(bytes); }

void LiveScene::Parts::play_recording(const std::shared_ptr<TrajectoryReader>& recording,
                                      const std::filesystem::path& file) {
  edit("open " + file.filename().string());
  bookmarks.clear();
  loop_begin.reset();
  document.robots.clear();
  const Device device = document.configuration.device;
  document.configuration = recording->configuration();
  document.configuration.device = device;
  std::vector<LiveRobot> bodies;
  for (const RecordedRobot& recorded : recording->robots()) {
    const RobotId id = append(recorded.robot, {});
    saved[id] = {"", document.robots.back().body};
    bodies.push_back(document.robots.back().body);
  }
  physics.set_recording(std::move(bodies), document.configuration, recording);
  report(Severity::note,
         fmt::format("{}: {:.4g} s of {}, recorded on {}; any change goes on simulating from there",
                     file.filename().string(), recording->time(recording->frames() - 1) - recording->time(0),
                     robot_count_text(recording->robots().size()), recording->device_name()));
}

}  // namespace mercury
