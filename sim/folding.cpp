// SPDX-License-Identifier: Apache-2.0
#include "mercury/folding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mercury/voxels.h"
#include "sim/physics/inversion.h"

namespace mercury {
namespace {

// A body of n masses that all springs join has n^4 / 24 tetrahedra: of such, not all are needed.
constexpr int most_per_spring = 64;
constexpr std::size_t tetrahedra_per_voxel = 6;
// Flatter ones, by volume per cube of their longest edge, are no space between masses: four masses of one side of a
// tapered cell, say, which may pass through their plane. A regular one has 0.12, a corner of a cube 0.06.
constexpr double flat = 0.01;

double longest_edge(Double3 a, Double3 b, Double3 c, Double3 d) {
  double squared = 0;
  for (const Double3 edge : {b - a, c - a, d - a, c - b, d - b, d - c}) squared = std::max(squared, dot(edge, edge));
  return std::sqrt(squared);
}

bool is_within(Double3 p, Double3 a, Double3 b, Double3 c, Double3 d) {
  const double sign = sixfold_volume(a, b, c, d) < 0 ? -1 : 1;
  return sign * sixfold_volume(p, b, c, d) > 0 && sign * sixfold_volume(a, p, c, d) > 0 &&
         sign * sixfold_volume(a, b, p, d) > 0 && sign * sixfold_volume(a, b, c, p) > 0;
}

std::uint64_t key(std::uint32_t cell, std::uint16_t mass) { return std::uint64_t{cell} << 16 | mass; }

// Masses by the cubes of space that they are in.
class Grid {
 public:
  Grid(std::span<const Vec3> positions, double edge) : positions_(positions), edge_(edge) {
    std::size_t buckets = 1;
    while (buckets < positions.size()) buckets *= 2;
    mask_ = buckets - 1;
    first_.assign(buckets + 1, 0);
    for (const Vec3& x : positions) ++first_[bucket(place(Double3(x))) + 1];
    for (std::size_t i = 0; i < buckets; ++i) first_[i + 1] += first_[i];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    masses_.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
      masses_[next[bucket(place(Double3(positions[i])))]++] = static_cast<std::uint16_t>(i);
  }

  // Calls visit(mass) for all masses between two corners of a box, and perhaps more.
  template <class Visit>
  void for_each_between(Vec3 low, Vec3 high, const Visit& visit) const {
    const Place from = place(Double3(low)), to = place(Double3(high));
    const double cubes = (static_cast<double>(to.x - from.x) + 1) * (static_cast<double>(to.y - from.y) + 1) *
                         (static_cast<double>(to.z - from.z) + 1);
    if (cubes > static_cast<double>(masses_.size())) {
      for (const std::uint16_t mass : masses_) visit(mass);
      return;
    }
    for (std::int64_t z = from.z; z <= to.z; ++z)
      for (std::int64_t y = from.y; y <= to.y; ++y)
        for (std::int64_t x = from.x; x <= to.x; ++x) {
          const std::size_t b = bucket({x, y, z});
          for (std::uint32_t i = first_[b]; i < first_[b + 1]; ++i) visit(masses_[i]);
        }
  }

 private:
  struct Place {
    std::int64_t x, y, z;
  };
  Place place(Double3 p) const {
    return {std::llround(p.x / edge_), std::llround(p.y / edge_), std::llround(p.z / edge_)};
  }
  std::size_t bucket(Place p) const {
    const auto mix = [](std::int64_t value, std::uint64_t factor) {
      return static_cast<std::uint64_t>(value) * factor;
    };
    std::uint64_t hash = mix(p.x, 0x9e3779b97f4a7c15u) ^ mix(p.y, 0xc2b2ae3d27d4eb4fu) ^ mix(p.z, 0x165667b19e3779f9u);
    hash ^= hash >> 29;
    return static_cast<std::size_t>(hash) & mask_;
  }

