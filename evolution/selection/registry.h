// SPDX-License-Identifier: Apache-2.0
// The algorithms that registry.cpp lists. Each file of an algorithm describes it.
#pragma once

#include "mercury/algorithm.h"

namespace mercury {

// Throws ParameterError.
void validate(const AlgorithmSettings& settings);

AlgorithmDescription ga();
AlgorithmDescription afpo();
AlgorithmDescription alps();
AlgorithmDescription nsga2();
AlgorithmDescription neat();
AlgorithmDescription map_elites();
AlgorithmDescription novelty_search();
AlgorithmDescription cma_es();
AlgorithmDescription cma_me();
AlgorithmDescription sep_cma_es();
AlgorithmDescription random_search();
// Of custom algorithms (mercury/custom.h), without and with axes. They are in no list.
AlgorithmDescription custom_algorithm();
AlgorithmDescription custom_map();

}  // namespace mercury
