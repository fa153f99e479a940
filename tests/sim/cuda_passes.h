// SPDX-License-Identifier: Apache-2.0
// Passes through shared memory that an arrangement takes, counted from its lists alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include "sim/cuda/face_tiles.h"

namespace mercury::cuda {

// The passes of an access to each column of each face tile. Lanes that read one mass get it together, so a read takes
// as many passes as the busiest bank has different masses. An addition takes as many as it has corners.
struct Passes {
  std::uint32_t reads = 0, additions = 0;
  std::uint32_t all() const { return 6 * reads + 3 * additions; }  // of x, v and sum
};

inline Passes passes_of(const std::vector<FacePair>& pairs) {
  Passes passes;
  for (std::size_t first = 0; first < pairs.size(); first += lanes) {
    std::array<std::array<std::multiset<int>, lanes>, 4> uses;
    for (std::size_t i = first; i < first + lanes; ++i) {
      const FacePair& p = pairs[i];
      if (p == padding_faces) continue;
      const std::array<std::uint16_t, 4> corners{p.a, p.b, p.c, p.d};
      for (std::size_t column = 0; column < 4; ++column) uses[column][corners[column] % lanes].insert(corners[column]);
    }
    for (const auto& column : uses) {
      std::size_t reads = 0, additions = 0;
      for (const std::multiset<int>& bank : column) {
        reads = std::max(reads, std::set<int>(bank.begin(), bank.end()).size());
        additions = std::max(additions, bank.size());
      }
      passes.reads += static_cast<std::uint32_t>(reads);
      passes.additions += static_cast<std::uint32_t>(additions);
    }
  }
  return passes;
}

}  // namespace mercury::cuda
