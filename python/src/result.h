// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "mercury/evaluator.h"

namespace mercury::python {

// What became of one robot, as Python has it.
struct Result {
  Evaluation evaluation;                             // of the first trial
  std::vector<Evaluation> more;                      // the other trials
  std::shared_ptr<const EvaluationRequest> request;  // how it was tried
  bool has_hash = false, has_state = false;
  std::size_t trial = 0;  // of the first one

  bool was_stepped() const { return evaluation.robot && evaluation.failure.empty(); }
};

void bind_result(nanobind::module_& module);

}  // namespace mercury::python
