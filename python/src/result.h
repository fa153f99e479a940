// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "mercury/evaluator.h"
#include "mercury/simulation.h"

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

// Nothing if `what` is neither a Result nor a sequence of Results.
std::vector<const Result*> results_of(nanobind::handle what);

// Robots that are to be tried again as they were: the same start, time and numbers.
struct Repetition {
  Simulation simulation;
  double seconds = 0;
};
// Of one call of evaluate(). Throws InputError.
Repetition repetition_of(const std::vector<const Result*>& results);

void bind_result(nanobind::module_& module);

}  // namespace mercury::python
