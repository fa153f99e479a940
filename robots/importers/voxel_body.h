// SPDX-License-Identifier: Apache-2.0
// A body of voxels with substances of their own, turned into a robot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mercury/robot.h"
#include "robots/importers/substances.h"
#include "robots/voxel/spring_cells.h"

namespace mercury {

inline constexpr double imported_edge = 0.1;                              // of a voxel [m]
inline constexpr double largest_amplitude = 0.9;                          // a rest length must stay above 0
inline constexpr std::size_t most_bodies = 10'000;                        // of one file
inline constexpr std::size_t most_imported_cells = std::size_t{1} << 22;  // a robot has at most 65,535 masses

struct VoxelBody {
  int nx = 0, ny = 0, nz = 0;
  std::vector<std::uint32_t> cells;   // x fastest, then y; 0 = air, else 1 + index in `substances`
  std::vector<Substance> substances;  // of voxels [N/m of a spring]
  std::vector<std::string> names;     // of the substances
  std::vector<bool> held;             // per cell: its corners never move; empty = none

  std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(nx) *
               (static_cast<std::size_t>(y) + static_cast<std::size_t>(ny) * static_cast<std::size_t>(z));
  }
};

// The bodies of a grid, the largest first: the grid itself if it holds one, else each in a grid that just holds it.
// Voxels are connected if they share a side. Throws InputError for more than most_bodies.
std::vector<VoxelBody> separate_bodies(const VoxelBody& body);

// What the origin of an imported robot says beside its grid.
struct Provenance {
  std::string file, format;
  double length_scale = 1, time_scale = 1;
  std::string environment;
};

// How the springs of a robot with a table of its own stand for a body of voxels.
enum class SpringRule {
  equal,       // a spring has the mean stiffness of the voxels that share it; masses of 1 kg
  stretching,  // each voxel adds springs and 1 kg, so that a body of any thickness stretches, shears and weighs as
               // beams
  bending,     // the same, but limbs are softer, so that they bend as beams do
  standing     // with masses in the middles of voxels, on which the body stands (standing_body.cpp)
};

// The one body of a grid as a robot.
// With at most 22 substances that all have size 1 it is a voxel robot (mercury/voxel.h), so that it mutates, crosses
// and evolves: substance i is base material i + 1, the materials of pairs are the mean substances of two. Otherwise it
// has a table of its own, by `rule`: each spring has the mean movement of all voxels that share it, and its origin, of
// kind "import", keeps grid and substances. `most_materials` limits the table; what does not fit is rounded, see
// `rounding`. `relaxation_time` [s] is that of a beam, for bodies that stand. Throws InputError for a body that needs
// more masses than a robot can have.
Robot voxel_body_robot(const VoxelBody& body, const std::string& name, const Provenance& provenance,
                       std::size_t most_materials, Rounding& rounding, SpringRule rule = SpringRule::equal,
                       double relaxation_time = 0);

// The same by SpringRule::standing, without an origin. Materials have relaxation times, up to 3/2 of `relaxation_time`
// [s].
Robot standing_body(const VoxelBody& body, const std::string& name, double relaxation_time, std::size_t most_materials,
                    Rounding& rounding);

// Grid and substances of an origin: of a robot that was imported, was painted, or is any other voxel robot. Nothing for
// robots of other kinds. Throws InputError("/origin: ...") for an origin that breaks a rule.
std::optional<VoxelBody> voxel_body_of(const Robot& robot);

// The voxels that share a spring of the body's robot; four at most.
class SpringVoxels : public SpringCells {
 public:
  SpringVoxels(const Robot& robot, const VoxelBody& body);
  std::vector<std::size_t> of(const Spring& spring) const;

 private:
  const VoxelBody& body_;
};

// The corners and middles of held voxels become fixed masses of the body's robot.
void fix_masses(Robot& robot, const VoxelBody& body);

// Masses, springs and faces of the body, all springs of tissue. The origin has no grid.
Robot bare_robot(const VoxelBody& body, const std::string& name);

// Gives the springs these substances, one per spring, by a table of at most `most_materials` with these names of
// springs.
void set_substances(Robot& robot, const std::vector<Substance>& substances, const std::vector<std::string>& names,
                    std::size_t most_materials, Rounding& rounding);

// The origin of kind "import", with grid and substances.
std::string import_origin(const VoxelBody& body, const Provenance& provenance);

}  // namespace mercury
