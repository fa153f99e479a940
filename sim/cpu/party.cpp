// SPDX-License-Identifier: Apache-2.0
#include "sim/cpu/party.h"

#include <oneapi/tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "sim/cpu/similar.h"

namespace mercury::cpu {
namespace {

using Group = std::vector<std::size_t>;

// A party is stepped several times at a stretch; twice the cache of a core is still quicker than one robot after the
// other.
std::size_t cache_of_a_core() {
  constexpr std::size_t least = 256 * 1024;
#ifdef _SC_LEVEL2_CACHE_SIZE
  if (const long size = sysconf(_SC_LEVEL2_CACHE_SIZE); size > 0)
    return std::max(least, static_cast<std::size_t>(size));
#endif
  return least;
}
const std::size_t party_share = 2 * cache_of_a_core();  // [bytes]

std::size_t footprint(std::size_t slots, std::size_t seats, std::size_t lanes) {
  return lanes * (slots * (2 * sizeof(float) + sizeof(FactorId)) + seats * 9 * sizeof(float));
}

bool alike(const Body& a, const Body& b) {
  return a.topology_key == b.topology_key && same_topology(*a.robot, *b.robot) && a.face_pairs == b.face_pairs;
}

// Groups of as many robots of one build as there are lanes, or nearly; the others are left.
std::vector<Group> alike_groups(std::span<const Body> bodies, Group& left) {
  std::ranges::stable_sort(left, {}, [&](std::size_t i) { return bodies[i].topology_key; });
  std::vector<Group> groups;
  Group others;
  for (auto first = left.begin(); first != left.end();) {
    const std::size_t lanes = bodies[*first].places.lanes;
    auto last = first + 1;
    while (last != left.end() && static_cast<std::size_t>(last - first) < lanes && alike(bodies[*first], bodies[*last]))
      ++last;
    if (4 * static_cast<std::size_t>(last - first) >= 3 * lanes)
      groups.emplace_back(first, last);
    else
      others.insert(others.end(), first, last);
    first = last;
  }
  left = std::move(others);
  return groups;
}

std::size_t index_of(Cell c) {
  constexpr std::size_t across = most_cells_across;
  return c.x + across * (c.y + across * std::size_t{c.z});
}

// By body; those without take part in nothing.
using Patterns = std::vector<std::vector<Cell>>;

// Pairs of faces meet only where robots are as they are, since each is told by place (sim/physics/face_pairs.h).
Patterns patterns_of(std::span<const Body> bodies, std::span<const std::size_t> wanted, bool faces) {
  Patterns patterns(bodies.size());
  oneapi::tbb::parallel_for(std::size_t{0}, wanted.size(), [&](std::size_t w) {
    const std::vector<Cell>& cells = bodies[wanted[w]].cells;
    patterns[wanted[w]] = faces || cells.empty() ? cells : in_common_pose(cells);
  });
  return patterns;
}

// Groups of robots with masses and faces in much the same places.
std::vector<Group> similar_groups(std::span<const Body> bodies, const Patterns& patterns,
                                  std::span<const std::size_t> left, bool faces) {
  Group candidates;
  std::ranges::copy_if(left, std::back_inserter(candidates), [&](std::size_t i) { return !patterns[i].empty(); });
  if (candidates.empty()) return {};
  std::vector<Outline> outlines;
  for (const std::size_t i : candidates) {
    outlines.push_back({patterns[i], bodies[i].robot->springs, {}});
    if (faces) outlines.back().faces = bodies[i].face_pairs;
  }
  std::vector<Group> groups = cpu::similar_groups(outlines, bodies[candidates.front()].places.lanes);
  for (Group& group : groups)
    for (std::size_t& robot : group) robot = candidates[robot];
  return groups;
}

Party party_of_alike(std::span<const Body> bodies, Group group) {
  const Body& first = bodies[group.front()];
  std::vector<std::uint32_t> seats(first.robot->masses.size());
  std::iota(seats.begin(), seats.end(), 0u);
  const Sitter sitter{first.robot, first.face_pairs, seats};
  Party party{std::move(group), assemble({&sitter, 1}, seats.size())};
  party.assembly.seatings.resize(party.bodies.size(), party.assembly.seatings.front());
  return party;
}

// Orders robots so that many pairs of faces are in one half of them only; two such pairs share a slot.
void put_like_faces_in_one_half(Party& party) {
  std::vector<std::shared_ptr<const Seating>>& seatings = party.assembly.seatings;
  const std::size_t robots = party.bodies.size(), half = robots / 2;
  const auto shared = [&] {
    const auto [lower, upper] = halves_of(party.assembly.build->faces.size(), seatings);
    return std::min(lower.size(), upper.size());
  };
  const auto exchange = [&](std::size_t i, std::size_t j) {
    std::swap(seatings[i], seatings[j]);
    std::swap(party.bodies[i], party.bodies[j]);
  };
  std::size_t most = shared();
  for (std::size_t i = 0; i < half; ++i)
    for (std::size_t j = half; j < robots; ++j) {
      exchange(i, j);
      if (const std::size_t now = shared(); now > most)
        most = now;
      else
        exchange(i, j);
    }
}

Party party_of_similar(std::span<const Body> bodies, const Patterns& patterns, Group group) {
  // Seats are the cells that any has a mass in: z slowest, then y.
  constexpr std::uint32_t none = 0xffffffffu;
  std::vector<std::uint32_t> seat_of_cell(std::size_t{most_cells_across} * most_cells_across * most_cells_across, none);
  for (const std::size_t i : group)
    for (const Cell c : patterns[i]) seat_of_cell[index_of(c)] = 0;
  std::uint32_t seats = 0;
  for (std::uint32_t& seat : seat_of_cell)
    if (seat != none) seat = seats++;
  std::vector<Sitter> sitters;
  for (const std::size_t i : group) {
    sitters.push_back({bodies[i].robot, bodies[i].face_pairs, {}});
    for (const Cell c : patterns[i]) sitters.back().seats.push_back(seat_of_cell[index_of(c)]);
  }
  Party party{std::move(group), assemble(sitters, seats)};
  if (bodies[party.bodies.front()].places.lanes >= least_lanes_to_split) put_like_faces_in_one_half(party);
  return party;
}

// What a step costs, in slots of a group; measured with eight lanes.
double cost_together(const Build& build, bool faces) {
  return static_cast<double>(build.partners.size()) + 1.4 * static_cast<double>(build.joints.size()) +
         (faces ? 3.0 * static_cast<double>(build.faces.size()) : 0.0);
}
double cost_alone(const Body& body, bool faces) {
  const SpringPlan& plan = body.springs;
  const auto lanes = static_cast<double>(body.places.lanes);
  const double a_block = faces ? 5.5 : plan.has_rows() ? 5 : 4.5;
  return 9 + 0.9 * static_cast<double>(plan.runs.size()) + 2.0 * static_cast<double>(plan.partners.size()) / lanes +
         a_block * static_cast<double>(body.places.blocks()) +
         (faces ? 8.5 * static_cast<double>(body.faces.size()) / (4 * lanes) : 0.0);
}

// A last round of groups that leaves many threads without one takes longer than its robots one by one, which are about
// half as much work again.
std::size_t worth_keeping(std::size_t groups, std::size_t threads) {
  const std::size_t last = groups % threads;
  return groups < packs_a_thread * threads && 3 * last < 2 * threads ? groups - last : groups;
}

bool pays(std::span<const Body> bodies, const Party& party, bool faces) {
  double alone = 0;
  for (const std::size_t i : party.bodies) alone += cost_alone(bodies[i], faces);
  // More lanes make rows dearer.
  const std::size_t lanes = bodies[party.bodies.front()].places.lanes;
  const double dearer = lanes > 8 ? 1.15 : lanes < 8 ? 0.95 : 1.0;
  return footprint(*party.assembly.build, lanes) <= party_share &&
         cost_together(*party.assembly.build, faces) < dearer * alone;
}

}  // namespace

std::size_t footprint(const Build& build, std::size_t lanes) {
  return footprint(build.partners.size(), build.joints.size(), lanes);
}

std::size_t footprint(const Body& body) {
  return body.springs.rest_length.size() * 10 + body.springs.partners.size() * 4 + body.faces.size() * 4 +
         body.places.padded() * 128;
}

bool fits_in_party(const Body& body) {
  return body.status.exploded_step < 0 &&
         footprint(body.robot->springs.size(), body.robot->masses.size(), body.places.lanes) <= party_share;
}

std::vector<Party> find_parties(std::span<const Body> bodies, std::size_t threads, const Configuration& configuration) {
  Group left;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (fits_in_party(bodies[i])) left.push_back(i);
  const bool faces = std::holds_alternative<Ocean>(configuration.environment);
  std::vector<Group> groups = alike_groups(bodies, left);
  const std::size_t alike = groups.size();
  const Patterns patterns = patterns_of(bodies, left, faces);
  std::ranges::move(similar_groups(bodies, patterns, left, faces), std::back_inserter(groups));
  groups.resize(worth_keeping(groups.size(), threads));

  std::vector<Party> parties(groups.size());
  oneapi::tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    parties[g] = g < alike ? party_of_alike(bodies, std::move(groups[g]))
                           : party_of_similar(bodies, patterns, std::move(groups[g]));
    if (g >= alike && !pays(bodies, parties[g], faces)) parties[g] = {};
  });
  std::erase_if(parties, [](const Party& party) { return party.bodies.empty(); });
  return parties;
}

}  // namespace mercury::cpu
