// SPDX-License-Identifier: Apache-2.0
// A build without MPI.
#include <stdexcept>

#include "evolution/distribution/ranks.h"

namespace mercury {

struct Ranks::Parts {};

bool Ranks::launched() { return launched_by_mpi(); }
bool Ranks::available() { return false; }

Ranks::Ranks() {
  throw std::runtime_error("this build has no MPI; install libopenmpi-dev, then configure and build again");
}
Ranks::~Ranks() = default;

int Ranks::rank() const { return 0; }
int Ranks::count() const { return 1; }
int Ranks::rank_on_host() const { return 0; }
void Ranks::share(const RunSettings&) {}
void Ranks::abandon() {}
std::optional<RunSettings> Ranks::receive_settings() { return std::nullopt; }
std::unique_ptr<Assessor> Ranks::distribute(Assessor&) { return nullptr; }
bool Ranks::serve(const std::function<std::unique_ptr<Assessor>()>&, const GenomeSpace&, const std::function<bool()>&) {
  return false;
}

}  // namespace mercury
