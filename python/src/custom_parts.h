// SPDX-License-Identifier: Apache-2.0
// Algorithms and objectives in Python, as an Evolution has them.
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <vector>

#include "mercury/algorithm.h"
#include "mercury/assessor.h"
#include "mercury/evolution.h"

namespace mercury::python {

namespace nb = nanobind;

// What became of some genomes, in their order.
struct Assessed {
  std::vector<GenomePointer> genomes;
  std::vector<Assessment> assessments;
};

// `selection` = a Selection of mercurysim/_custom.py.
std::unique_ptr<Algorithm> algorithm_of_python(const AlgorithmSettings& settings, nb::handle selection);

// Gives the assessments of `assessor` the scores of objectives in Python. `scoring` = a Scoring of
// mercurysim/_custom.py.
std::unique_ptr<Assessor> scored_by_python(std::unique_ptr<Assessor> assessor, const EvolutionSettings& settings,
                                           nb::handle scoring);

void bind_custom_parts(nb::module_& module);

}  // namespace mercury::python
