#include <array>

#include "sim/cuda/schedule.h"

namespace mercury::cuda {
namespace {

// Up to 32 pairs, and the banks that their four columns of masses take.
struct Bundle {
  std::array<std::uint32_t, 4> banks{};
  std::vector<FacePair> pairs;

  static std::array<std::uint32_t, 4> banks_of(const FacePair& p) {
    return {1u << p.a % lanes, 1u << p.b % lanes, 1u << p.c % lanes, 1u << p.d % lanes};
  }
  bool has_room(const FacePair& p) const {
    if (pairs.size() == lanes) return false;
    const auto wanted = banks_of(p);
    return !(banks[0] & wanted[0] || banks[1] & wanted[1] || banks[2] & wanted[2] || banks[3] & wanted[3]);
  }
  void add(const FacePair& p) {
    const auto wanted = banks_of(p);
    for (std::size_t column = 0; column < 4; ++column) banks[column] |= wanted[column];
    pairs.push_back(p);
  }
};

// The same two triangles, told in another order; a face's force does not depend on its orientation.
std::array<FacePair, 4> tellings(const FacePair& p) {
  return {p, FacePair{p.c, p.d, p.a, p.b}, FacePair{p.a, p.d, p.c, p.b}, FacePair{p.c, p.b, p.a, p.d}};
}

// The fullest bundle that takes a pair in one of its tellings, or a new one.
void place(std::vector<Bundle>& bundles, const FacePair& pair) {
  Bundle* best = nullptr;
  FacePair best_telling;
  for (Bundle& bundle : bundles) {
    if (best && bundle.pairs.size() <= best->pairs.size()) continue;
    for (const FacePair& telling : tellings(pair))
      if (bundle.has_room(telling)) {
        best = &bundle;
        best_telling = telling;
        break;
      }
  }
  if (best) return best->add(best_telling);
  bundles.emplace_back().add(pair);
}

}  // namespace

std::vector<FacePair> spread_over_banks(std::span<const FacePair> pairs) {
  std::vector<Bundle> bundles;
  for (const FacePair& pair : pairs) place(bundles, pair);
  std::vector<FacePair> ordered;
  for (Bundle& bundle : bundles) {
    bundle.pairs.resize(lanes, no_faces);
    ordered.insert(ordered.end(), bundle.pairs.begin(), bundle.pairs.end());
  }
  return ordered;
}

}  // namespace mercury::cuda
