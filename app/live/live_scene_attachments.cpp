// SPDX-License-Identifier: Apache-2.0
// Pins and springs that stay attached to masses of the window's scene.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "app/live/live_scene_parts.h"

namespace mercury {
namespace {

using Kind = LivePerturbation::Kind;

// The stiffest spring that is stable beside those of the robot [N/m]: k dt^2 well below 4.
float stiffest_pin(const Configuration& configuration) {
  return static_cast<float>(0.2 / (configuration.dt * configuration.dt));
}

bool is_pin(const Attachment& one) { return one.spring.kind == Kind::pin; }

bool same_pin(const Attachment& a, const Attachment& b) {
  return is_pin(a) && is_pin(b) && a.spring.robot == b.spring.robot && a.spring.mass == b.spring.mass;
}

// Where the mass is in the snapshot.
std::optional<Vec3> position_of(const Snapshot& snapshot, RobotId robot, std::uint16_t mass) {
  const auto index = snapshot.robots->index_of(robot);
  if (!index || mass >= snapshot.positions_of(*index).size()) return std::nullopt;
  return snapshot.positions_of(*index)[mass];
}

// Where a mass of a robot is at the start: on the ground, robots are set down with their lowest mass at z = 0.
Vec3 start_of(const Robot& robot, std::uint16_t mass, const Environment& environment) {
  Vec3 start = robot.masses[mass];
  if (has_ground(environment)) start.z -= std::ranges::min(robot.masses, {}, &Vec3::z).z;
  return start;
}

}  // namespace

void LiveScene::Parts::send_perturbation() {
  std::vector<LivePerturbation> all;
  for (const Attachment& attachment : document.attachments) {
    if (is_pin(attachment) && pins_wait) continue;
    all.push_back(attachment.spring);
    // Stable at the present time step, which may have grown.
    all.back().stiffness = std::min(all.back().stiffness, stiffest_pin(document.configuration));
  }
  if (perturbation) all.push_back(*perturbation);
  physics.set_perturbations(std::move(all));
}

void LiveScene::Parts::update_attachments() {
  attach_opened(background.work().empty());
  if (document.attachments.empty()) return;
  const auto removed =
      std::erase_if(document.attachments, [&](const Attachment& one) { return !document.find(one.spring.robot); });
  const bool back = pins_wait && snapshot->resets > *pins_wait && !snapshot->timeline.viewing;
  if (back) {
    pins_wait.reset();
    for (Attachment& one : document.attachments)
      if (const auto now = position_of(*snapshot, one.spring.robot, one.spring.mass); is_pin(one) && now) {
        one.spring.target = *now;
        one.resets = resets;
      }
  }
  if (removed > 0 || back) send_perturbation();
}

void LiveScene::Parts::aim_pins(const std::vector<Attachment>& before) {
  for (Attachment& one : document.attachments) {
    if (!is_pin(one)) continue;
    if (const auto known = std::ranges::find_if(before, [&](const Attachment& other) { return same_pin(one, other); });
        known != before.end()) {
      one = *known;
    } else if (const auto now = position_of(*snapshot, one.spring.robot, one.spring.mass);
               now && one.resets != resets) {
      one.spring.target = *now;
      one.resets = resets;
    }
  }
  send_perturbation();
}

std::vector<Attachment> LiveScene::Parts::attachments_then() const {
  std::vector<Attachment> then;
  for (const LivePerturbation& one : snapshot->perturbations) {
    if (one.kind == Kind::mouse) continue;
    // Its stiffness may have been limited by the time step.
    const auto known = std::ranges::find_if(document.attachments, [&](const Attachment& other) {
      LivePerturbation limited = other.spring;
      limited.stiffness = one.stiffness;
      return limited == one;
    });
    then.push_back(known == document.attachments.end() ? Attachment{one, resets} : *known);
  }
  return then;
}

void LiveScene::attach_opened(std::vector<AttachedMass> attached) { parts_->to_attach = std::move(attached); }

void LiveScene::Parts::attach_opened(bool complete) {
  if (to_attach.empty()) return;
  for (const AttachedMass& one : std::exchange(to_attach, {})) {
    if (one.robot >= document.robots.size()) {
      if (!complete)
        to_attach.push_back(one);
      else
        report(Severity::warning, fmt::format("attach {}: robot {} is out of range, the scene has {}", text_of(one),
                                              one.robot, robot_count_text(document.robots.size())));
      continue;
    }
    const LiveRobot& body = document.robots[one.robot].body;
    if (one.mass >= body.robot->masses.size()) {
      report(Severity::warning, fmt::format("attach {}: mass {} is out of range, {} has {}", text_of(one), one.mass,
                                            body.name, body.robot->masses.size()));
      continue;
    }
    LivePerturbation spring{.robot = body.id, .mass = one.mass};
    if (one.spring) {
      spring.target = one.spring->target;
      spring.stiffness = one.spring->stiffness;
      spring.kind = Kind::spring;
    } else {
      spring.target = start_of(*body.robot, one.mass, document.configuration.environment);
      spring.stiffness = stiffest_pin(document.configuration);
      spring.kind = Kind::pin;
    }
    document.attachments.push_back({spring, resets});
  }
  send_perturbation();
}

void LiveScene::attach_perturbation() {
  if (!parts_->perturbation) return;
  parts_->edit("attach a spring");
  LivePerturbation spring = *parts_->perturbation;
  spring.kind = Kind::spring;
  parts_->document.attachments.push_back({spring, parts_->resets});
  end_perturbation();
}

void LiveScene::pin(const Hit& hit) {
  const auto now = position_of(parts_->pointed_snapshot(), hit.robot, hit.mass);
  if (!now) return;
  parts_->edit("pin a mass");
  parts_->document.attachments.push_back({{.robot = hit.robot,
                                           .mass = hit.mass,
                                           .target = *now,
                                           .stiffness = stiffest_pin(parts_->document.configuration),
                                           .kind = Kind::pin},
                                          parts_->resets});
  parts_->send_perturbation();
}

bool LiveScene::has_attachments(const std::vector<RobotId>& robots) const {
  return std::ranges::any_of(parts_->document.attachments, [&](const Attachment& one) {
    return std::ranges::find(robots, one.spring.robot) != robots.end();
  });
}

void LiveScene::remove_attachments(const std::vector<RobotId>& robots) {
  if (!has_attachments(robots)) return;
  parts_->edit("remove pins and springs");
  std::erase_if(parts_->document.attachments,
                [&](const Attachment& one) { return std::ranges::find(robots, one.spring.robot) != robots.end(); });
  parts_->send_perturbation();
}

std::vector<PerturbationDetails> LiveScene::attachments() const {
  std::vector<PerturbationDetails> all;
  for (const Attachment& one : parts_->document.attachments)
    if (auto details = parts_->details_of(one.spring)) all.push_back(*details);
  return all;
}

}  // namespace mercury
