// SPDX-License-Identifier: Apache-2.0
// The equations of the environments. Solvers are compiled once per environment model, so what a model does not have
// costs nothing. The combinations that the presets use have models of their own; GeneralModel has all parts and asks at
// run time which of them are there. A model has
//
//   has_faces, has_contacts, has_ground   which of the parts below a step contains
//   real_bodies                           masses may differ from 1 kg, and springs have relaxation times
//   has_flow                              whether the water may flow: damping is relative to it
//   still_water                           on_mass() is zero, so a step leaves it out
//   on_mass(v, weight)                    force on a mass that has velocity v and this weight (points.h) [N]
//   acts_on_faces()                       whether on_face() may be other than zero, if has_faces
//   on_face(normal, u, u.u, coefficients) force on a face, if has_faces [N]; see OceanModel::of_sums()
//   has_one_sided_water                   whether water may act on outward faces alone; see GeneralModel
//   sums_apart()                          whether the forces of the environment are summed apart from those of springs
//   dither()                              1 or 0, the factor of fixed_point.h's dithered() for forces on faces
//   acts_on_ground()                      whether there is ground, if has_ground
//   touch_ground(x, displacement)         contact with the ground at the end of a step, if has_ground
//
// Contacts are the same in all models: repulsion() below, with the stiffness of contact_stiffness_of().
//
// Vector is a Vec3, or a Vec3 of vectors with a robot or mass per lane (sim/cpu/kernels/lanes.h).
#pragma once

#include <algorithm>
#include <cmath>
#include <variant>

#include "mercury/configuration.h"
#include "sim/physics/springs.h"

namespace mercury {

template <class Vector>
MERCURY_HOST_DEVICE auto inner(Vector a, Vector b) {
  return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}

// Factors of the parts of a force on a face. Real is float, or a vector of floats.
template <class Real>
struct FaceCoefficients {
  Real drag, lift, tangential, normal;
  // No component of a force exceeds this times |normal| |u|^2.
  float bound() const { return std::fabs(drag) + std::fabs(lift) + std::fabs(tangential) + std::fabs(normal); }
};

// Drag and lift on faces (equation 1), with u = flow - v, where v is the mean velocity of the corners:
//
//             |                      drag, along u:    rho A / 2 (C_D - C_L) (u . n) u
//     u       |    n                 lift, along n:    rho A / 2 C_L |u|^2 n
//   ----->    |---->
//             |                      tangential drag:  rho A / 2 C_T |u_t| u_t,  u_t = u - (u . n) n
//            face
//                                    A third of the sum acts on each corner.
//
// Equation 1 as printed has v in place of u, and n as the face has it. This differs from it:
// 1. u is relative to the water, which may flow.
// 2. n points to the side that u leaves by, so u . n >= 0. With n as it is, opposite faces of a body that moves rigidly
//    cancel: the sum over a closed surface is exactly zero, and there is no drag.
// 3. Tangential drag is added, the friction of water that slides along the face. Each of the two directions has the
//    square of its own speed: the independence principle of flow past yawed cylinders, as in models of swimmers.
// 4. Hence F . u = rho A / 2 (C_D (u . n) |u|^2 + C_T |u_t|^3) >= 0: drag never adds energy to a body in still water.
struct OceanModel {
  static constexpr bool has_faces = true, has_contacts = false, has_ground = false, still_water = false;
  static constexpr bool has_tangential_drag = true, real_bodies = false, has_flow = true, has_one_sided_water = false;
  Vec3 gravity, flow, thrice_flow;
  float half_density = 0, of_sum = 0, drag_minus_lift = 0, lift = 0, tangential = 0;

  OceanModel(const FaceDrag& water, Vec3 gravity_)
      : gravity(gravity_), flow(water.flow), thrice_flow(3.0f * water.flow), half_density(water.density / 2),
        of_sum(half_density / -54), drag_minus_lift(water.drag_coefficient - water.lift_coefficient),
        lift(water.lift_coefficient), tangential(water.drag_tangential) {}

  template <class Vector>
  MERCURY_HOST_DEVICE Vector on_mass(Vector) const {
    return {gravity.x, gravity.y, gravity.z};
  }

  MERCURY_HOST_DEVICE bool acts_on_faces() const { return true; }
  MERCURY_HOST_DEVICE float dither() const { return 0; }
  MERCURY_HOST_DEVICE static constexpr bool sums_apart() { return false; }

