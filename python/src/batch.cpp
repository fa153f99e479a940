// SPDX-License-Identifier: Apache-2.0
// Batch: robots that are stepped through time.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "mercury/simulation.h"
#include "python/src/array.h"
#include "python/src/bindings.h"

namespace mercury::python {
namespace {

struct Batch {
  Simulation simulation;
};

}  // namespace

void bind_batch(nb::module_& module) {
  nb::class_<Batch>(module, "Batch", "Robots that are stepped through time together, each in its own space.")
      .def(
          "__init__",
          [](Batch* self, nb::handle robots, nb::handle environment, const std::string& solver, double dt,
             double damping, const std::string& device, int threads) {
            Configuration configuration{.dt = dt,
                                        .damping = damping,
                                        .solver = solver_named(solver),
                                        .environment = environment_of(environment),
                                        .device = device_named(device)};
            configuration.device.threads = threads;
            const SharedRobots shared = robots_of(robots);
            const nb::gil_scoped_release release;
            new (self) Batch{Simulation(configuration, shared)};
          },
          nb::arg("robots"), nb::arg("environment") = nb::none(), nb::arg("solver") = "force", nb::arg("dt") = 1e-3,
          nb::arg("damping") = 0.1, nb::arg("device") = "auto", nb::arg("threads") = 0)
      .def("__len__", [](const Batch& self) { return self.simulation.size(); })
      .def_prop_ro(
          "time", [](const Batch& self) { return self.simulation.time(); }, "Simulated time [s].")
      .def(
          "step",
          [](Batch& self, std::int64_t steps) {
            const nb::gil_scoped_release release;
            self.simulation.step(steps);
          },
          nb::arg("n") = 1, "Advances every robot that has not exploded by `n` time steps.")
      .def_prop_ro(
          "positions",
          [](Batch& self) { return array_of<float>(self.simulation.shared_state(StateArray::positions), false); },
          "Positions of all masses, (masses, 3) float32 [m].")
      .def(
          "hash", [](const Batch& self, std::size_t robot) { return self.simulation.hash(robot); }, nb::arg("robot"));
}

}  // namespace mercury::python
