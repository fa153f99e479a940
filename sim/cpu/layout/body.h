// SPDX-License-Identifier: Apache-2.0
// One robot as the CPU steps it alone: structure of arrays, so that a vector holds the same quantity of a tile's
// masses.
//
// Fixed-point sums. What acts on a mass is summed as 32-bit integers (sim/physics/fixed_point.h), so that a sum does
// not depend on the order of its terms. A slot has four sums, each filled by another part of the step:
//
//   own         springs that the mass owns                     stored once per step
//   reaction    runs in which it is the partner or a corner,   reaction_arrays arrays
//               perturbations, contacts
//   scattered   gathered rows in which it is the partner,      x, y, z, unused: 16 bytes per slot
//               gathered faces
//   taken       reaction + scattered when they were last read
//
//   force = own + reaction[0] + reaction[1] + ... + scattered - taken + bias
//
// 1. Nothing is set to zero. `reaction` and `scattered` only grow, and wrap around; the difference to `taken` is what
//    this step has added.
// 2. Springs are rounded by adding a magic number, which leaves rounding_magic_bits in every integer. Subtracting it
//    from each would cost three instructions per row. It stays in the sums instead, and SpringSchedule::bias takes out
//    all that a slot receives in one step.
// 3. Partners that stand anywhere are one access of 16 bytes in an array of structures (aos), instead of three of four
//    bytes. Positions and velocities have such copies as well; they are maintained only if faces or gathered rows need
//    them.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "mercury/backend.h"
#include "sim/cpu/layout/aligned.h"
#include "sim/cpu/layout/drives.h"
#include "sim/cpu/layout/lattice_cells.h"
#include "sim/cpu/layout/near_pairs.h"
#include "sim/cpu/layout/slots.h"
#include "sim/cpu/layout/spring_schedule.h"
#include "sim/cpu/layout/step_setting.h"
#include "sim/physics/measures.h"

namespace mercury::cpu {

// x, y and z by slot.
template <class T>
struct Triples {
  Aligned<T> x, y, z;
  void assign(std::size_t n, T value) {
    x.assign(n, value);
    y.assign(n, value);
    z.assign(n, value);
  }
};

// In units of FixedPointScale; see above.
struct Sums {
  Triples<std::int32_t> own;
  Triples<std::int32_t> reaction;  // reaction_arrays arrays, consecutive
  Aligned<std::int32_t> scattered;
  Triples<std::int32_t> taken;
  bool with_scattered = false;  // whether `taken` includes `scattered`
};
void clear(Sums& sums);

struct LockstepGroup;

// Where the state of a body is while a lockstep group holds it.
struct StateLocation {
  LockstepGroup* group = nullptr;          // nullptr = in the body itself
  const float *x = nullptr, *v = nullptr;  // [slot of the group][x, y, z][lane], from the body's lane on
  const std::uint32_t* slots = nullptr;    // by mass
  std::size_t lanes = 1;

  Vec3 at(const float* values, std::size_t mass) const {
    const float* const first = values + 3 * lanes * slots[mass];
    return {first[0], first[lanes], first[2 * lanes]};
  }
};

// Where a body lives that is not in the environment of the batch, and what its steps are given.
struct OwnEnvironment {
  Environment environment;
  StepSetting setting;
};

struct Body {
  const Robot* robot = nullptr;
  std::optional<OwnEnvironment> own;
  RobotMeasures measures;
  std::uint64_t topology_key = 0;  // mercury/robot.h
  std::vector<FacePair> face_pairs;
  std::vector<PairBacks> backs;  // masses_behind() the face pairs; empty until water is one-sided
  std::vector<LatticeCell> cells;
  Slots slots;
  std::span<const Material> materials;      // by id, as they are now: those of the robot, or `changed_materials`
  std::vector<Material> changed_materials;  // max_materials elements if the caller has written or drives them
  Drives drives;
  FixedPointScale scale;
  std::vector<PointProperties> points;                // by mass; empty = masses of 1 kg, none fixed
  bool viscous = false;                               // a spring has a relaxation time
  float contact_distance = 0, contact_stiffness = 0;  // [m], [N/m]; 0 = no contacts
  // By spring, in units: k of the force solver, or xpbd_stiffness(). 0 for springs of air.
  std::vector<float> stiffness;

  // What only bodies need that are stepped alone: from prepare_to_step_alone() on.
  bool steps_alone = false;
  SpringSchedule springs;
  FaceSchedule faces;
  Aligned<float> inverse_inertia, weight;  // PointProperties by slot; 0 in padding
  Aligned<float> x_aos, v_aos;             // [slot][x, y, z, unused]
  Sums sums;
  // What only contacts need: from prepare_contacts() on.
  NearPairs near_pairs;

  StateLocation location;  // while a group holds the state, x and v are undefined
  Triples<float> x, v;     // between XPBD's prediction and correction: the prediction and v + dt F

  float squared_diagonal = std::numeric_limits<float>::infinity();  // of the box around all masses [m2], if known
  bool aos_is_current = false;                                      // x_aos and v_aos
  bool written = true;                                              // the caller set the state, perhaps out of reach
  RobotStatus status;
  std::vector<Perturbation> perturbations;

  PointProperties point(std::size_t mass) const { return points.empty() ? PointProperties{} : points[mass]; }
  Vec3 position(std::size_t mass) const {
    return location.group ? location.at(location.x, mass) : at(x, slots.of_mass[mass]);
  }
  Vec3 velocity(std::size_t mass) const {
    return location.group ? location.at(location.v, mass) : at(v, slots.of_mass[mass]);
  }
  static Vec3 at(const Triples<float>& values, std::size_t slot) {
    return {values.x[slot], values.y[slot], values.z[slot]};
  }
};

// A body for kernels of this number of lanes, without a state. Most small robots step in groups, so the parts that
// only others need are made on request; a second request has no effect.
Body make_body(const Robot& robot, std::size_t lanes);
void prepare_to_step_alone(Body& body);
void prepare_contacts(Body& body);

// Replaces the materials by a table of max_materials elements; what the caller drives has these as its own until the
// next step. To be followed by update_spring_parameters().
void set_materials(Body& body, std::span<const Material> table);

// The batch's configuration with the body's environment.
Configuration configuration_of(const Body& body, Configuration of_batch);

// Computes what depends on materials and configuration. `configuration` is that of the batch.
void update_spring_parameters(Body& body, const Configuration& configuration);

// Sets which factor each spring reads, by material, for a body that steps alone.
void set_factors(Body& body, const std::array<FactorId, max_materials>& factors);

// No group may hold the body's state.
void set_state(Body& body, std::span<const Vec3> positions, std::span<const Vec3> velocities);

}  // namespace mercury::cpu
