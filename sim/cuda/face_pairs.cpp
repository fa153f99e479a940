// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <random>

#include "sim/cuda/schedule.h"

namespace mercury::cuda {
namespace {

using Banks = std::array<std::uint8_t, 4>;  // of a pair's four masses

Banks banks_of(const FacePair& p) {
  const auto bank = [](std::uint16_t mass) { return static_cast<std::uint8_t>(mass % lanes); };
  return {bank(p.a), bank(p.b), bank(p.c), bank(p.d)};
}

// The same two triangles, told in another order; a face's force does not depend on its orientation.
std::array<FacePair, 4> tellings(const FacePair& p) {
  return {p, FacePair{p.c, p.d, p.a, p.b}, FacePair{p.a, p.d, p.c, p.b}, FacePair{p.c, p.b, p.a, p.d}};
}

// Deals pairs out to a given number of bundles so that few want a bank twice in a column: each goes where it is in the
// way of the fewest; then, again and again, those in each other's way go elsewhere. (Minton et al. 1992,
// min-conflicts.)
class Bundles {
 public:
  Bundles(std::span<const FacePair> pairs, std::size_t bundles)
      : told_(pairs.size()), dealt_(pairs.size()), bundles_(bundles) {
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto all = tellings(pairs[p]);
      for (std::size_t t = 0; t < all.size(); ++t) told_[p][t] = banks_of(all[t]);
    }
    for (std::size_t p = 0; p < pairs.size(); ++p) place(p);
  }

  // Until no conflict is left, or each pair could have moved once.
  void settle() {
    std::size_t moves = told_.size();
    for (std::size_t p = 0, at_peace = 0; at_peace < told_.size(); p = (p + 1) % told_.size()) {
      ++at_peace;
      if (!in_conflict(p)) continue;
      if (moves-- == 0) return;
      at_peace = 0;
      count(p, -1);
      place(p);
    }
  }

  std::vector<FacePair> in_order(std::span<const FacePair> pairs) const {
    std::vector<FacePair> ordered(bundles_.size() * lanes, no_faces);
    std::vector<std::size_t> used(bundles_.size());
    for (std::size_t p = 0; p < pairs.size(); ++p)
      ordered[dealt_[p].bundle * lanes + used[dealt_[p].bundle]++] = tellings(pairs[p])[dealt_[p].telling];
    return ordered;
  }

 private:
  struct Bundle {
    std::array<std::array<std::uint8_t, lanes>, 4> wanted{};  // how often, by column and bank
    std::uint32_t size = 0;
  };
  struct Dealt {
    std::size_t bundle = 0, telling = 0;
  };

  const Banks& banks(std::size_t p) const { return told_[p][dealt_[p].telling]; }

  void count(std::size_t p, int by) {
    Bundle& bundle = bundles_[dealt_[p].bundle];
    for (std::size_t column = 0; column < 4; ++column) {
      std::uint8_t& wanted = bundle.wanted[column][banks(p)[column]];
      wanted = static_cast<std::uint8_t>(wanted + by);
    }
    bundle.size += static_cast<std::uint32_t>(by);
  }

  bool in_conflict(std::size_t p) const {
    const Bundle& bundle = bundles_[dealt_[p].bundle];
    for (std::size_t column = 0; column < 4; ++column)
      if (bundle.wanted[column][banks(p)[column]] > 1) return true;
    return false;
  }

  // Where the fewest want the same. Bundles are asked from a random one on, at most so many while there is room.
  void place(std::size_t p) {
    constexpr std::size_t most_asked = 64;
    unsigned fewest = ~0u;
    std::size_t bundle = random_() % bundles_.size();
    for (std::size_t asked = 0; asked < bundles_.size() && fewest > 0;
         ++asked, bundle = (bundle + 1) % bundles_.size()) {
      if (asked >= most_asked && fewest != ~0u) break;
      if (bundles_[bundle].size == lanes) continue;
      for (std::size_t telling = 0; telling < 4; ++telling) {
        unsigned others = 0;
        for (std::size_t column = 0; column < 4; ++column)
          others += bundles_[bundle].wanted[column][told_[p][telling][column]];
        if (others >= fewest) continue;
        fewest = others;
        dealt_[p] = {bundle, telling};
      }
    }
    count(p, 1);
  }

  std::vector<std::array<Banks, 4>> told_;
  std::vector<Dealt> dealt_;
  std::vector<Bundle> bundles_;
  std::minstd_rand random_;
};

}  // namespace

std::uint32_t busiest_bank(std::span<const FacePair> pairs) {
  std::array<std::uint32_t, lanes> shared{}, outer{};
  for (const FacePair& p : pairs) {
    const Banks banks = banks_of(p);
    ++shared[banks[0]], ++shared[banks[2]];
    ++outer[banks[1]], ++outer[banks[3]];
  }
  std::uint32_t busiest = 0;
  for (std::uint32_t bank = 0; bank < lanes; ++bank) busiest = std::max({busiest, shared[bank], outer[bank]});
  return (busiest + 1) / 2;
}

std::vector<FacePair> spread_over_banks(std::span<const FacePair> pairs) {
  if (pairs.empty()) return {};
  Bundles bundles(pairs, (pairs.size() + lanes - 1) / lanes);
  bundles.settle();
  return bundles.in_order(pairs);
}

}  // namespace mercury::cuda