  std::span<const Vec3> positions_;
  double edge_;  // [m]
  std::size_t mask_ = 0;
  std::vector<std::uint32_t> first_;  // per bucket, and the end
  std::vector<std::uint16_t> masses_;
};

}  // namespace

BodyCells::BodyCells(const Robot& robot, MeasuredFolding measured) : measured_(measured) {
  const Voxels voxels = voxels_of(robot);
  for (const Voxel& voxel : voxels.all) {
    voxels_.push_back(voxel.corners);
    volumes_.push_back(voxels.edge * voxels.edge * voxels.edge);
    // Around the diagonal from corner 0 to corner 7, one for each order of the axes.
    for (const auto& [first, second] : {std::array{1, 2}, {2, 4}, {4, 1}, {2, 1}, {4, 2}, {1, 4}}) {
      const auto& c = voxel.corners;
      const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(first + second);
      tetrahedra_.push_back({c[0], c[a], c[b], c[7]});
    }
  }
  if (voxels_.empty() || measured_ == MeasuredFolding::all) {
    std::vector<std::uint32_t> pairs;  // in both directions
    for (const auto& [a, b, material, rest_length] : robot.springs) {
      pairs.push_back(std::uint32_t{a} << 16 | b);
      pairs.push_back(std::uint32_t{b} << 16 | a);
      longest_ = std::max(longest_, rest_length);
    }
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());  // clang 14 lacks ranges::unique
    first_neighbor_.assign(robot.masses.size() + 1, 0);
    for (const std::uint32_t pair : pairs) {
      ++first_neighbor_[(pair >> 16) + 1];
      neighbors_.push_back(static_cast<std::uint16_t>(pair & 0xffff));
    }
    for (std::size_t i = 0; i < robot.masses.size(); ++i) first_neighbor_[i + 1] += first_neighbor_[i];
  }
  if (voxels_.empty()) find_tetrahedra(robot);
  for (const float volume : volumes_) volume_ += static_cast<double>(volume);
  if (measured_ != MeasuredFolding::all) return;
  find_touching();
  for_each_intruder(robot.masses, [&](std::uint16_t mass, std::uint32_t cell) { at_rest_.push_back(key(cell, mass)); });
  std::ranges::sort(at_rest_);
}

void BodyCells::find_tetrahedra(const Robot& robot) {
  const auto above = [&](std::uint32_t mass) {
    const auto begin = neighbors_.begin() + first_neighbor_[mass], end = neighbors_.begin() + first_neighbor_[mass + 1];
    return std::span<const std::uint16_t>(std::upper_bound(begin, end, mass), end);
  };
  std::vector<std::uint16_t> common, third;
  for (std::uint32_t a = 0; a < robot.masses.size(); ++a)
    for (const std::uint16_t b : above(a)) {
      common.clear();
      std::ranges::set_intersection(above(a), above(b), std::back_inserter(common));
      int found = 0;
      for (std::size_t i = 0; i < common.size() && found < most_per_spring; ++i) {
        const std::uint16_t c = common[i];
        third.clear();
        std::ranges::set_intersection(std::span(common).subspan(i + 1), above(c), std::back_inserter(third));
        for (const std::uint16_t d : third) {
          if (found == most_per_spring) break;
          const auto corner = [&](std::size_t mass) { return Double3(robot.masses[mass]); };
          const double volume = sixfold_volume(corner(a), corner(b), corner(c), corner(d));
          if (std::abs(volume) < 6 * flat * std::pow(longest_edge(corner(a), corner(b), corner(c), corner(d)), 3))
            continue;
          ++found;
          const auto first = static_cast<std::uint16_t>(a);
          if (volume > 0)
            tetrahedra_.push_back({first, b, c, d});
          else
            tetrahedra_.push_back({first, b, d, c});
          volumes_.push_back(static_cast<float>(std::abs(volume) / 6));
        }
      }
    }
}

