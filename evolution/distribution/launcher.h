// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mercury {

// Whether this process's environment is that of one of several processes of an MPI launcher.
bool launched_by_mpi();
// The number of this process among them; 0 without a launcher.
int rank_by_launcher();

}  // namespace mercury
