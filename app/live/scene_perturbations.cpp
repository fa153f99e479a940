// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_perturbations.h"

#include <fmt/format.h>

#include <algorithm>

namespace mercury {
namespace {

using Kind = LivePerturbation::Kind;

// The stiffest spring that is stable beside those of the robot [N/m]: k dt^2 well below 4.
float stiffest_pin(const Configuration& configuration) {
  return static_cast<float>(0.2 / (configuration.dt * configuration.dt));
}

bool is_pin(const Attachment& one) { return one.spring.kind == Kind::pin; }

bool is_of(const Attachment& one, const std::vector<RobotId>& robots) {
  return std::ranges::find(robots, one.spring.robot) != robots.end();
}

bool same_pin(const Attachment& a, const Attachment& b) {
  return is_pin(a) && is_pin(b) && a.spring.robot == b.spring.robot && a.spring.mass == b.spring.mass;
}

}  // namespace

std::optional<Vec3> position_of(const Snapshot& snapshot, RobotId robot, std::uint16_t mass) {
  const auto index = snapshot.robots->index_of(robot);
  if (!index || mass >= snapshot.positions_of(*index).size()) return std::nullopt;
  return snapshot.positions_of(*index)[mass];
}

void ScenePerturbations::set_by_mouse(std::optional<LivePerturbation> pull) {
  by_mouse_ = pull;
  send();
}

void ScenePerturbations::attach(LivePerturbation spring) {
  document_.attachments.push_back({spring, resets_});
  send();
}

void ScenePerturbations::pin(RobotId robot, std::uint16_t mass, const Vec3& target) {
  attach({.robot = robot,
          .mass = mass,
          .target = target,
          .stiffness = stiffest_pin(document_.configuration),
          .kind = Kind::pin});
}

bool ScenePerturbations::attached_to(const std::vector<RobotId>& robots) const {
  return std::ranges::any_of(document_.attachments, [&](const Attachment& one) { return is_of(one, robots); });
}

void ScenePerturbations::detach(const std::vector<RobotId>& robots) {
  std::erase_if(document_.attachments, [&](const Attachment& one) { return is_of(one, robots); });
  send();
}

void ScenePerturbations::send() {
  std::vector<LivePerturbation> all;
  for (const Attachment& attachment : document_.attachments) {
    if (is_pin(attachment) && pins_wait_) continue;
    all.push_back(attachment.spring);
    // Stable at the current time step, which may have grown.
    all.back().stiffness = std::min(all.back().stiffness, stiffest_pin(document_.configuration));
  }
  if (by_mouse_) all.push_back(*by_mouse_);
  physics_.set_perturbations(std::move(all));
}

void ScenePerturbations::before_reset(const Snapshot& now) {
  ++resets_;
  if (!std::ranges::any_of(document_.attachments, is_pin)) return;
  pins_wait_ = now.resets;
  send();
}

void ScenePerturbations::update(const Snapshot& now) {
  if (document_.attachments.empty()) return;
  const auto removed =
      std::erase_if(document_.attachments, [&](const Attachment& one) { return !document_.find(one.spring.robot); });
  const bool back = pins_wait_ && now.resets > *pins_wait_ && !now.timeline.viewing;
  if (back) {
    pins_wait_.reset();
    for (Attachment& one : document_.attachments)
      if (const auto at = position_of(now, one.spring.robot, one.spring.mass); is_pin(one) && at) {
        one.spring.target = *at;
        one.resets = resets_;
      }
  }
  if (removed > 0 || back) send();
}

void ScenePerturbations::aim_pins(const std::vector<Attachment>& before, const Snapshot& now) {
  for (Attachment& one : document_.attachments) {
    if (!is_pin(one)) continue;
    if (const auto known = std::ranges::find_if(before, [&](const Attachment& other) { return same_pin(one, other); });
        known != before.end()) {
      one = *known;
    } else if (const auto at = position_of(now, one.spring.robot, one.spring.mass); at && one.resets != resets_) {
      one.spring.target = *at;
      one.resets = resets_;
    }
  }
  send();
}

std::vector<Attachment> ScenePerturbations::attached_at(const Snapshot& moment) const {
  std::vector<Attachment> then;
  for (const LivePerturbation& one : moment.perturbations) {
    if (one.kind == Kind::mouse) continue;
    // Its stiffness may have been limited by the time step.
    const auto known = std::ranges::find_if(document_.attachments, [&](const Attachment& other) {
      LivePerturbation limited = other.spring;
      limited.stiffness = one.stiffness;
      return limited == one;
    });
    then.push_back(known == document_.attachments.end() ? Attachment{one, resets_} : *known);
  }
  return then;
}

void ScenePerturbations::attach_opened(bool complete, Messages& messages) {
  if (to_attach_.empty()) return;
  for (const AttachedMass& one : std::exchange(to_attach_, {})) {
    if (one.robot >= document_.robots.size()) {
      if (!complete)
        to_attach_.push_back(one);
      else
        messages.add(Severity::warning,
                     fmt::format("attach {}: robot {} is out of range, the scene has {}", text_of(one), one.robot,
                                 robot_count_text(document_.robots.size())));
      continue;
    }
    const LiveRobot& body = document_.robots[one.robot].body;
    if (one.mass >= body.robot->masses.size()) {
      messages.add(Severity::warning, fmt::format("attach {}: mass {} is out of range, {} has {}", text_of(one),
                                                  one.mass, body.name, body.robot->masses.size()));
      continue;
    }
    LivePerturbation spring{.robot = body.id, .mass = one.mass};
    if (one.spring) {
      spring.target = one.spring->target;
      spring.stiffness = one.spring->stiffness;
      spring.kind = Kind::spring;
    } else {
      spring.target = start_of(*body.robot, document_.configuration.environment, document_.start)[one.mass];
      spring.stiffness = stiffest_pin(document_.configuration);
      spring.kind = Kind::pin;
    }
    document_.attachments.push_back({spring, resets_});
  }
  send();
}

}  // namespace mercury
