// SPDX-License-Identifier: Apache-2.0
// How a body is folded: whether parts of it are inside out, or inside other parts. Strains do not show it: a voxel that
// is turned inside out has springs of their lengths at rest.
//
//     3-----2          3-----2           c cells of the body   a voxel of a robot of voxels; else a tetrahedron of
//     |     |    ->     \   /                                  four masses that six springs join
//     |     |            \ /             inverted              their share, by volume at rest, that is inside out
//     0-----1            / \             overlap               the share of the masses that lie within a cell none of
//                       1---0                                  whose corners is that mass, or is joined to it
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mercury/robot.h"
#include "mercury/vec3.h"

namespace mercury {

struct Double3;

struct Folding {
  float inverted = 0;  // [1]
  float overlap = 0;   // [1]
};

// What is measured of it. Overlap takes many times as long as the rest.
enum class MeasuredFolding { none, inverted, all };

// The cells of a robot, for any number of its states. A robot has no cells if it has no voxels and no four masses in
// space that are all joined, such as one of struts: both figures are 0 then.
class BodyCells {
 public:
  explicit BodyCells(const Robot& robot, MeasuredFolding measured = MeasuredFolding::all);

  // One position per mass. A tetrahedron is inside out if its volume has another sign than at rest, a voxel if the
  // three vectors between the centers of its opposite sides are left-handed. A mass that lies within a cell at rest as
  // well, as in a file of parts that are in each other, does not count for that cell. What is not measured is NaN.
  Folding folding(std::span<const Vec3> positions) const;

  MeasuredFolding measured() const { return measured_; }
  std::size_t size() const { return volumes_.size(); }
  // The masses at a cell's corners: eight of a voxel, four of a tetrahedron.
  std::span<const std::uint16_t> corners(std::size_t cell) const;
  float volume(std::size_t cell) const { return volumes_[cell]; }  // at rest [m3]
  double volume() const { return volume_; }                        // of all cells

 private:
  using Tetrahedron = std::array<std::uint16_t, 4>;

  void find_tetrahedra(const Robot& robot);
  bool is_inverted(std::size_t cell, std::span<const Vec3> positions) const;
  void find_touching();
  bool contains(std::size_t cell, Double3 point, std::span<const Vec3> positions) const;
  // Calls visit(mass, cell) for masses within cells that they do not touch.
  template <class Visit>
  void for_each_intruder(std::span<const Vec3> positions, const Visit& visit) const;

  MeasuredFolding measured_;
  std::vector<std::array<std::uint16_t, 8>> voxels_;  // corners; empty for cells that are tetrahedra
  std::vector<Tetrahedron> tetrahedra_;               // six per voxel, or one per cell; right-handed at rest
  std::vector<float> volumes_;                        // per cell, at rest [m3]
  double volume_ = 0;                                 // of all cells
  std::vector<std::uint32_t> first_neighbor_;         // per mass, and the end
  std::vector<std::uint16_t> neighbors_;              // of each mass, ascending
  std::vector<std::uint32_t> first_touching_;         // per cell, and the end
  std::vector<std::uint16_t> touching_;               // the masses that touch each cell, ascending
  std::vector<std::uint64_t> at_rest_;                // cell and mass, of a mass that is within the cell; ascending
  float longest_ = 0;                                 // rest length [m]
};

}  // namespace mercury
