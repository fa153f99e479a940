// SPDX-License-Identifier: Apache-2.0
#include "app/scene/materials_now.h"

#include <cmath>

namespace mercury {

std::vector<MaterialNow> materials_at(const Simulation& simulation, std::size_t robot, double time) {
  const float scale = stiffness_scale_of(simulation.configuration().environment);
  std::vector<MaterialNow> now;
  const std::size_t count = materials_of(simulation.robot(robot)).size();
  for (std::size_t id = 0; id < count; ++id) {
    const Material m = simulation.material(robot, static_cast<MaterialId>(id));
    const double angle = static_cast<double>(m.frequency) * time + static_cast<double>(m.phase);
    now.push_back(
        {scale * m.stiffness, 1 + m.amplitude * static_cast<float>(std::sin(std::remainder(angle, 2 * M_PI)))});
  }
  return now;
}

}  // namespace mercury