  // For a normal and a flow of any length, with coefficients scaled to match. Both orientations give the same force:
  // instead of turning n, the terms take the sign of u . n:
  //
  //   flux  = normal . u
  //   F     = drag |flux| u  +  lift sign(flux) |u|^2 normal
  //
  // If normal and u both have the opposite sign, coefficients of the opposite sign give the same bits.
  template <class Vector, class Real>
  MERCURY_HOST_DEVICE static Vector on_face(Vector normal, Vector u, Real speed_squared, FaceCoefficients<Real> by) {
    return drag_and_lift(normal, u, speed_squared, by) + tangential_drag(normal, u, by.tangential);
  }

  template <class Vector, class Real>
  MERCURY_HOST_DEVICE static Vector drag_and_lift(Vector normal, Vector u, Real speed_squared,
                                                  FaceCoefficients<Real> by) {
    const auto flux = inner(normal, u);
    const auto along_flow = by.drag * absolute(flux);
    const auto along_normal = by.lift * negated_where(flux < 0.0f, speed_squared);
    return {multiply_add(along_flow, u.x, along_normal * normal.x),
            multiply_add(along_flow, u.y, along_normal * normal.y),
            multiply_add(along_flow, u.z, along_normal * normal.z)};
  }

  // coefficient |normal| |u_t| u_t. A face without area has no direction, and feels none.
  template <class Vector, class Real>
  MERCURY_HOST_DEVICE static Vector tangential_drag(Vector normal, Vector u, Real coefficient) {
    const auto squared = inner(normal, normal);
    const auto inverse_length = select(squared > 1e-30f, inverse_sqrt(squared), 0.0f);
    const Vector n{inverse_length * normal.x, inverse_length * normal.y, inverse_length * normal.z};
    const auto across = inner(n, u);
    const Vector along{fnma(across, n.x, u.x), fnma(across, n.y, u.y), fnma(across, n.z, u.z)};
    const auto factor = coefficient * (squared * inverse_length) * square_root(inner(along, along));
    return {factor * along.x, factor * along.y, factor * along.z};
  }

  // Coefficients for the force on one corner, times `scale`, a power of two, for vectors that need no multiplication to
  // compute; `of_sum` = rho / 2 / -54:
  //
  //   normal = -2 A n      cross product of two edges
  //   sum    = -3 u        sum of the corners' velocities, minus 3 flow
  //   F / 3  = rho A / 6 (... (u . n) u + ... |u|^2 n)
  //          = -rho / 108 (... |normal . sum| sum + ... |sum|^2 normal)
  MERCURY_HOST_DEVICE FaceCoefficients<float> of_sums(float scale) const {
    const float common = of_sum * scale;
    return {common * drag_minus_lift, common * lift, common * tangential, 0};
  }
  // Coefficients for A n and u themselves.
  MERCURY_HOST_DEVICE FaceCoefficients<float> coefficients() const {
    return {half_density * drag_minus_lift, half_density * lift, half_density * tangential, 0};
  }
};

// Water that does not flow, without tangential drag and gravity, as it is by default. Steps do not compute what is
// zero.
struct StillWaterOceanModel : OceanModel {
  static constexpr bool has_tangential_drag = false, has_flow = false, still_water = true;
  static constexpr double min_dt = 1e-6;  // [s]; below, dt times a unit of force may not be exact
  static bool fits(const OceanModel& model, double dt) {
    return model.tangential == 0 && model.flow == Vec3{} && model.gravity == Vec3{} && dt >= min_dt;
  }

  template <class Vector, class Real>
  MERCURY_HOST_DEVICE static Vector on_face(Vector normal, Vector u, Real speed_squared, FaceCoefficients<Real> by) {
    return drag_and_lift(normal, u, speed_squared, by);
  }
};

// Resistive drag on faces: the motion across a face and the motion along it are resisted apart.
//
//             |                      across:   rho A / 2 C_N |u_n| u_n,   u_n = (u . n) n
//     u       |    n                 along:    rho A / 2 C_T |u_t| u_t,   u_t = u - u_n
//   ----->    |---->
//             |                      A third of the sum acts on each corner.
//           face
//
// A closed body feels its windward and its leeward faces, so its coefficient is twice the face's: a plate of one voxel
// that moves across itself has a drag coefficient of 2 C_N on one side's area. F . u >= 0: drag never adds energy.
struct ResistiveModel {
  static constexpr bool has_faces = true, has_contacts = true, has_ground = false, still_water = false;
  static constexpr bool has_tangential_drag = true, real_bodies = true, has_flow = true, has_one_sided_water = false;
  Vec3 gravity, flow, thrice_flow;
  float half_density = 0, of_sum = 0, normal = 0, tangential = 0;

