// SPDX-License-Identifier: Apache-2.0
#include "mercury/voxels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace mercury {
namespace {

using Place = std::array<int, 3>;  // on the lattice, in edges

// Where each mass stands; empty unless all stand on a lattice, one per place.
std::vector<Place> places_of(const Robot& robot, float edge) {
  std::vector<Place> places;
  places.reserve(robot.masses.size());
  for (const Vec3& mass : robot.masses) {
    const Vec3 d = mass - robot.masses.front();
    Place place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float along = (axis == 0 ? d.x : axis == 1 ? d.y : d.z) / edge;
      if (!(std::abs(along) < 1e6f)) return {};
      place[axis] = static_cast<int>(along + (along < 0 ? -0.5f : 0.5f));  // round() is a call of a function
      if (std::abs(along - static_cast<float>(place[axis])) > 0.01f) return {};
    }
    places.push_back(place);
  }
  return places;
}

// Bits of a coordinate in the key of a place, and what is added so that it is not negative. Coordinates are within 1e6.
constexpr std::int64_t place_bits = 21, first_place = std::int64_t{1} << (place_bits - 1);
std::uint64_t key_of(const Place& place) {
  std::uint64_t key = 0;
  for (const int along : place) key = key << place_bits | static_cast<std::uint64_t>(along + first_place);
  return key;
}

// A hash table with open addressing: thousands of robots are looked at when they are loaded, and memory per key would
// take most of the time.
class Table {
 public:
  explicit Table(std::size_t most)
      : entries_(std::bit_ceil(2 * most + 2)), shift_(64 - std::countr_zero(entries_.size())) {}

  struct Entry {
    std::uint64_t key = 0;
    std::uint16_t value = 0;
    bool present = false, marked = false;
  };
  // The entry of a key, or the one where it would stand.
  Entry& at(std::uint64_t key) {
    std::size_t i = (key * 0x9e3779b97f4a7c15u) >> shift_;
    while (entries_[i].present && entries_[i].key != key) i = (i + 1) & (entries_.size() - 1);
    return entries_[i];
  }
  // Returns false if the key has a value already, which stays.
  bool insert(std::uint64_t key, std::uint16_t value) {
    Entry& entry = at(key);
    if (entry.present) return false;
    entry = {key, value, true};
    return true;
  }

 private:
  std::vector<Entry> entries_;
  int shift_;
};

}  // namespace

Voxels voxels_of(const Robot& robot) {
  Voxels voxels;
  if (robot.springs.empty()) return voxels;
  voxels.edge = std::ranges::min(robot.springs, {}, &Spring::rest_length).rest_length;
  Table joined(robot.springs.size());  // material by pair of masses
  std::size_t pairs = 0;
  for (const Spring& spring : robot.springs)
    pairs += joined.insert(pair_of(spring.a, spring.b), spring.material) ? 1 : 0;
  voxels.shares_pairs = pairs != robot.springs.size();
  const std::vector<Place> places = places_of(robot, voxels.edge);
  Table masses(places.size());  // by place
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!masses.insert(key_of(places[i]), static_cast<std::uint16_t>(i))) return voxels;
  std::size_t covered = 0;
  for (const Place& low : places) {
    Voxel voxel;
    bool complete = true;
    for (std::size_t corner = 0; corner < 8 && complete; ++corner) {
      const Place place{low[0] + (corner & 1 ? 1 : 0), low[1] + (corner & 2 ? 1 : 0), low[2] + (corner & 4 ? 1 : 0)};
      const Table::Entry& found = masses.at(key_of(place));
      complete = found.present;
      voxel.corners[corner] = found.value;
    }
    std::array<Table::Entry*, 28> springs{};
    std::size_t found = 0;
    for_each_pair_of_corners([&](std::size_t i, std::size_t j) {
      if (!complete) return;
      springs[found] = &joined.at(pair_of(voxel.corners[i], voxel.corners[j]));
      complete = springs[found++]->present;
    });
    if (!complete) continue;
    for (Table::Entry* const spring : springs) covered += std::exchange(spring->marked, true) ? 0 : 1;
    voxel.material = static_cast<MaterialId>(joined.at(pair_of(voxel.corners[0], voxel.corners[7])).value);
    voxels.all.push_back(voxel);
  }
  if (covered != pairs) voxels.all.clear();
  return voxels;
}

}  // namespace mercury
