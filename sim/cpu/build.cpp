// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/build.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace mercury::cpu {
namespace {

// One robot's spring or pair of faces between certain seats; `copy` counts those of the robot between the same.
struct Claim {
  std::uint64_t seats = 0;
  std::uint32_t copy = 0, sitter = 0, item = 0;

  auto order() const { return std::tuple(seats, copy, sitter); }
};

// Counts copies and sorts by order().
void sort(std::vector<Claim>& claims) {
  std::ranges::sort(claims, {}, [](const Claim& c) { return std::tuple(c.seats, c.sitter, c.item); });
  for (auto first = claims.begin(); first != claims.end();) {
    auto last = first + 1;
    bool copies = false;
    for (; last != claims.end() && last->seats == first->seats; ++last)
      if (last->sitter == (last - 1)->sitter) {
        last->copy = (last - 1)->copy + 1;
        copies = true;
      }
    if (copies) std::sort(first, last, [](const Claim& a, const Claim& b) { return a.order() < b.order(); });
    first = last;
  }
}

// Calls visit(claim, number) with the same number for claims on the same seats by different sitters, and
// start(claim) before each new number.
template <class Start, class Visit>
void for_each(std::vector<Claim>& claims, const Start& start, const Visit& visit) {
  sort(claims);
  std::uint32_t number = 0;
  for (std::size_t i = 0; i < claims.size(); ++i) {
    if (i == 0 || claims[i].seats != claims[i - 1].seats || claims[i].copy != claims[i - 1].copy) {
      start(claims[i]);
      ++number;
    }
    visit(claims[i], number - 1);
  }
}

}  // namespace

Assembly assemble(std::span<const Sitter> sitters, std::size_t seats) {
  Build build;
  build.joints.resize(seats);
  std::vector<Seating> seatings(sitters.size());
  std::vector<Claim> springs, faces;
  for (std::uint32_t s = 0; s < sitters.size(); ++s) {
    const std::vector<std::uint32_t>& seat = sitters[s].seats;
    const std::vector<Spring>& own = sitters[s].robot->springs;
    seatings[s] = {seat, std::vector<std::uint32_t>(own.size()), std::vector<std::uint32_t>(sitters[s].faces.size())};
    for (std::uint32_t i = 0; i < own.size(); ++i) {
      const auto [owner, partner] = std::minmax(seat[own[i].a], seat[own[i].b]);
      springs.push_back({std::uint64_t{owner} << 16 | partner, 0, s, i});
    }
    for (std::uint32_t i = 0; i < sitters[s].faces.size(); ++i) {
      const FacePair& p = sitters[s].faces[i];
      faces.push_back(
          {(std::uint64_t{seat[p.a]} << 16 | seat[p.b]) << 32 | std::uint64_t{seat[p.c]} << 16 | seat[p.d], 0, s, i});
    }
  }
  for_each(
      springs,
      [&](const Claim& claim) {
        const auto owner = static_cast<std::uint32_t>(claim.seats >> 16),
                   partner = static_cast<std::uint32_t>(claim.seats & 0xffff);
        build.partners.push_back(partner);
        ++build.joints[owner].owned;
        ++build.joints[owner].slots;
        ++build.joints[partner].slots;
      },
      [&](const Claim& claim, std::uint32_t slot) { seatings[claim.sitter].slots[claim.item] = slot; });
  for_each(
      faces,
      [&](const Claim& claim) {
        const auto corner = [&](int n) { return static_cast<std::uint16_t>(claim.seats >> (48 - 16 * n)); };
        build.faces.push_back({corner(0), corner(1), corner(2), corner(3)});
      },
      [&](const Claim& claim, std::uint32_t pair) { seatings[claim.sitter].faces[claim.item] = pair; });
  Assembly assembly{std::make_shared<const Build>(std::move(build)), {}};
  for (Seating& seating : seatings) assembly.seatings.push_back(std::make_shared<const Seating>(std::move(seating)));
  return assembly;
}

FaceHalves halves_of(std::size_t pairs, std::span<const std::shared_ptr<const Seating>> seatings) {
  std::vector<std::uint8_t> in_halves(pairs);  // 1 = lower, 2 = upper
  for (std::size_t s = 0; s < seatings.size(); ++s) {
    const int half = 2 * s < seatings.size() ? 1 : 2;
    for (const std::uint32_t pair : seatings[s]->faces)
      in_halves[pair] = static_cast<std::uint8_t>(in_halves[pair] | half);
  }
  FaceHalves halves;
  for (std::uint32_t pair = 0; pair < pairs; ++pair) {
    if (in_halves[pair] == 1) halves.lower.push_back(pair);
    if (in_halves[pair] == 2) halves.upper.push_back(pair);
  }
  return halves;
}

}  // namespace mercury::cpu
