// SPDX-License-Identifier: Apache-2.0
#include "python/src/bindings.h"

NB_MODULE(_mercury, module) {
  using namespace mercury::python;
  nanobind::set_leak_warnings(false);  // what a program still holds when it exits is no leak
  module.attr("__version__") = MERCURY_VERSION;
  bind_errors(module);
  bind_robot(module);
  bind_generators(module);
  bind_voxel(module);
  bind_environments(module);
  bind_array(module);
  bind_batch(module);
  bind_brains(module);
  bind_evaluate(module);
  bind_evolution(module);
  bind_pictures(module);
  bind_recording(module);
  bind_export(module);
}
