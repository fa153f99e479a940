// SPDX-License-Identifier: Apache-2.0
// Robots of a real material: springs and masses from a modulus and a density, whatever the resolution.
//
// The paper's robots have masses of 1 kg and springs of 50 N/m, so their density and modulus follow from how finely
// they are divided. Here the user says both, and a robot that is divided more finely is the same body.
#pragma once

#include <optional>
#include <tuple>
#include <vector>

#include "mercury/generator.h"
#include "mercury/parameters.h"
#include "mercury/physics.h"
#include "mercury/robot.h"

namespace mercury {

// A material such as silicone. Poisson's ratio is 1/4, as of every network of springs that only pull and push
// (Cauchy's relations).
struct RealMaterial {
  float modulus = 1e5f;           // Young's, of the robot's muscles [Pa]
  float density = 1070;           // [kg/m3]
  float relaxation_time = 0.01f;  // tau of the damping inside the body (Material::relaxation_time) [s]
  // What each material of the robot's table is made of, by id: [Pa], [kg/m3], [s], all 0 for air. If it is empty, their
  // stiffnesses say how much stiffer than muscles they are.
  struct Own {
    float modulus = 0, density = 0, relaxation_time = 0;
    friend bool operator==(const Own&, const Own&) = default;
  };
  std::vector<Own> each;
  friend bool operator==(const RealMaterial&, const RealMaterial&) = default;

  static constexpr std::tuple parameters{
      Parameter("modulus", &RealMaterial::modulus, "Pa", Accepts::above_zero, {1e3f, 1e7f, true},
                "Young's modulus of muscles; tissue and bone are as stiff beside them as before"),
      Parameter("body_density", &RealMaterial::density, "kg/m3", Accepts::above_zero, {100, 3000},
                "Density of the body"),
      Parameter("relaxation_time", &RealMaterial::relaxation_time, "s", Accepts::at_least_zero, {0, 0.05f},
                "Relaxation time of the damping inside the body")};
};

// The robot with masses and springs of a real material, or of several if `each` says so. Otherwise the robot's muscles
// (the median of their stiffnesses, or 50 N/m without muscles) get the modulus, and a material that is r times as stiff
// gets r times the modulus; amplitudes, frequencies and phases stay, and so do points, faces and actuators, but for the
// faces of sealed cavities, which no water reaches.
//
// A robot of voxels (every spring joins two corners of a cube with all of its 28 springs): each voxel of edge h adds to
// its springs
//
//   k_edge = 0.15 E h,   k_diagonal = 0.10 E h across a side,   0.15 E h through the middle,    and rho h^3 / 8 to its
//   corners
//
// so a spring or a mass of several voxels has the sum. Inside, that makes 4 k_edge, 2 k_diagonal: an isotropic solid
// with modulus E and Poisson's ratio 1/4, since C11 = 3 C12 for these three (docs/physics.md). A voxel at the surface
// carries just its own share, so a bar has the modulus E however many voxels it has across. Voxels of different
// materials that share a spring give it one spring each.
//
// A robot of hexahedra (Generator::cells): the same with the springs and masses of each by its sizes
// (robots/hexahedra.h). Springs are at most 0.35 E / (rho h^2) as stiff as the smaller mass at their ends, h the mean
// length of the cells.
//
// Any other robot: all springs times one factor, so that an isotropic network of muscles has the modulus on average
// (sum of k L0^2 = 6 E V, with the volume V within the skin), and masses in proportion to the L0^2 of their springs.
//
// The origin says "real": {"modulus": ..., "density": ..., "relaxation_time": ..., "each": [[...], ...]}. Throws
// InputError("/faces", ...) for a robot of the second kind without a skin around a volume, and for one that has a real
// body already.
Robot with_real_body(const Robot& robot, const RealMaterial& material);

// Parameters that all generators have (generator.h): physics (paper or real), modulus, body_density, relaxation_time.
// What they say; none for the paper's physics, and with the defaults for what is missing.
std::optional<RealMaterial> real_material_in(const ParameterValues& values);

// What the robot's origin says of a real body; none for a robot as in the paper. Throws InputError("/origin/real/...").
std::optional<RealMaterial> real_material_of(const Robot& robot);

// What a robot was made for: what its origin says.
Physics physics_of(const Robot& robot);

// A robot of the paper again, for its generator to grow, mutate and cross: the materials that it had, no masses, and
// an origin without "real". Its springs are still those of the real body.
Robot without_real_body(const Robot& robot);

}  // namespace mercury