  ResistiveModel(const ResistiveDrag& water, Vec3 gravity_)
      : gravity(gravity_), flow(water.flow), thrice_flow(3.0f * water.flow), half_density(water.density / 2),
        of_sum(half_density / -54), normal(water.normal_coefficient), tangential(water.tangential_coefficient) {}

  template <class Vector, class Real>
  MERCURY_HOST_DEVICE Vector on_mass(Vector, Real weight) const {
    return {weight * gravity.x, weight * gravity.y, weight * gravity.z};
  }
  MERCURY_HOST_DEVICE bool acts_on_faces() const { return true; }
  MERCURY_HOST_DEVICE float dither() const { return 1; }
  MERCURY_HOST_DEVICE static constexpr bool sums_apart() { return true; }

  // |normal| (normal_coefficient |u_n| u_n + tangential_coefficient |u_t| u_t). Both orientations give the same force.
  // A face without area has no direction, and feels none.
  template <class Vector, class Real>
  MERCURY_HOST_DEVICE static Vector on_face(Vector normal, Vector u, Real, FaceCoefficients<Real> by) {
    const auto squared = inner(normal, normal);
    const auto inverse_length = select(squared > 1e-30f, inverse_sqrt(squared), 0.0f);
    const auto length = squared * inverse_length;
    const Vector n{inverse_length * normal.x, inverse_length * normal.y, inverse_length * normal.z};
    const auto across = inner(n, u);
    const Vector along{fnma(across, n.x, u.x), fnma(across, n.y, u.y), fnma(across, n.z, u.z)};
    const auto slide = inner(along, along);
    const auto factor = by.tangential * length * (slide * inverse_sqrt(slide + 1e-30f));
    const auto push = by.normal * length * absolute(across) * across;
    return {multiply_add(push, n.x, factor * along.x), multiply_add(push, n.y, factor * along.y),
            multiply_add(push, n.z, factor * along.z)};
  }

  // As those of OceanModel.
  MERCURY_HOST_DEVICE FaceCoefficients<float> of_sums(float scale) const {
    const float common = of_sum * scale;
    return {0, 0, common * tangential, common * normal};
  }
};

// Drag on each mass, F = -drag v (paper, II.E).
struct OceanSimpleModel {
  static constexpr bool has_faces = false, has_contacts = false, has_ground = false, still_water = false;
  static constexpr bool real_bodies = false, has_flow = false;
  MERCURY_HOST_DEVICE static constexpr bool sums_apart() { return false; }
  Vec3 gravity, flow;
  float drag = 0;

  OceanSimpleModel(const PointDrag& water, Vec3 gravity_)
      : gravity(gravity_), flow(water.flow), drag(water.point_drag) {}

  template <class Vector>
  MERCURY_HOST_DEVICE Vector on_mass(Vector v) const {
    return {multiply_add(drag, flow.x - v.x, gravity.x), multiply_add(drag, flow.y - v.y, gravity.y),
            multiply_add(drag, flow.z - v.z, gravity.z)};
  }
};

// Ground at z = 0 with Coulomb friction, resolved on positions at the end of a step:
//
//        o x            x is the start of the step, x' its end without the ground.
//         .
//   -------.-+------    z = 0
//           .| depth    The mass is put back to z = 0. Friction shortens its tangential displacement by at most
//            o x'       friction * depth, because a deeper contact means a larger normal force.
//
// A displacement of at most static_friction * depth is undone whole: the mass was at rest and stays there, or it moves
// so slowly that it comes to rest.
//
// `x` is the position at the end of the step and `displacement` the way the mass moved in it. Corrects both. Returns
// whether the mass touched the ground.
template <class Vector>
MERCURY_HOST_DEVICE auto touch_plane(Vector& x, Vector& displacement, float friction, float static_friction) {
  const auto depth = -x.z;
  const auto touched = depth > 0.0f;
  const auto moved = square_root(multiply_add(displacement.y, displacement.y, displacement.x * displacement.x));
  const auto undone = select(moved > static_friction * depth, friction * depth / moved, 1.0f);
  x = select(touched, Vector{fnma(undone, displacement.x, x.x), fnma(undone, displacement.y, x.y), 0.0f}, x);
  displacement = select(touched,
                        Vector{fnma(undone, displacement.x, displacement.x),
                               fnma(undone, displacement.y, displacement.y), displacement.z + depth},
                        displacement);
  return touched;
}

inline float static_friction_of(const Plane& ground) { return std::max(ground.friction, ground.static_friction); }

// Ground and contacts without water.
struct LandModel {
  static constexpr bool has_faces = false, has_contacts = true, has_ground = true, still_water = false;
  static constexpr bool real_bodies = false, has_flow = false;
  MERCURY_HOST_DEVICE static constexpr bool sums_apart() { return false; }
  Vec3 gravity;
  float friction = 0, static_friction = 0;

