// SPDX-License-Identifier: Apache-2.0
#include "sim/robot_notes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "mercury/parallel.h"
#include "sim/physics/measures.h"

namespace mercury {
namespace {

// Says that XPBD softens springs by more than a twentieth; empty if it does not.
std::string softening_note(std::span<const std::shared_ptr<const Robot>> robots, const Configuration& configuration) {
  if (configuration.solver != Solver::xpbd) return {};
  constexpr double allowed = 0.05;
  std::vector<double> softening(robots.size());
  parallel_for(0, robots.size(), [&](std::size_t i) {
    const bool known = i > 0 && robots[i] == robots[i - 1];
    softening[i] = known ? 0 : xpbd_softening(*robots[i], configuration);
  });
  const double most = softening.empty() ? 0 : std::ranges::max(softening);
  if (most <= allowed) return {};
  const double dt = configuration.dt * std::sqrt(allowed / most);
  char text[200];
  std::snprintf(
      text, sizeof text,
      "XPBD makes the stiffest spring %.2g times as stiff at this time step as it is; %.1g s or --substeps %d "
      "would be within 5 %%",
      1 / (1 + most), dt, static_cast<int>(std::min(1e6, std::ceil(configuration.dt / dt))));
  return text;
}

std::string stability_note(std::span<const std::shared_ptr<const Robot>> robots, const Configuration& configuration) {
  std::vector<double> allowed(robots.size(), std::numeric_limits<double>::infinity());
  parallel_for(0, robots.size(), [&](std::size_t i) {
    if (i == 0 || robots[i] != robots[i - 1]) allowed[i] = exceeded_dt(*robots[i], configuration);
  });
  const auto least = std::ranges::min_element(allowed);
  if (least == allowed.end() || std::isinf(*least)) return {};
  const std::string& name = robots[static_cast<std::size_t>(least - allowed.begin())]->name;
  char text[200];
  std::snprintf(text, sizeof text,
                "%.60s vibrates too fast for this time step, %.3g s: the force solver is stable up to %.2g s; give a "
                "shorter one, or --substeps %d",
                name.empty() ? "a robot" : name.c_str(), configuration.dt, *least,
                static_cast<int>(std::min(1e6, std::floor(configuration.dt / *least) + 1)));
  return text;
}

}  // namespace

std::vector<std::string> robot_notes(std::span<const std::shared_ptr<const Robot>> robots,
                                     const Configuration& configuration) {
  std::vector<std::string> notes;
  for (std::string note : {softening_note(robots, configuration), stability_note(robots, configuration)})
    if (!note.empty()) notes.push_back(std::move(note));
  return notes;
}

}  // namespace mercury
