// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "evolution/selection/behavior.h"
#include "mercury/distance.h"
#include "mercury/muscle_laws.h"
#include "mercury/quantity.h"
#include "mercury/spread.h"

namespace mercury {
namespace {

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

double seconds(const Trial& trial) { return static_cast<double>(trial.evaluation.steps) * trial.configuration.dt; }

Vec3 center_at_end(const Trial& trial) { return trial.evaluation.end.center_of_mass; }

Vec3 displacement(const Trial& trial) {
  return trial.evaluation.end.center_of_mass - trial.evaluation.start.center_of_mass;
}

double distance(const Trial& trial) {
  const Evaluation& evaluation = trial.evaluation;
  return distance_between(evaluation.start.center_of_mass, evaluation.end.center_of_mass,
                          trial.configuration.environment);
}

template <float Vec3::*axis>
double speed_along(const Trial& trial) {
  return ratio(displacement(trial).*axis, seconds(trial));
}

double length_at_rest(const Trial& trial) {
  const Vec3 box = box_of(trial.robot);
  return std::max({box.x, box.y, box.z});
}

double target_distance(const Trial& trial) {
  return distance_between(center_at_end(trial), trial.configuration.environment.target,
                          trial.configuration.environment);
}

double target_approach(const Trial& trial) {
  const Environment& environment = trial.configuration.environment;
  return distance_between(trial.evaluation.start.center_of_mass, environment.target, environment) -
         target_distance(trial);
}

double reached(const Trial& trial) {
  const double nearest = trial.evaluation.nearest, reach = static_cast<double>(trial.configuration.environment.reach);
  if (std::isnan(nearest)) return nearest;
  return nearest <= (reach > 0 ? reach : length_at_rest(trial) / 2) ? 1 : 0;
}

double straightness(const Trial& trial) {
  return std::min(1.0, ratio(distance(trial), trial.evaluation.path));  // both are rounded
}

double direction(const Trial& trial) {
  constexpr double degrees = 180 / 3.14159265358979323846;
  const Vec3 d = displacement(trial);
  return std::atan2(static_cast<double>(d.y), static_cast<double>(d.x)) * degrees;
}

double height(const Trial& trial) {
  return std::max(0.0, trial.evaluation.highest - static_cast<double>(trial.evaluation.start.center_of_mass.z));
}

double muscle_share(const Trial& trial) {
  const std::span<const Material> materials = materials_of(trial.robot);
  const auto moves = [&](const Spring& spring) { return materials[spring.material].amplitude != 0; };
  return ratio(static_cast<double>(std::ranges::count_if(trial.robot.springs, moves)),
               static_cast<double>(trial.robot.springs.size()));
}

double materials_in_use(const Trial& trial) {
  const std::vector<bool> used = base_materials_in_use(trial.robot);
  return static_cast<double>(std::ranges::count(used, true));
}

double along(const Trial& trial, Vec3 from, Vec3 to) {
  return distance_between(from, to, trial.configuration.environment);
}

// NaN where the way is unknown.
double cruise_speed(const Trial& trial) {
  const Evaluation& evaluation = trial.evaluation;
  return ratio(along(trial, evaluation.at_third, center_at_end(trial)), 2 * evaluation.third);
}

double is_steady(const Trial& trial) {
  constexpr double most_apart = 0.2;
  const Evaluation& evaluation = trial.evaluation;
  const double second = along(trial, evaluation.at_third, evaluation.at_two_thirds),
               last = along(trial, evaluation.at_two_thirds, center_at_end(trial));
  if (std::isnan(second + last)) return second + last;
  return std::abs(second - last) <= most_apart * std::max(second, last) ? 1 : 0;
}

double efficiency(const Trial& trial) {
  return ratio(distance(trial), trial.net_efficiency ? trial.evaluation.work : trial.evaluation.positive_work);
}

// name, unit, help, of the body alone, usual range, value, whether it grows with how far the robot gets, whether
// it needs EvaluationRequest::folding or upright, whether it is a share of the trials
constexpr Quantity table[] = {
    {"distance", "m", "how far the center of mass went from start to end; on land along the ground", false, 0, 5,
     distance, true},
    {"speed", "m/s", "distance per time of the trial", false, 0, 0.5,
     [](const Trial& trial) { return ratio(distance(trial), seconds(trial)); }, true},
    {"cruise_speed", "m/s", "distance per time after the first third of the trial", false, 0, 0.5, cruise_speed, true},
    {"cruise_lengths", "1/s", "cruise_speed per length: body lengths per second", false, 0, 1,
     [](const Trial& trial) { return ratio(cruise_speed(trial), length_at_rest(trial)); }, true},
    {"steady", "", "1 if the speeds in the second and the last third of the trial agree within 20 %, else 0", false, 0,
     1, is_steady},
    {"speed_x", "m/s", "displacement along x per time of the trial", false, -0.5, 0.5, speed_along<&Vec3::x>, true},
    {"speed_y", "m/s", "displacement along y per time of the trial", false, -0.5, 0.5, speed_along<&Vec3::y>, true},
    {"speed_z", "m/s", "displacement along z per time of the trial", false, -0.5, 0.5, speed_along<&Vec3::z>, true},
    {"path", "m", "length of the path of the center of mass", false, 0, 5,
     [](const Trial& trial) { return trial.evaluation.path; }, true},
    {"straightness", "", "distance per path: 1 = along a line", false, 0, 1, straightness, true},
    {"direction", "degrees", "of the displacement in the x-y plane: 0 = along x, 90 = along y", false, -180, 180,
     direction},
    {"target_distance", "m", "distance of the center of mass from the target at the end; on land along the ground",
     false, 0, 5, target_distance},
    {"target_approach", "m", "by how much target_distance is less than at the start", false, 0, 5, target_approach},
    {"target_nearest", "m", "least distance of the center of mass from the target; on land along the ground", false, 0,
     5, [](const Trial& trial) { return trial.evaluation.nearest; }},
    {"reached", "", "1 if target_nearest came within --reach, else 0; of several trials their share", false, 0, 1,
     reached, false, false, false, true},
    {"height", "m", "how far the center of mass rose above its start", false, 0, 1, height},
    {"work", "J", "that the muscles did, less what they took back", false, 0, 100,
     [](const Trial& trial) { return trial.evaluation.work; }},
    {"positive_work", "J", "that the muscles did while their power was positive", false, 0, 100,
     [](const Trial& trial) { return trial.evaluation.positive_work; }},
    {"absolute_work", "J", "positive_work and what the muscles took back", false, 0, 100,
     [](const Trial& trial) { return trial.evaluation.absolute_work(); }},
    {"efficiency", "m/J", "distance per positive_work; 0 where the muscles did none", false, 0, 1, efficiency, true},
    {"strain", "", "largest strain of a spring", false, 0, 2,
     [](const Trial& trial) { return trial.evaluation.largest_strain; }},
    {"strained_share", "", "largest share of the springs that were strained by more than half at the same time", false,
     0, 1, [](const Trial& trial) { return trial.evaluation.strained_share; }},
    {"inverted", "", "largest share of the body that was inside out; unknown unless the trial measures folding", false,
     0, 1, [](const Trial& trial) { return trial.evaluation.inverted; }, false, true},
    {"overlap", "", "largest share of the masses that were within other parts of the body; unknown as inverted", false,
     0, 1, [](const Trial& trial) { return trial.evaluation.overlap; }, false, true},
    {"upright", "", "cosine between the body's up axis and the vertical, mean over the trial; unknown unless measured",
     false, -1, 1, [](const Trial& trial) { return trial.evaluation.upright; }, false, false, true},
    {"seconds", "s", "time of the trial", false, 0, 10, seconds},
    {"body_lengths", "", "distance per length", false, 0, 5,
     [](const Trial& trial) { return ratio(distance(trial), length_at_rest(trial)); }, true},
    {"masses", "", "number of masses", true, 0, 200,
     [](const Trial& trial) { return static_cast<double>(trial.robot.masses.size()); }},
    {"springs", "", "number of springs", true, 0, 2000,
     [](const Trial& trial) { return static_cast<double>(trial.robot.springs.size()); }},
    {"length", "m", "longest side of the box around the body at rest", true, 0, 1, length_at_rest},
    {"body_height", "m", "height of the body at rest", true, 0, 1,
     [](const Trial& trial) { return static_cast<double>(box_of(trial.robot).z); }},
    {"size", "m3", "volume inside the skin at rest", true, 0, 0.1,
     [](const Trial& trial) { return volume_of(trial.robot); }},
    {"muscle_share", "", "share of the springs that are muscles", true, 0, 1, muscle_share},
    {"symmetry", "", "how well the body equals its mirror image in y", true, 0, 1,
     [](const Trial& trial) { return mirror_symmetry(trial.robot); }},
    {"materials", "", "number of base materials in use", true, 0, 22, materials_in_use},
};

}  // namespace

std::span<const Quantity> quantities() { return table; }

std::vector<std::string> names_of_quantities() {
  std::vector<std::string> names;
  for (const Quantity& quantity : quantities()) names.emplace_back(quantity.name);
  return names;
}

std::optional<std::size_t> find_quantity(std::string_view name) {
  const auto* found = std::ranges::find(table, name, &Quantity::name);
  if (found == std::end(table)) return std::nullopt;
  return static_cast<std::size_t>(found - std::begin(table));
}

double together(const Quantity& quantity, std::vector<double> values) {
  return quantity.is_share ? mean_and_error(values).median : median_of(std::move(values));
}

std::vector<double> quantities_of(const Trial& trial, std::span<const double> of_same_robot) {
  std::vector<double> values;
  values.reserve(std::size(table));
  for (const Quantity& quantity : table)
    values.push_back(quantity.of_body && !of_same_robot.empty() ? of_same_robot[values.size()] : quantity.value(trial));
  return values;
}

}  // namespace mercury
