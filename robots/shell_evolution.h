// SPDX-License-Identifier: Apache-2.0
// The numbers of a shell's genome as data, and its mutation and crossover as the registry wants them.
#pragma once

#include <cstdint>
#include <string>

#include "mercury/generator.h"
#include "mercury/shell.h"
#include "robots/parameter_table.h"

namespace mercury {

// The numbers of a genome: what validate() accepts, the origin keeps and mutate() changes.
const ParameterTable<ShellGenome>& shell_genome_table();

// Throws ParameterError if the layers are too far apart for the diameter.
void check_shell_thickness(double thickness, double diameter);

// The genome of a robot's origin. Throws InputError("/origin...") if it holds none.
ShellGenome shell_genome_in(const Robot& robot);

// Generator::mutate and Generator::cross of shells.
Robot mutate_shell_robot(const Robot& parent, const MutationRequest& request, const std::string& name);
Robot cross_shell_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name);

}  // namespace mercury
