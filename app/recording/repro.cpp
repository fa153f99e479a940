// SPDX-License-Identifier: Apache-2.0
#include "app/recording/repro.h"

#include <algorithm>

#include "mercury/robot_file.h"

namespace mercury {

bool is_repro_name(const std::filesystem::path& path) { return extension_of(path) == ".repro"; }

Simulation start_of(const Repro& repro, const Device& device) {
  Configuration configuration = repro.configuration;
  configuration.device = device;
  Simulation simulation(configuration, std::span(&repro.robot, 1));
  simulation.set_clock(repro.clock);
  simulation.set_state(0, repro.state);
  simulation.set_perturbations(repro.perturbations);
  return simulation;
}

void ReproChanges::apply(Simulation& simulation) {
  for (; next_step() <= simulation.steps(); ++next_) {
    const ReproChange& change = repro_.changes[next_];
    if (change.configuration) {
      Configuration configuration = *change.configuration;
      configuration.device = simulation.configuration().device;
      simulation.configure(configuration);
    }
    if (change.materials) {
      std::vector<Material> table = simulation.materials();
      std::ranges::copy(*change.materials, table.begin());
      simulation.set_materials(table);
    }
    if (change.perturbations) simulation.set_perturbations(*change.perturbations);
  }
}

}  // namespace mercury
