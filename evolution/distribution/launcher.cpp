// SPDX-License-Identifier: Apache-2.0
#include "evolution/distribution/ranks.h"

#include <cstdlib>
#include <string>

namespace mercury {

bool launched_by_mpi() {
  // mpirun of Open MPI; mpirun of MPICH and srun --mpi=pmi2; srun --mpi=pmix, which sets no size for itself.
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* value = std::getenv(size)) return std::atoi(value) > 1;
  const char* tasks = std::getenv("SLURM_NTASKS");
  return std::getenv("PMIX_RANK") && tasks && std::atoi(tasks) > 1;
}

int rank_by_launcher() {
  if (!launched_by_mpi()) return 0;
  for (const char* rank : {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"})
    if (const char* value = std::getenv(rank)) return std::atoi(value);
  return 0;
}

}  // namespace mercury
