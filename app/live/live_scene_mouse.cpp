// SPDX-License-Identifier: Apache-2.0
// What the mouse does in the window's scene: picks robots and applies a force to a mass.
#include <algorithm>
#include <cmath>

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
  const float of_body = per_mass * static_cast<float>(robot.robot->masses.size());
  const float of_springs = 6 * stiffest * stiffness_scale_of(configuration.environment);
  const auto of_step = static_cast<float>(0.05 / (configuration.dt * configuration.dt));
  return std::max(1e-3f, std::min({of_body, of_springs, of_step}));
}

}  // namespace

std::optional<Hit> LiveScene::pick(const render::Ray& ray) const {
  const Shown& shown = parts_->view.shown;
  const Snapshot& snapshot = parts_->pointed_snapshot();
  const auto hidden = std::make_unique<bool[]>(snapshot.robots->size());
  for (std::size_t i = 0; i < snapshot.robots->size(); ++i)
    hidden[i] = parts_->hidden.contains(snapshot.robots->robots[i].id);
  return mercury::pick(snapshot, parts_->pointed_picture().offsets(), ray,
                       {.skin = shown.skin,
                        .springs = shown.springs,
                        .masses = shown.masses,
                        .cut = parts_->view.cut,
                        .hidden = {hidden.get(), snapshot.robots->size()}});
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
  parts_->perturbation = LivePerturbation{.robot = hit.robot,
                                          .mass = hit.mass,
                                          .target = parts_->pointed_snapshot().positions_of(*index)[hit.mass],
                                          .stiffness = usable ? stiffness : suitable};
  parts_->send_perturbation();
}

void LiveScene::move_perturbation(const render::Vector3& target) {
  if (!parts_->perturbation || !target.is_finite()) return;
  const auto index = parts_->pointed_snapshot().robots->index_of(parts_->perturbation->robot);
  if (!index || *index >= parts_->pointed_picture().offsets().size()) return;
  const render::Vector3 own = target - parts_->pointed_picture().offsets()[*index];
  parts_->perturbation->target = {own.x, own.y, own.z};
  parts_->send_perturbation();
}

void LiveScene::set_perturbation_stiffness(float stiffness) {
  if (!parts_->perturbation || !std::isfinite(stiffness) || !(stiffness > 0)) return;
  parts_->perturbation->stiffness = stiffness;
  parts_->send_perturbation();
}

void LiveScene::end_perturbation() {
  parts_->perturbation.reset();
  parts_->send_perturbation();
}

std::optional<PerturbationDetails> LiveScene::perturbation() const {
  return parts_->perturbation ? parts_->details_of(*parts_->perturbation) : std::nullopt;
}

std::optional<PerturbationDetails> LiveScene::Parts::details_of(const LivePerturbation& pull) {
  const auto index = pointed_snapshot().robots->index_of(pull.robot);
  if (!index || *index >= pointed_picture().offsets().size() ||
      pull.mass >= pointed_picture().positions_of(*index).size())
    return std::nullopt;
  const render::Vector3 offset = pointed_picture().offsets()[*index];
  const Vec3 mass = pointed_picture().positions_of(*index)[pull.mass];
  return PerturbationDetails{.robot = pull.robot,
                             .mass = pull.mass,
                             .at = render::Vector3(mass) + offset,
                             .target = render::Vector3(pull.target) + offset,
                             .stiffness = pull.stiffness,
                             .force = pull.stiffness * length(pull.target - mass)};
}

}  // namespace mercury
