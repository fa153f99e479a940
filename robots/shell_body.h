// SPDX-License-Identifier: Apache-2.0
// The masses, springs, muscles and skin of a shell.
#pragma once

#include "mercury/shell.h"
#include "robots/revolved_mesh.h"

namespace mercury {

// Turns a mesh into a robot of two layers, without name and origin. The mesh must have at most max_masses / 2 vertices.
Robot shell_body(const ShellGenome& genome, const RevolvedMesh& mesh);

}  // namespace mercury
