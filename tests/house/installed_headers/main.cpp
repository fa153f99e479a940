#include "sim/robot.h"
#include "sim/simulation.h"

// Links both libraries: 0 if they do what their headers say.
int main() {
  mercury::Robot robot;
  robot.masses = {{0, 0, 0}, {1, 0, 0}};
  robot.springs = {{0, 1, mercury::tissue, 1}};
  mercury::Simulation simulation({}, {&robot, 1});
  simulation.step(10);
  return simulation.steps() == 10 ? 0 : 1;
}
