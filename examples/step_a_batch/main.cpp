// PLACEHOLDER body until robots land
#include <cstdio>
#include <vector>

#include "sim/simulation.h"

int main() {
  mercury::Robot robot;
  robot.masses = {{0, 0, 0}, {0.1f, 0, 0}};
  robot.springs = {{0, 1, 1, 0.1f}};
  std::vector<mercury::Robot> robots(8, robot);
  mercury::Simulation simulation({}, robots);
  simulation.step(1000);
  for (const auto& t : simulation.telemetry()) std::printf("%.4f m\n", mercury::length(t.center_of_mass));
}
