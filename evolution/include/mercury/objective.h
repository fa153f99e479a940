// SPDX-License-Identifier: Apache-2.0
// What a search looks for: formulas of the quantities of a trial. More is better.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mercury/environment.h"

namespace mercury {

// A formula such as "distance - 0.1 * work", or the name of a custom objective, whose scores a program gives
// (mercury/custom.h). Copies share the parsed formula; several threads may use one objective.
class Objective {
 public:
  // Throws ParameterError("objective", ...) that says where the formula is wrong and, for an unknown name, which names
  // there are or which one was meant.
  explicit Objective(const std::string& formula);

  const std::string& formula() const { return formula_; }
  bool is_custom() const { return !parsed_; }
  // Its value; `values` has one number per quantity, in the order of quantities(). NaN and infinities become
  // worst_score: what divides by zero does not win. Throws std::invalid_argument for another number of values, and
  // std::logic_error for a custom objective.
  double score(std::span<const double> values) const;
  // Indices of the quantities that the formula names, ascending.
  const std::vector<std::size_t>& uses() const;
  // 'the objective "1/0" is not a finite number', for a score that is worst_score.
  std::string undefined_text() const;

 private:
  struct Parsed;
  std::string formula_;
  std::shared_ptr<const Parsed> parsed_;
};

// Whether it names a quantity that only EvaluationRequest::folding measures.
bool uses_folding(const Objective& objective);
// The same of EvaluationRequest::upright.
bool uses_upright(const Objective& objective);

// Why an objective means nothing in an environment: it grows with how far a robot gets, and none can move itself there.
// Empty if it means something. Runs of earlier versions may have such objectives.
std::string why_meaningless(const Objective& objective, const Environment& environment);

}  // namespace mercury
