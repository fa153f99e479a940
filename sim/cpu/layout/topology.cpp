// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/layout/topology.h"

namespace mercury::cpu {

HalfFacePairs half_face_pairs(std::size_t face_pairs, std::span<const std::shared_ptr<const IndexMap>> index_maps) {
  constexpr std::uint8_t lower = 1, upper = 2;
  std::vector<std::uint8_t> halves(face_pairs);
  for (std::size_t member = 0; member < index_maps.size(); ++member) {
    const std::uint8_t half = 2 * member < index_maps.size() ? lower : upper;
    for (const std::uint32_t pair : index_maps[member]->face_pairs)
      halves[pair] = static_cast<std::uint8_t>(halves[pair] | half);
  }
  HalfFacePairs result;
  for (std::uint32_t pair = 0; pair < face_pairs; ++pair) {
    if (halves[pair] == lower) result.lower.push_back(pair);
    if (halves[pair] == upper) result.upper.push_back(pair);
  }
  return result;
}

}  // namespace mercury::cpu