  LandModel(const Plane& ground, Vec3 gravity_)
      : gravity(gravity_), friction(ground.friction), static_friction(static_friction_of(ground)) {}

  template <class Vector>
  MERCURY_HOST_DEVICE Vector on_mass(Vector) const {
    return {gravity.x, gravity.y, gravity.z};
  }
  MERCURY_HOST_DEVICE bool acts_on_ground() const { return true; }
  template <class Vector>
  MERCURY_HOST_DEVICE auto touch_ground(Vector& x, Vector& displacement) const {
    return touch_plane(x, displacement, friction, static_friction);
  }
};

// Any combination, and any bodies. Parts that are not there are skipped or have coefficients of zero.
struct GeneralModel : OceanModel {
  static constexpr bool has_contacts = true, has_ground = true, real_bodies = true, has_one_sided_water = true;
  float drag = 0, friction = 0, static_friction = 0, normal = 0;
  bool face_drag = false, ground = false, is_resistive = false, one_sided = false;

  explicit GeneralModel(const Environment& environment)
      : OceanModel(face_drag_of(environment), environment.gravity), face_drag(has_face_forces(environment)),
        ground(mercury::has_ground(environment)),
        is_resistive(std::holds_alternative<ResistiveDrag>(environment.water)) {
    flow = flow_of(environment);
    if (const auto* water = std::get_if<PointDrag>(&environment.water)) drag = water->point_drag;
    if (const auto* water = std::get_if<ResistiveDrag>(&environment.water)) {
      normal = water->normal_coefficient;
      one_sided = water->one_sided;
    }
    if (const auto* plane = std::get_if<Plane>(&environment.ground)) {
      friction = plane->friction;
      static_friction = static_friction_of(*plane);
    }
  }

  template <class Vector, class Real>
  MERCURY_HOST_DEVICE Vector on_mass(Vector v, Real weight) const {
    return {multiply_add(drag, flow.x - v.x, weight * gravity.x), multiply_add(drag, flow.y - v.y, weight * gravity.y),
            multiply_add(drag, flow.z - v.z, weight * gravity.z)};
  }
  MERCURY_HOST_DEVICE bool acts_on_faces() const { return face_drag; }
  MERCURY_HOST_DEVICE float dither() const { return is_resistive ? 1.0f : 0.0f; }
  MERCURY_HOST_DEVICE bool sums_apart() const { return is_resistive; }
  // One of the two has coefficients of zero, and adds nothing.
  template <class Vector, class Real>
  MERCURY_HOST_DEVICE static Vector on_face(Vector normal, Vector u, Real speed_squared, FaceCoefficients<Real> by) {
    return drag_and_lift(normal, u, speed_squared, by) + ResistiveModel::on_face(normal, u, speed_squared, by);
  }
  MERCURY_HOST_DEVICE FaceCoefficients<float> of_sums(float scale) const {
    FaceCoefficients<float> by = OceanModel::of_sums(scale);
    by.normal = of_sum * scale * normal;
    return by;
  }
  MERCURY_HOST_DEVICE FaceCoefficients<float> coefficients() const {
    FaceCoefficients<float> by = OceanModel::coefficients();
    by.normal = half_density * normal;
    return by;
  }
  // For one-sided water, before of_sums() and on_face(). `to_back` leads from the face to the mass behind it
  // (face_backs.h), `velocity` is that mass's. The sum of the corners' velocities becomes three times the velocity
  // halfway to that mass, and a face that moves toward it loses its normal drag:
  //
  //      face   |--> u       pushed                depth   = normal . to_back
  //             |            sum . normal          outward = -normal if depth > 0, else normal
  //      body   o            and depth have        sum . outward > 0 where sum . normal and depth have unlike signs
  //                          unlike signs
  //
  // Where to_back is zero, nothing is behind the face: it stays as it is.
  template <class Vector, class Real>
  MERCURY_HOST_DEVICE void see_from_outside(Vector face_normal, Vector to_back, Vector velocity, Vector& sum,
                                            FaceCoefficients<Real>& by) const {
    const auto depth = inner(face_normal, to_back);
    const Vector halfway{0.5f * (sum.x + (3.0f * velocity.x - thrice_flow.x)),
                         0.5f * (sum.y + (3.0f * velocity.y - thrice_flow.y)),
                         0.5f * (sum.z + (3.0f * velocity.z - thrice_flow.z))};
    const auto has_back = absolute(depth) > 0.0f;
    sum = {select(has_back, halfway.x, sum.x), select(has_back, halfway.y, sum.y), select(has_back, halfway.z, sum.z)};
    by.normal = select(inner(face_normal, sum) * depth > 0.0f, 0.0f, by.normal);
  }
  MERCURY_HOST_DEVICE bool acts_on_ground() const { return ground; }
  template <class Vector>
  MERCURY_HOST_DEVICE auto touch_ground(Vector& x, Vector& displacement) const {
    return touch_plane(x, displacement, friction, static_friction);
  }

