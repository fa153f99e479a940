// SPDX-License-Identifier: Apache-2.0
// Small robots side by side, one a lane: what a vector loads of a mass or a spring then is that of as many robots, and
// few lanes are empty. The robots of a group are of one build, or of builds that have most in common (sim/cpu/build.h).
//
// A group keeps its robots' state from call to call. It is stepped as long as all goes well in it. If a robot of it
// explodes, the steps since the last checkpoint are made again one robot after the other (sim/cpu/stepper.h), where all
// that an explosion asks for is done; both ways give the same bits.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/cpu/body.h"
#include "sim/cpu/build.h"
#include "sim/cpu/step.h"

namespace mercury::cpu {

struct Lockstep {
  std::shared_ptr<const Build> build;
  std::size_t lanes = 1;
  std::vector<std::size_t> bodies;  // one a lane; lanes that are left do what the first does
  // Of the build, with the place where a seat's values start in x instead of its number.
  std::vector<std::uint32_t> partners;
  struct Joint {
    std::uint32_t owned = 0;
    std::int32_t bias = 0;  // takes out again what the integers of the springs carry (sim/physics/fixed_point.h)
  };
  std::vector<Joint> joints;
  // Slots of pairs of faces. In those that are split, lanes of the lower half stand at other seats than those of the
  // upper: two of the build's pairs that few robots have.
  struct Halves {
    std::uint32_t lower = 0, upper = 0;
  };
  template <class Seat>
  struct Corners {
    Seat a{}, b{}, c{}, d{};
  };
  std::vector<Corners<std::uint32_t>> faces;
  std::vector<Corners<Halves>> split_faces;
  std::vector<std::uint32_t> face_slots;  // by the build's pairs; split ones are numbered after the others
  // Of every lane.
  std::vector<std::shared_ptr<const Seating>> seatings;
  std::vector<Body*> members;  // from load() on

  // [slot][lane], as in SpringPlan; no force where a robot has no spring
  Aligned<float> rest_length, hardness;
  Aligned<FactorId> factor;
  // [slot of pairs of faces][lane]: OceanModel::of_sums() in units; 0 where a robot has no such faces
  Aligned<float> face_drag, face_lift;

  // [seat][x, y, z][lane]
  Aligned<float> x, v;         // during XPBD's springs: the prediction and v + dt F
  Aligned<std::int32_t> sums;  // what acts on the masses, in units; zero between steps
  Aligned<float> checkpoint_x, checkpoint_v;
  // Where the masses were when their robot's near pairs were listed, and which of its lists that was, by lane.
  Aligned<float> listed_x;
  std::vector<std::uint64_t> lists;  // empty = none
  Aligned<float> is_mass;            // [seat][lane]: 1, or 0 for a stand-in

  // A stand-in moves like a free mass, and is brought back to its robot's first mass now and then.
  struct StandIn {
    std::uint32_t seat = 0, lane = 0;
  };
  std::vector<StandIn> stand_ins;
  std::int64_t steps_since_settled = 0;

  struct LanePerturbation {
    std::size_t first = 0;  // of x
    Vec3 target;            // [m]
    float stiffness = 0;    // [units/m]
  };
  std::vector<LanePerturbation> perturbations;

  // Of each lane's robot.
  Aligned<float> force_scale, correction_scale;  // FixedPointScale
  Aligned<float> squared_stretch_limit;
  Aligned<float> contact_distance;
  Aligned<float> most_force;        // of a face, less than this times |2 A n| |sum of velocities|^2 [units]
  Aligned<float> squared_diagonal;  // of a box around all of a lane's masses [m2]; infinite if not known

  bool resident() const { return !members.empty() && members.front()->residence.group == this; }
  std::uint32_t start_of(std::uint32_t seat) const { return static_cast<std::uint32_t>(3 * lanes) * seat; }
  std::size_t first_of(std::uint32_t seat, std::size_t lane) const { return start_of(seat) + lane; }
};

// A group of 1 to as many bodies as they have lanes, without laws or state.
Lockstep make_lockstep(std::span<const Body> bodies, std::vector<std::size_t> members, Assembly assembly,
                       bool contacts);

// Takes the bodies' laws as they stand; `factors`, by body, are those of their materials.
void take_laws(Lockstep& group, std::span<const Body> bodies, const AnyEnvironmentModel& model,
               std::span<const std::array<FactorId, max_materials>> factors);

// Takes the bodies' states, which reside here from then on; gives them back.
void load(Lockstep& group, std::span<Body> bodies);
void store(Lockstep& group);

// Brings stand-ins back where they wander too far.
void settle_stand_ins(Lockstep& group, std::int64_t steps_ahead);

// Takes the members' pulls; adds their forces.
void take_perturbations(Lockstep& group);
void add_perturbations(Lockstep& group);

// Lists the near pairs of these lanes' robots, one bit a lane, where they are now; adds the forces of all lanes'
// contacts. `list` does it for a body whose masses are at body.x.
void list_near_pairs(Lockstep& group, std::uint32_t lanes, void (*list)(Body&));
void add_contacts(Lockstep& group, float stiffness);

void make_checkpoint(Lockstep& group);
void return_to_checkpoint(Lockstep& group);

}  // namespace mercury::cpu
