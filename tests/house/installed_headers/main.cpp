// SPDX-License-Identifier: Apache-2.0
#include <mercury/simulation.h>
#include <mercury/voxel.h>

// Links both libraries: 0 if they do what their headers say.
int main() {
  const mercury::Robot cube = mercury::make_voxel_robot(mercury::VoxelGrid(1, 1, 1, mercury::tissue));
  mercury::Simulation simulation({}, {&cube, 1});
  simulation.step(10);
  return cube.springs.size() == 28 && simulation.steps() == 10 ? 0 : 1;
}
