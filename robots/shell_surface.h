// SPDX-License-Identifier: Apache-2.0
// The smooth surface of a shell, and the mesh that samples it.
#pragma once

#include "mercury/shell.h"
#include "robots/revolved_mesh.h"

namespace mercury {

// A ring's profile ends where it begins: what goes once around it is a whole number.
double once_around(const ShellGenome& genome, double count);

// 1 at the middle of a lobe, -1 between two. `s` along the profile, 0 to 1; `turns` around the axis.
double lobe_wave(const ShellGenome& genome, double s, double turns);

// In units of half the diameter. The genome must be valid, and outlive the mesh.
RevolvedMesh mesh_of(const ShellGenome& genome);

}  // namespace mercury