 private:
  static FaceDrag face_drag_of(const Environment& environment) {
    if (const auto* water = std::get_if<FaceDrag>(&environment.water)) return *water;
    if (const auto* water = std::get_if<ResistiveDrag>(&environment.water))
      return {.density = water->density,
              .drag_coefficient = 0,
              .lift_coefficient = 0,
              .drag_tangential = water->tangential_coefficient,
              .flow = water->flow};
    FaceDrag none;
    none.density = 0;
    return none;
  }
};

// The models that both backends compile their kernels for.
using AnyEnvironmentModel =
    std::variant<OceanModel, StillWaterOceanModel, OceanSimpleModel, LandModel, ResistiveModel, GeneralModel>;

// The fastest model that describes the environment. `real_bodies`: whether a robot has masses other than 1 kg, fixed
// masses, or springs with a relaxation time (points.h).
inline AnyEnvironmentModel solver_model_of(const Configuration& configuration, bool real_bodies = false) {
  const Environment& environment = configuration.environment;
  const Vec3 gravity = environment.gravity;
  const auto* resistive = std::get_if<ResistiveDrag>(&environment.water);
  if (resistive && !resistive->one_sided && !has_ground(environment)) return ResistiveModel(*resistive, gravity);
  if (real_bodies || resistive) return GeneralModel(environment);
  const auto* plane = std::get_if<Plane>(&environment.ground);
  if (!has_water(environment) && plane) return LandModel(*plane, gravity);
  if (has_ground(environment) || has_contacts(environment)) return GeneralModel(environment);
  if (const auto* water = std::get_if<FaceDrag>(&environment.water)) {
    const OceanModel model(*water, gravity);
    if (StillWaterOceanModel::fits(model, configuration.dt)) return StillWaterOceanModel{model};
    return model;
  }
  if (const auto* water = std::get_if<PointDrag>(&environment.water); water && water->flow == Vec3{})
    return OceanSimpleModel(*water, gravity);
  if (!has_water(environment)) return OceanSimpleModel(PointDrag{.point_drag = 0}, gravity);
  return GeneralModel(environment);
}

// Repulsion of two masses that no spring joins, F = k_c (distance - |d|) away from each other; zero at and beyond the
// distance. The force on the first mass is this times d = x_second - x_first: -k_c (distance - |d|) / |d|.
MERCURY_HOST_DEVICE float repulsion(float squared, float distance, float stiffness) {
  return squared < distance * distance ? stiffness * multiply_add(-distance, inverse_sqrt(squared), 1.0f) : 0.0f;
}

// k_c [N/m], without the stiffness scale.
inline float unlimited_contact_stiffness(const Contacts& contacts, float stiffest) {
  return contacts.relative_stiffness > 0 ? contacts.relative_stiffness * stiffest : contacts.contact_stiffness;
}

// k_c of a robot in a step [N/m], 0 without contacts. `stiffest` is k of its stiffest spring [N/m] without the
// stiffness scale, `lightest` the inertia of its lightest mass [kg]. Repulsion is an explicit force, which can be
// unstable at long time steps, while XPBD is stable at any. So with XPBD a contact moves a mass by at most 1/8 of the
// missing distance per step: k_c dt^2 <= m / 8. That is stable with up to 16 contacts per mass. With the default
// parameters it changes nothing below dt = 2.5e-3 s.
inline float contact_stiffness_of(const Environment& environment, Solver solver, double dt, float stiffest,
                                  float lightest) {
  if (!has_contacts(environment)) return 0;
  const float stiffness = unlimited_contact_stiffness(*environment.contacts, stiffest) * environment.stiffness_scale;
  return solver == Solver::xpbd ? std::fmin(stiffness, lightest * static_cast<float>(0.125 / (dt * dt))) : stiffness;
}

}  // namespace mercury