bool BodyCells::is_inverted(std::size_t cell, std::span<const Vec3> positions) const {
  const auto corner = [&, masses = corners(cell).data()](int k) { return Double3(positions[masses[k]]); };
  return voxels_.empty() ? is_inverted_tetrahedron(corner) : is_inverted_voxel(corner);
}

std::span<const std::uint16_t> BodyCells::corners(std::size_t cell) const {
  return voxels_.empty() ? std::span<const std::uint16_t>(tetrahedra_[cell]) : voxels_[cell];
}

// Corners, and what is joined to one of them.
void BodyCells::find_touching() {
  first_touching_.push_back(0);
  for (std::size_t cell = 0; cell < volumes_.size(); ++cell) {
    for (const std::uint16_t corner : corners(cell)) {
      touching_.push_back(corner);
      touching_.insert(touching_.end(), neighbors_.begin() + first_neighbor_[corner],
                       neighbors_.begin() + first_neighbor_[corner + 1u]);
    }
    const auto added = touching_.begin() + first_touching_.back();
    std::sort(added, touching_.end());
    touching_.erase(std::unique(added, touching_.end()), touching_.end());
    first_touching_.push_back(static_cast<std::uint32_t>(touching_.size()));
  }
}

bool BodyCells::contains(std::size_t cell, Double3 p, std::span<const Vec3> positions) const {
  const std::size_t each = voxels_.empty() ? 1 : tetrahedra_per_voxel;
  return std::ranges::any_of(std::span(tetrahedra_).subspan(each * cell, each), [&](const auto& t) {
    return is_within(p, Double3(positions[t[0]]), Double3(positions[t[1]]), Double3(positions[t[2]]),
                     Double3(positions[t[3]]));
  });
}

template <class Visit>
void BodyCells::for_each_intruder(std::span<const Vec3> positions, const Visit& visit) const {
  if (volumes_.empty()) return;
  const Grid grid(positions, static_cast<double>(longest_));
  for (std::size_t cell = 0; cell < volumes_.size(); ++cell) {
    Vec3 low = positions[corners(cell)[0]], high = low;
    for (const std::uint16_t corner : corners(cell)) {
      const Vec3& x = positions[corner];
      low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
      high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
    const auto touching =
        std::span(touching_).subspan(first_touching_[cell], first_touching_[cell + 1] - first_touching_[cell]);
    grid.for_each_between(low, high, [&](std::uint16_t mass) {
      const Vec3& x = positions[mass];
      if (x.x <= low.x || x.x >= high.x || x.y <= low.y || x.y >= high.y || x.z <= low.z || x.z >= high.z) return;
      if (!std::ranges::binary_search(touching, mass) && contains(cell, Double3(x), positions))
        visit(mass, static_cast<std::uint32_t>(cell));
    });
  }
}

Folding BodyCells::folding(std::span<const Vec3> positions) const {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  Folding folding;
  if (measured_ == MeasuredFolding::none) folding.inverted = nan;
  if (measured_ != MeasuredFolding::all) folding.overlap = nan;
  if (volumes_.empty() || measured_ == MeasuredFolding::none) return folding;
  double inverted = 0;
  for (std::size_t cell = 0; cell < volumes_.size(); ++cell)
    if (is_inverted(cell, positions)) inverted += static_cast<double>(volumes_[cell]);
  folding.inverted = static_cast<float>(inverted / volume_);
  if (measured_ != MeasuredFolding::all) return folding;
  std::vector<bool> is_intruder(positions.size());
  for_each_intruder(positions, [&](std::uint16_t mass, std::uint32_t cell) {
    if (!is_intruder[mass]) is_intruder[mass] = !std::ranges::binary_search(at_rest_, key(cell, mass));
  });
  folding.overlap = static_cast<float>(static_cast<double>(std::ranges::count(is_intruder, true)) /
                                       static_cast<double>(positions.size()));
  return folding;
}

}  // namespace mercury
