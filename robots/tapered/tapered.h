// SPDX-License-Identifier: Apache-2.0
// The numbers of a tapered robot's genome as data, and its cells.
#pragma once

#include <string_view>
#include <vector>

#include "mercury/tapered.h"
#include "robots/hexahedra.h"
#include "robots/parameter_table.h"

namespace mercury {

// What validate() accepts, the origin keeps and evolution changes.
const ParameterTable<TaperedGenome>& tapered_genome_table();

// What a mutation may change of the body, and of its muscles.
bool is_of_body(std::string_view number);
bool is_of_muscles(std::string_view number);

// mutate() for the numbers that `chosen` accepts, with a `tail` as of mutate_muscle_laws().
TaperedGenome mutate(const TaperedGenome& genome, double strength, std::uint64_t seed, bool (*chosen)(std::string_view),
                     int tail = 0);

// The cells of a robot by its origin.
std::vector<Hexahedron> tapered_cells(const Robot& robot);

}  // namespace mercury
