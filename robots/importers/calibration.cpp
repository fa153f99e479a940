// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/calibration.h"

#include <cmath>

#include "mercury/error.h"

namespace mercury {
namespace {

constexpr double shortest_time_step = 1e-4, longest_time_step = 1e-3;  // [s]
constexpr double share_of_limit = 1.0 / 3;

void require(bool holds, const char* what, const char* rule) {
  if (!holds) throw InputError(what, rule);
}

void validate(const BeamModel& model) {
  const auto positive = [](double value, const char* what) {
    require(std::isfinite(value) && value > 0, what, "must be a finite number above 0");
  };
  const auto not_negative = [](double value, const char* what) {
    require(std::isfinite(value) && value >= 0, what, "must be a finite number of at least 0");
  };
  positive(model.elastic_modulus, "elastic modulus");
  positive(model.density, "density");
  positive(model.edge, "edge");
  not_negative(model.gravity, "gravity");
  not_negative(model.slow_damping, "damping");
  not_negative(model.aggregate_drag, "drag coefficient");
  require(model.thickness >= 0, "thickness", "must be at least 0 voxels");
}

void require_range(const Calibration& calibration, double stiffness) {
  constexpr double largest = 1e30, smallest = 1e-30;  // far within a float
  const auto fits = [&](double value) { return std::isfinite(value) && value < largest; };
  for (const double value : {calibration.length_scale, calibration.time_scale, stiffness, calibration.time_step})
    require(fits(value) && value > smallest, "elastic modulus, density and edge",
            "give a robot whose numbers are too large or too small to simulate");
  for (const double value :
       {calibration.gravity, calibration.damping, calibration.contact_stiffness, calibration.drag_coefficient})
    require(fits(value), "gravity, damping and drag", "give numbers that are too large to simulate");
}

// The highest frequency of an endless lattice, at which neighboring layers move against each other: every mass has 4
// springs per edge, 8 per face diagonal and 16/3 per space diagonal along that motion [1/s].
double highest_frequency(double stiffness) { return std::sqrt(52.0 / 3 * stiffness); }

double rounded_down(double step) {
  double decade = 1;
  while (decade > step) decade /= 10;
  while (decade * 10 <= step) decade *= 10;
  for (const int digit : {5, 2})
    if (digit * decade <= step) return digit * decade;
  return decade;
}

}  // namespace

double slice_stiffness(int thickness) {
  if (thickness <= 0) return 2.7;
  const double n = thickness, m = n + 1;
  // Elastic energy of a slice that is stretched by 1 and narrows by e: c - b e + a e^2, where it takes the best e.
  const double a = 4 * n * m + 28.0 / 3 * n * n, b = 4 * n * m + 16.0 / 3 * n * n,
               c = m * m + 2 * n * m + 4.0 / 3 * n * n;
  return (c - b * b / (4 * a)) / (m * m);
}

double gravity_time_scale(double edge) { return std::sqrt(calibrated_edge / edge); }

Calibration calibrate(const BeamModel& model, std::optional<double> time_scale) {
  validate(model);
  // (speed of waves / edge)^2 = E / (density edge^2), the square of a frequency [1/s2].
  const double squared_rate = model.elastic_modulus / (model.density * model.edge * model.edge);
  const double stiffness = squared_rate / slice_stiffness(model.thickness);
  const auto step_at = [&](double scale) { return share_of_limit * 2 / highest_frequency(stiffness) * scale; };
  double scale = 1;
  if (time_scale) {
    require(std::isfinite(*time_scale) && *time_scale > 0, "time scale", "must be a finite number above 0");
    scale = *time_scale;
  } else if (step_at(1) < shortest_time_step) {
    scale = shortest_time_step / step_at(1) * (1 + 1e-12);  // so that rounding does not take a step below
  }
  Calibration found{.length_scale = calibrated_edge / model.edge, .time_scale = scale};
  const double squared_scale = scale * scale;
  require_range({.length_scale = found.length_scale, .time_scale = scale, .time_step = 1}, stiffness / squared_scale);
  found.stiffness_per_modulus = stiffness / model.elastic_modulus / squared_scale;
  found.gravity = model.gravity * found.length_scale / squared_scale;
  found.damping = 2 * model.slow_damping * std::sqrt(squared_rate) / scale;
  found.contact_stiffness = squared_rate / squared_scale;
  // A voxel of 0.1 m in a thick body weighs 1 kg, as water of 1000 kg/m3. In thinner ones it has more masses.
  const double n = model.thickness, masses_per_voxel = n > 0 ? (n + 1) * (n + 1) / (n * n) : 1;
  found.drag_coefficient = 2 * model.aggregate_drag / model.density * masses_per_voxel;
  found.largest_time_step = 2 / highest_frequency(stiffness) * scale;
  found.time_step = rounded_down(std::fmin(step_at(scale), longest_time_step));
  require_range(found, stiffness / squared_scale);
  return found;
}

}  // namespace mercury
