// SPDX-License-Identifier: Apache-2.0
// What the mouse does in the window's scene: picks robots, pulls at a mass, and attaches pins and springs that stay.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/live/live_scene_parts.h"

namespace mercury {
namespace {

// Stiff enough that the robot follows the mouse, but not so stiff that the mass is torn out of the robot or the
// integration becomes unstable.
float suitable_stiffness(const LiveRobot& robot, const Configuration& configuration) {
  float stiffest = 1;
  for (const Spring& spring : robot.robot->springs)
    stiffest = std::max(stiffest, materials_of(robot)[spring.material].stiffness);
  const float per_mass = length(gravity_of(configuration.environment)) > 0 ? 60.0f : 4.0f;
  float mass = 0;  // [kg]
  for (std::size_t i = 0; i < robot.robot->masses.size(); ++i) mass += mass_of(*robot.robot, i);
  const float of_body = per_mass * mass;
  const float of_springs = 6 * stiffest * stiffness_scale_of(configuration.environment);
  const auto of_step = static_cast<float>(0.05 / (configuration.dt * configuration.dt));
  return std::max(1e-3f, std::min({of_body, of_springs, of_step}));
}

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

// Where the mass is in the snapshot.
std::optional<Vec3> position_of(const Snapshot& snapshot, RobotId robot, std::uint16_t mass) {
  const auto index = snapshot.robots->index_of(robot);
  if (!index || mass >= snapshot.positions_of(*index).size()) return std::nullopt;
  return snapshot.positions_of(*index)[mass];
}

}  // namespace

std::optional<Hit> LiveScene::pick(const render::Ray& ray) const {
  const Shown& shown = parts_->view.shown;
  const Snapshot& snapshot = parts_->pointed_snapshot();
  const auto hidden = std::make_unique<bool[]>(snapshot.robots->size());
  for (std::size_t i = 0; i < snapshot.robots->size(); ++i)  // also what is hidden in the next frame
    hidden[i] = parts_->pointed_drawn().is_hidden(i) || parts_->hidden.contains(snapshot.robots->robots[i].id);
  return mercury::pick(snapshot, parts_->pointed_drawn().offsets(), ray,
                       {.skin = shown.skin,
                        .springs = shown.springs,
                        .masses = shown.masses,
                        .cut = parts_->view.cut,
                        .hidden = {hidden.get(), snapshot.robots->size()},
                        .near = parts_->pointed_drawn().last_boxes()});
}

HitDetails LiveScene::describe(const Hit& hit) const {
  parts_->described = 30;
  parts_->physics.watch_velocities(true);
  return mercury::describe(parts_->pointed_snapshot(), hit);
}

void LiveScene::begin_perturbation(const Hit& hit, float stiffness) {
  const auto index = parts_->pointed_snapshot().robots->index_of(hit.robot);
  if (!index || hit.mass >= parts_->pointed_snapshot().positions_of(*index).size()) return;
  parts_->adopt_moment();
  const LiveRobot& robot = parts_->pointed_snapshot().robots->robots[*index];
  const float suitable = suitable_stiffness(robot, parts_->document.configuration);
  const bool usable = std::isfinite(stiffness) && stiffness > 0;
  parts_->pulls.set_by_mouse(LivePerturbation{.robot = hit.robot,
                                              .mass = hit.mass,
                                              .target = parts_->pointed_snapshot().positions_of(*index)[hit.mass],
                                              .stiffness = usable ? stiffness : suitable});
}

void LiveScene::move_perturbation(const render::Vector3& target) {
  std::optional<LivePerturbation> pull = parts_->pulls.by_mouse();
  if (!pull || !target.is_finite()) return;
  const auto index = parts_->pointed_snapshot().robots->index_of(pull->robot);
  if (!index || *index >= parts_->pointed_drawn().offsets().size()) return;
  const render::Vector3 own = target - parts_->pointed_drawn().offsets()[*index];
  pull->target = {own.x, own.y, own.z};
  parts_->pulls.set_by_mouse(pull);
}

void LiveScene::set_perturbation_stiffness(float stiffness) {
  std::optional<LivePerturbation> pull = parts_->pulls.by_mouse();
  if (!pull || !std::isfinite(stiffness) || !(stiffness > 0)) return;
  pull->stiffness = stiffness;
  parts_->pulls.set_by_mouse(pull);
}

void LiveScene::end_perturbation() { parts_->pulls.set_by_mouse({}); }

std::optional<PerturbationDetails> LiveScene::perturbation() const {
  return parts_->pulls.by_mouse() ? parts_->details_of(*parts_->pulls.by_mouse()) : std::nullopt;
}

std::optional<PerturbationDetails> LiveScene::Parts::details_of(const LivePerturbation& pull) {
  const auto index = pointed_snapshot().robots->index_of(pull.robot);
  if (!index || *index >= pointed_drawn().offsets().size() || pull.mass >= pointed_drawn().positions_of(*index).size())
    return std::nullopt;
  const render::Vector3 offset = pointed_drawn().offsets()[*index];
  const Vec3 mass = pointed_drawn().positions_of(*index)[pull.mass];
  return PerturbationDetails{.robot = pull.robot,
                             .mass = pull.mass,
                             .at = render::Vector3(mass) + offset,
                             .target = render::Vector3(pull.target) + offset,
                             .stiffness = pull.stiffness,
                             .force = pull.stiffness * length(pull.target - mass)};
}

void ScenePulls::set_by_mouse(std::optional<LivePerturbation> pull) {
  by_mouse_ = pull;
  send();
}

void ScenePulls::attach(LivePerturbation spring) {
  document_.attachments.push_back({spring, resets_});
  send();
}

bool ScenePulls::attached_to(const std::vector<RobotId>& robots) const {
  return std::ranges::any_of(document_.attachments, [&](const Attachment& one) { return is_of(one, robots); });
}

void ScenePulls::detach(const std::vector<RobotId>& robots) {
  std::erase_if(document_.attachments, [&](const Attachment& one) { return is_of(one, robots); });
  send();
}

void ScenePulls::send() {
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

void ScenePulls::before_reset(const Snapshot& now) {
  ++resets_;
  if (!std::ranges::any_of(document_.attachments, is_pin)) return;
  pins_wait_ = now.resets;
  send();
}

void ScenePulls::update(const Snapshot& now) {
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

void ScenePulls::aim_pins(const std::vector<Attachment>& before, const Snapshot& now) {
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

std::vector<Attachment> ScenePulls::attached_at(const Snapshot& moment) const {
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

void ScenePulls::attach_opened(bool complete, Messages& messages) {
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

void LiveScene::attach_perturbation() {
  if (!parts_->pulls.by_mouse()) return;
  parts_->edit("attach a spring");
  LivePerturbation spring = *parts_->pulls.by_mouse();
  spring.kind = Kind::spring;
  parts_->pulls.attach(spring);
  end_perturbation();
}

void LiveScene::pin(const Hit& hit) {
  const auto now = position_of(parts_->pointed_snapshot(), hit.robot, hit.mass);
  if (!now) return;
  parts_->edit("pin a mass");
  parts_->pulls.attach({.robot = hit.robot,
                        .mass = hit.mass,
                        .target = *now,
                        .stiffness = stiffest_pin(parts_->document.configuration),
                        .kind = Kind::pin});
}

bool LiveScene::has_attachments(const std::vector<RobotId>& robots) const { return parts_->pulls.attached_to(robots); }

void LiveScene::remove_attachments(const std::vector<RobotId>& robots) {
  if (!has_attachments(robots)) return;
  parts_->edit("remove pins and springs");
  parts_->pulls.detach(robots);
}

std::vector<PerturbationDetails> LiveScene::attachments() const {
  std::vector<PerturbationDetails> all;
  for (const Attachment& one : parts_->document.attachments)
    if (auto details = parts_->details_of(one.spring)) all.push_back(*details);
  return all;
}

}  // namespace mercury
