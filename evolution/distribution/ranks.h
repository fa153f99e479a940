// SPDX-License-Identifier: Apache-2.0
// One evolution on several hosts, by MPI: rank 0 makes the children and selects, all ranks grow and try a share of
// them; genomes and scores travel. An assessment depends on the genome alone, so the lineage is the same for any number
// of ranks on one kind of device.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "mercury/assessor.h"
#include "mercury/genome.h"
#include "mercury/run_folder.h"

namespace mercury {

// Whether this process's environment is that of one of several processes of an MPI launcher.
bool launched_by_mpi();
// The number of this process among them; 0 without a launcher.
int rank_by_launcher();

// The processes that an MPI launcher (mpirun, srun) started together. Make at most one object per process.
class Ranks {
 public:
  // Whether a launcher started this process as one of several.
  static bool launched();
  // Whether this build has MPI.
  static bool available();

  // Joins the others. Throws std::runtime_error if this build has no MPI, or MPI does not start.
  Ranks();
  // Rank 0 ends the others' serve().
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const;
  int count() const;
  int rank_on_host() const;  // 0, 1, ... among those on this machine

  // Rank 0 gives the settings of its run to all others. If rank 0 calls abandon() instead, the others get nothing.
  void share(const RunSettings& settings);
  void abandon();
  // On the others: the settings.
  std::optional<RunSettings> receive_settings();

  // For rank 0: an assessor that deals the candidates out to all ranks, its own among them. Throws DeviceError that
  // names the rank whose device failed. `local` and the ranks must outlive it.
  std::unique_ptr<Assessor> distribute(Assessor& local);
  // For the others: assesses what rank 0 sends, until it ends. `make_assessor` is called once. What it or the assessor
  // throws goes to rank 0. Returns false if rank 0 was lost: it says nothing after `interrupted` has become true.
  bool serve(const std::function<std::unique_ptr<Assessor>()>& make_assessor, const GenomeSpace& space,
             const std::function<bool()>& interrupted);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
