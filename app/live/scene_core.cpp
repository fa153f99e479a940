// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_core.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace mercury {

SceneCore::SceneCore(const Configuration& configuration, const TrialStart& start, const ViewSettings& view)
    : physics_(configuration, messages_), view_(view) {
  document_.configuration = configuration;
  document_.start = start;
  physics_.set_start(start);
  physics_.set_view(view);
  physics_.set_second(view.compare);
}

void SceneCore::fetch_snapshot() {
  snapshot_ = physics_.newest();
  goes_on_ = goes_on_ && snapshot_->timeline.viewing;
}

SceneDocument& SceneCore::edit(std::string name, std::string key) {
  adopt_moment();
  history_.before_change(document_, std::move(name), std::move(key));
  return document_;
}

void SceneCore::apply_document() {
  hold_waiting(false);                             // first, so that no step is made without it
  perturbations_.attach_opened(false, messages_);  // the same
  physics_.set_start(document_.start);
  std::vector<LiveRobot> bodies;
  for (const DocumentRobot& robot : document_.robots) bodies.push_back(robot.body);
  physics_.set_scene(std::move(bodies), document_.configuration, document_.surroundings);
}

void SceneCore::change_robots(const std::vector<RobotId>& robots, const char* name, const std::string& key,
                              const std::function<bool(DocumentRobot&)>& change) {
  adopt_moment();
  SceneDocument after = document_;
  bool any = false;
  for (const RobotId id : robots)
    for (DocumentRobot& robot : after.robots)
      if (robot.body.id == id) any = change(robot) || any;
  if (!any) return;
  edit(name, key) = std::move(after);
  apply_document();
}

void SceneCore::undo() {
  if (history_.can_undo()) travel(&EditHistory::undo);
}
void SceneCore::redo() {
  if (history_.can_redo()) travel(&EditHistory::redo);
}

void SceneCore::travel(void (EditHistory::*travel_in)(SceneDocument&)) {
  const std::vector<Attachment> before = document_.attachments;
  const TrialStart start_before = document_.start;
  (history_.*travel_in)(document_);
  apply_document();
  perturbations_.aim_pins(before, *snapshot_);
  if (document_.start != start_before) follow_start();
}

void SceneCore::adopt_moment() {
  if (!snapshot_ || !snapshot_->timeline.viewing || goes_on_) return;
  SceneDocument then{
      .robots = {}, .attachments = perturbations_.attached_at(*snapshot_), .configuration = snapshot_->configuration};
  then.configuration.device = document_.configuration.device;
  bool same = then.configuration == document_.configuration && snapshot_->robots->size() == document_.robots.size();
  for (const LiveRobot& body : snapshot_->robots->robots) {
    const DocumentRobot* known = std::as_const(document_).find(body.id);
    DocumentRobot robot{.body = body, .source = known ? known->source : RobotProvenance{}};
    if (known) robot.body.name = known->body.name;
    if (known) robot.made = known->made, robot.parent = known->parent;
    same = same && known && known->body.robot == body.robot && known->body.materials == body.materials &&
           known->body.by_hand == body.by_hand;
    then.robots.push_back(std::move(robot));
  }
  same =
      same && std::ranges::equal(then.attachments, document_.attachments, {}, &Attachment::spring, &Attachment::spring);
  physics_.go_on();
  goes_on_ = true;
  if (!snapshot_->timeline.recording) marks_.forget_bookmarks_after(snapshot_->time);
  perturbations_.send();  // what the mouse did at that moment is over
  if (same) return;
  history_.before_change(document_, fmt::format("go back to {:.4g} s", snapshot_->time), {});
  document_ = std::move(then);
  apply_document();
  perturbations_.send();
}

void SceneCore::reset() {
  perturbations_.before_reset(*snapshot_);
  physics_.reset();
}

void SceneCore::follow_start() {
  if (snapshot_->steps == 0 && !snapshot_->timeline.recording) reset();
}

void SceneCore::hold_opened(HeldParts held) {
  perturbations_.attach_later(std::move(held.attached));
  to_hold_ = std::move(held);
}

void SceneCore::update_held(bool complete) {
  const std::optional<LivePerturbation>& by_mouse = perturbations_.by_mouse();
  if (by_mouse && !document_.find(by_mouse->robot)) perturbations_.set_by_mouse({});
  if (hold_waiting(complete)) apply_document();
  perturbations_.attach_opened(complete, messages_);
  perturbations_.update(*snapshot_);
}

bool SceneCore::hold_waiting(bool complete) {
  bool changed = false;
  // `what` is held: an element of ByHand::*list by the name that it has among the `names` of a robot.
  const auto hold_all = [&](std::vector<HeldValue>& waiting, const char* option, const char* what,
                            std::vector<float> ByHand::*list, const auto& names_of) {
    for (const HeldValue& one : std::exchange(waiting, {})) {
      if (one.robot >= document_.robots.size()) {
        if (!complete)
          waiting.push_back(one);
        else
          report(Severity::warning, fmt::format("{} {}: robot {} is out of range, the scene has {}", option,
                                                text_of(one), one.robot, robot_count_text(document_.robots.size())));
        continue;
      }
      LiveRobot& body = document_.robots[one.robot].body;
      const std::vector<std::string> names = names_of(*body.robot);
      const auto found = std::ranges::find(names, one.name);
      if (found == names.end()) {
        report(Severity::warning,
               fmt::format("{} {}: {} has no {} \"{}\"", option, text_of(one), body.name, what, one.name));
        continue;
      }
      changed = hold(body, list, names.size(), static_cast<std::size_t>(found - names.begin()), one.value) || changed;
    }
  };
  hold_all(to_hold_.drives, "drive", "actuator", &ByHand::drives, actuator_names);
  hold_all(to_hold_.neurons, "neuron", "neuron", &ByHand::neurons, neuron_names);
  return changed;
}

void SceneCore::set_view(const ViewSettings& settings) {
  const bool details_changed = settings.color != view_.color || settings.shown.arrows != view_.shown.arrows ||
                               settings.folding != view_.folding || settings.footprints != view_.footprints;
  const bool compares = settings.compare != view_.compare;
  view_ = settings;
  if (details_changed) physics_.set_view(settings);
  if (compares) physics_.set_second(settings.compare);
}

}  // namespace mercury
