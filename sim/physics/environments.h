// SPDX-License-Identifier: Apache-2.0
// The three environments as the solvers see them. A new one is one struct with these functions:
//   has_faces, has_contacts, has_floor, still_water   what a step has to do, known at compile time
//   on_mass(v)                               force on a unit mass of velocity v [N]
//   on_face(area_normal, v)                  force on a face, if has_faces
//   on_face(normal, u, u.u, drag, lift)      the same with fewer multiplications, for of_sums()
//   floor(x, displacement)                   resolves the end of a step on positions, if has_floor
// Vector is a Vec3 or a vector of several (sim/cpu/lanes.h).
#pragma once

#include "mercury/configuration.h"
#include "sim/physics/springs.h"

namespace mercury {

template <class Vector>
MERCURY_HOST_DEVICE auto inner(Vector a, Vector b) {
  return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}

struct OceanModel {
  static constexpr bool has_faces = true, has_contacts = false, has_floor = false, still_water = false;
  Vec3 gravity, flow, thrice_flow;
  float half_density = 0, drag_minus_lift = 0, lift = 0;

  explicit OceanModel(const Ocean& ocean)
      : gravity(ocean.gravity), flow(ocean.flow), thrice_flow(3.0f * ocean.flow), half_density(ocean.density / 2),
        drag_minus_lift(ocean.drag_coefficient - ocean.lift_coefficient), lift(ocean.lift_coefficient) {}

  template <class Vector>
  MERCURY_HOST_DEVICE Vector on_mass(Vector) const {
    return {gravity.x, gravity.y, gravity.z};
  }

  // Eq. 1 with the flow relative to the face, u = flow - v, and the normal turned to the side that u leaves by, so that
  // drag never adds energy. As printed (v itself, the normal as it is) the sum over a closed rigid body is zero.
  // `area_normal` is A n; either orientation gives the same force.
  template <class Vector>
  MERCURY_HOST_DEVICE Vector on_face(Vector area_normal, Vector velocity) const {
    const Vector u = flow - velocity;
    return on_face(area_normal, u, inner(u, u), half_density * drag_minus_lift, half_density * lift);
  }

  // The same for normals and flows (u) of another length, the coefficients scaled to match. Both the other way around,
  // with coefficients of the other sign, give the same bits.
  template <class Vector, class Real>
  MERCURY_HOST_DEVICE static Vector on_face(Vector normal, Vector u, Real speed_squared, Real drag, Real lift) {
    const auto flux = inner(normal, u);
    const auto along_flow = drag * absolute(flux);
    const auto along_normal = lift * negated_where(flux < 0.0f, speed_squared);
    return {multiply_add(along_flow, u.x, along_normal * normal.x),
            multiply_add(along_flow, u.y, along_normal * normal.y),
            multiply_add(along_flow, u.z, along_normal * normal.z)};
  }

  // Coefficients for a third of the force times `scale`, of 2 A n and of the sum of u over the face's masses, which
  // need no multiplication; both vectors the other way around.
  struct Coefficients {
    float drag = 0, lift = 0;
    // No component of a force is more than this times |normal| |u|^2.
    float most() const { return std::fabs(drag) + std::fabs(lift); }
  };
  Coefficients of_sums(float scale) const {
    const float common = -half_density * scale / 54;
    return {common * drag_minus_lift, common * lift};
  }
};

// Water that does not flow, without gravity: nothing acts on a mass but what acts on its faces.
struct StillWaterOceanModel : OceanModel {
  static constexpr bool still_water = true;
  static bool fits(const OceanModel& model) { return model.flow == Vec3{} && model.gravity == Vec3{}; }
};

struct OceanSimpleModel {
  static constexpr bool has_faces = false, has_contacts = false, has_floor = false, still_water = false;
  Vec3 gravity, flow;
  float drag = 0;

  explicit OceanSimpleModel(const OceanSimple& ocean)
      : gravity(ocean.gravity), flow(ocean.flow), drag(ocean.point_drag) {}

  template <class Vector>
  MERCURY_HOST_DEVICE Vector on_mass(Vector v) const {
    return {multiply_add(drag, flow.x - v.x, gravity.x), multiply_add(drag, flow.y - v.y, gravity.y),
            multiply_add(drag, flow.z - v.z, gravity.z)};
  }
};

struct LandModel {
  static constexpr bool has_faces = false, has_contacts = true, has_floor = true, still_water = false;
  Vec3 gravity;
  float friction = 0;

  explicit LandModel(const Land& land) : gravity(land.gravity), friction(land.friction) {}

  template <class Vector>
  MERCURY_HOST_DEVICE Vector on_mass(Vector) const {
    return {gravity.x, gravity.y, gravity.z};
  }

  // A mass that would end below the floor ends on it, and moves along it less by at most friction times its depth.
  // `x` is where the step ends and `displacement` what it moved; both are mended. True if the mass touched.
  template <class Vector>
  MERCURY_HOST_DEVICE auto floor(Vector& x, Vector& displacement) const {
    const auto depth = -x.z;
    const auto touched = depth > 0.0f;
    const auto moved = square_root(multiply_add(displacement.y, displacement.y, displacement.x * displacement.x));
    const auto held = friction * depth;
    const auto undone = select(moved > held, held / moved, 1.0f);
    x = select(touched, Vector{fnma(undone, displacement.x, x.x), fnma(undone, displacement.y, x.y), 0.0f}, x);
    displacement = select(touched,
                          Vector{fnma(undone, displacement.x, displacement.x),
                                 fnma(undone, displacement.y, displacement.y), displacement.z + depth},
                          displacement);
    return touched;
  }
};

inline OceanModel model_of(const Ocean& ocean) { return OceanModel(ocean); }
inline OceanSimpleModel model_of(const OceanSimple& ocean) { return OceanSimpleModel(ocean); }
inline LandModel model_of(const Land& land) { return LandModel(land); }

// Repulsion of two masses that no spring joins: the force on the first is this times d = x_second - x_first, pointing
// away from the second, k_c (distance - |d|) / |d|; zero at and beyond the distance.
MERCURY_HOST_DEVICE float repulsion(float squared, float distance, float stiffness) {
  return squared < distance * distance ? stiffness * multiply_add(-distance, inverse_sqrt(squared), 1.0f) : 0.0f;
}

// k_c of a step [N/m]. Repulsion is an explicit force, and XPBD promises to be stable at any time step: there one
// contact moves a mass by at most an eighth of the distance missing a step, which is stable with up to 16 contacts at a
// mass. (On land as it comes that softens nothing below dt = 2.5e-3 s.)
inline float contact_stiffness_of(const Land& land, Solver solver, double dt) {
  if (!land.self_collision) return 0;
  const float stiffness = land.contact_stiffness * land.stiffness_scale;
  return solver == Solver::xpbd ? std::fmin(stiffness, static_cast<float>(0.125 / (dt * dt))) : stiffness;
}

}  // namespace mercury
