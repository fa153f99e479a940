// SPDX-License-Identifier: Apache-2.0
// The numbers of a shell's genome as data.
#pragma once

#include "mercury/shell.h"
#include "robots/parameter_table.h"

namespace mercury {

// The numbers of a genome: what validate() accepts, the origin keeps and mutate() changes.
const ParameterTable<ShellGenome>& shell_genome_table();

// Throws ParameterError if the layers are too far apart for the diameter.
void check_shell_thickness(double thickness, double diameter);

}  // namespace mercury
