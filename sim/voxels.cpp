// SPDX-License-Identifier: Apache-2.0
#include "mercury/voxels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <unordered_map>

namespace mercury {
namespace {

using Place = std::array<int, 3>;  // on the lattice, in edges

// Where each mass stands; empty unless all stand on a lattice, one per place.
std::vector<Place> places_of(const Robot& robot, float edge) {
  std::vector<Place> places;
  for (const Vec3& mass : robot.masses) {
    const Vec3 d = mass - robot.masses.front();
    Place place;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float along = (axis == 0 ? d.x : axis == 1 ? d.y : d.z) / edge;
      if (!(std::abs(along) < 1e6f) || std::abs(along - std::round(along)) > 0.01f) return {};
      place[axis] = static_cast<int>(std::lround(along));
    }
    places.push_back(place);
  }
  return places;
}

}  // namespace

Voxels voxels_of(const Robot& robot) {
  Voxels voxels;
  if (robot.springs.empty()) return voxels;
  voxels.edge = std::ranges::min(robot.springs, {}, &Spring::rest_length).rest_length;
  std::unordered_map<std::uint32_t, MaterialId> materials;
  for (const Spring& spring : robot.springs) materials.emplace(pair_of(spring.a, spring.b), spring.material);
  voxels.shares_pairs = materials.size() != robot.springs.size();
  const std::vector<Place> places = places_of(robot, voxels.edge);
  std::map<Place, std::uint16_t> points;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (!points.emplace(places[i], static_cast<std::uint16_t>(i)).second) return voxels;
  std::vector<std::uint32_t> covered;
  for (const Place& low : places) {
    Voxel voxel;
    bool complete = true;
    for (std::size_t corner = 0; corner < 8 && complete; ++corner) {
      const auto found =
          points.find({low[0] + (corner & 1 ? 1 : 0), low[1] + (corner & 2 ? 1 : 0), low[2] + (corner & 4 ? 1 : 0)});
      complete = found != points.end();
      if (complete) voxel.corners[corner] = found->second;
    }
    if (!complete) continue;
    for_each_pair_of_corners([&](std::size_t i, std::size_t j) {
      complete = complete && materials.contains(pair_of(voxel.corners[i], voxel.corners[j]));
    });
    if (!complete) continue;
    for_each_pair_of_corners(
        [&](std::size_t i, std::size_t j) { covered.push_back(pair_of(voxel.corners[i], voxel.corners[j])); });
    voxel.material = materials.at(pair_of(voxel.corners[0], voxel.corners[7]));
    voxels.all.push_back(voxel);
  }
  std::ranges::sort(covered);
  covered.erase(std::unique(covered.begin(), covered.end()), covered.end());  // clang 14 lacks ranges::unique
  if (covered.size() != materials.size()) voxels.all.clear();
  return voxels;
}

}  // namespace mercury
