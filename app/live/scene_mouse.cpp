// SPDX-License-Identifier: Apache-2.0
#include "app/live/scene_mouse.h"

#include <algorithm>
#include <cmath>

#include "app/live/drawn_scene.h"
#include "app/live/scene_comparison.h"
#include "app/live/scene_core.h"
#include "app/live/scene_selection.h"

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

}  // namespace

void SceneMouse::update() {
  if (described_ > 0 && --described_ == 0) core_.physics().watch_velocities(false);
}

bool SceneMouse::points_at_second() const {
  return pointed_second_ && comparison_.second_drawn() && core_.snapshot().second;
}
const Snapshot& SceneMouse::pointed_snapshot() const {
  return points_at_second() ? *core_.snapshot().second : core_.snapshot();
}
const DrawnScene& SceneMouse::pointed_drawn() const {
  return points_at_second() ? *comparison_.second_drawn() : drawn_;
}

std::optional<Hit> SceneMouse::pick(const render::Ray& ray) const {
  const Shown& shown = core_.view().shown;
  const Snapshot& snapshot = pointed_snapshot();
  const auto hidden = std::make_unique<bool[]>(snapshot.robots->size());
  for (std::size_t i = 0; i < snapshot.robots->size(); ++i)  // also what is hidden in the next frame
    hidden[i] = pointed_drawn().is_hidden(i) || selection_.is_hidden(snapshot.robots->robots[i].id);
  return mercury::pick(snapshot, pointed_drawn().offsets(), ray,
                       {.skin = shown.skin,
                        .springs = shown.springs,
                        .masses = shown.masses,
                        .cut = core_.view().cut,
                        .hidden = {hidden.get(), snapshot.robots->size()},
                        .near = pointed_drawn().last_boxes()});
}

HitDetails SceneMouse::describe(const Hit& hit) const {
  described_ = 30;
  core_.physics().watch_velocities(true);
  return mercury::describe(pointed_snapshot(), hit);
}

void SceneMouse::begin_perturbation(const Hit& hit, float stiffness) {
  const auto now = position_of(pointed_snapshot(), hit.robot, hit.mass);
  if (!now) return;
  core_.adopt_moment();
  const LiveRobots& robots = *pointed_snapshot().robots;
  const bool usable = std::isfinite(stiffness) && stiffness > 0;
  const float suitable = suitable_stiffness(robots.robots[*robots.index_of(hit.robot)], core_.document().configuration);
  core_.perturbations().set_by_mouse(LivePerturbation{
      .robot = hit.robot, .mass = hit.mass, .target = *now, .stiffness = usable ? stiffness : suitable});
}

void SceneMouse::move_perturbation(const render::Vector3& target) {
  std::optional<LivePerturbation> pull = core_.perturbations().by_mouse();
  if (!pull || !target.is_finite()) return;
  const auto index = pointed_snapshot().robots->index_of(pull->robot);
  if (!index || *index >= pointed_drawn().offsets().size()) return;
  const render::Vector3 own = target - pointed_drawn().offsets()[*index];
  pull->target = {own.x, own.y, own.z};
  core_.perturbations().set_by_mouse(pull);
}

void SceneMouse::set_perturbation_stiffness(float stiffness) {
  std::optional<LivePerturbation> pull = core_.perturbations().by_mouse();
  if (!pull || !std::isfinite(stiffness) || !(stiffness > 0)) return;
  pull->stiffness = stiffness;
  core_.perturbations().set_by_mouse(pull);
}

void SceneMouse::end_perturbation() { core_.perturbations().set_by_mouse({}); }

std::optional<PerturbationDetails> SceneMouse::perturbation() const {
  return core_.perturbations().by_mouse() ? details_of(*core_.perturbations().by_mouse()) : std::nullopt;
}

std::optional<PerturbationDetails> SceneMouse::details_of(const LivePerturbation& pull) const {
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

void SceneMouse::attach_perturbation() {
  if (!core_.perturbations().by_mouse()) return;
  core_.edit("attach a spring");
  LivePerturbation spring = *core_.perturbations().by_mouse();
  spring.kind = LivePerturbation::Kind::spring;
  core_.perturbations().attach(spring);
  end_perturbation();
}

void SceneMouse::pin(const Hit& hit) {
  const auto now = position_of(pointed_snapshot(), hit.robot, hit.mass);
  if (!now) return;
  core_.edit("pin a mass");
  core_.perturbations().pin(hit.robot, hit.mass, *now);
}

bool SceneMouse::has_attachments(const std::vector<RobotId>& robots) const {
  return core_.perturbations().attached_to(robots);
}

void SceneMouse::remove_attachments(const std::vector<RobotId>& robots) {
  if (!has_attachments(robots)) return;
  core_.edit("remove pins and springs");
  core_.perturbations().detach(robots);
}

std::vector<PerturbationDetails> SceneMouse::attachments() const {
  std::vector<PerturbationDetails> all;
  for (const Attachment& one : core_.document().attachments)
    if (auto details = details_of(one.spring)) all.push_back(*details);
  return all;
}

}  // namespace mercury
