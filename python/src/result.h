// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <vector>

#include "mercury/configuration.h"
#include "mercury/evaluator.h"

namespace mercury::python {

// What became of one robot, as Python has it.
struct Result {
  Evaluation evaluation;         // of the first trial
  std::vector<Evaluation> more;  // the other trials
  std::shared_ptr<const Configuration> configuration;
  bool has_hash = false, has_state = false;
};

void bind_result(nanobind::module_& module);

}  // namespace mercury::python
