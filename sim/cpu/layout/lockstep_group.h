// SPDX-License-Identifier: Apache-2.0
// Lockstep groups: small robots that are stepped together, one per lane.
//
// Stepped alone, a vector holds several masses of one robot. In a group it holds the same mass, or the same spring, of
// as many robots as it has lanes:
//
//             lane     0     1     2     3
//             member  eel   eel   eel   ray
//   slot 0    x       m0    m0    m0    m0       state: [slot][x, y, z][lane]
//   slot 1    x       m1    m1    m1    m2
//   slot 2    x       m2    m2    m2    -        - = padding: the ray has no mass here
//   entry 0   spring  s0    s0    s0    s3       between slots 0 and 1: one row of four springs
//   entry 1   spring  s1    s1    s1    -        between slots 0 and 2
//
// 1. Nothing is gathered. All partners of a row stand in one slot: one aligned load per axis.
// 2. Few lanes are unused. Members have the same topology, or topologies that have most in common (grouping/).
// 3. One pass over the slots does the step. Entries are sorted by owner, the owner being the lower slot: when a slot's
//    own entries are done, those that it is the partner in have been added, and its masses can move at once.
// 4. There is no bookkeeping of explosions. A group makes a checkpoint every few steps. If a member may have exploded,
//    the group returns to the checkpoint and breaks up; its members are stepped alone from there, and the one that
//    explodes is noted. Both ways give the same bits.
// 5. A face pair that few members have would leave most lanes of its face tile unused. Two such pairs share a split
//    face tile: one in the lower half of the lanes, the other in the upper half, if no member in that half needs the
//    other. (It makes 64 random voxel robots 4 to 7 % faster in `ocean`, 1,000 of them 1 to 3 %.)
//
// A group holds its members' state from one call to the next; Body::location says so.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/cpu/layout/body.h"
#include "sim/cpu/layout/step_setting.h"
#include "sim/cpu/layout/topology.h"

namespace mercury::cpu {

struct LockstepGroup {
  std::shared_ptr<const Topology> topology;
  std::size_t lanes = 1;
  std::vector<Body*> bodies;  // by member; there may be fewer than lanes, the other lanes repeat member 0
  std::vector<std::shared_ptr<const IndexMap>> index_maps;  // by lane

  // The topology. For a slot, `partners` and corners hold the offset where the slot's values start in x.
  struct Slot {
    std::uint32_t owned = 0;  // entries
    std::int32_t bias = 0;    // removes rounding_magic_bits from the slot's sum (see body.h)
  };
  template <class Offset>
  struct Corners {
    Offset a{}, b{}, c{}, d{};
  };
  using FaceTile = Corners<std::uint32_t>;
  struct Halves {
    std::uint32_t lower = 0, upper = 0;
  };
  using SplitFaceTile = Corners<Halves>;
  std::vector<Slot> slots;
  std::vector<std::uint32_t> partners;  // by entry
  std::vector<FaceTile> face_tiles;
  std::vector<SplitFaceTile> split_face_tiles;   // numbered after the others
  std::vector<std::uint32_t> face_tile_of_pair;  // by face pair of the topology

  // [entry][lane], as in SpringSchedule; stiffness 0 where a member has no spring.
  Aligned<float> rest_length, stiffness, relaxation_time;
  Aligned<FactorId> factor;
  // [face tile][lane]: OceanModel::of_sums() in units; 0 where a member has no such faces.
  Aligned<float> face_drag, face_lift, face_tangential, face_normal;
  Aligned<std::uint32_t> face_dither;  // dither_of_pair() of the member's pair
  // [face tile][first, second][lane]: where the member's mass behind the face has its x in x; empty = not known
  Aligned<std::uint32_t> face_backs;

  Aligned<float> inverse_inertia, weight;  // [slot][lane]: PointProperties; 0 in padding
  bool viscous = false;                    // a spring has a relaxation time

  // [slot][x, y, z][lane]
  Aligned<float> x, v;         // between XPBD's prediction and correction: the prediction and v + dt F
  Aligned<std::int32_t> sums;  // what acts on the masses, in units; zero between steps
  Aligned<float> checkpoint_x, checkpoint_v;
  Aligned<float> searched_x;            // positions when near pairs were last searched, for contacts
  std::vector<std::uint64_t> searches;  // NearPairs::searches() at that time, by lane; empty = not searched
  Aligned<float> is_mass;               // [slot][lane]: 1, or 0 in padding

  // Padding moves like a mass that nothing acts on. Now and then it is put back to mass 0 of its lane's robot.
  struct Padding {
    std::uint32_t slot = 0, lane = 0;
  };
  std::vector<Padding> padding;
  std::int64_t steps_since_padding_reset = 0;

  struct LanePerturbation {
    std::size_t offset = 0;  // in x
    Vec3 target;             // [m]
    float stiffness = 0;     // [units/m]
  };
  std::vector<LanePerturbation> perturbations;

  // By lane.
  Aligned<float> force_scale, correction_scale, environment_scale;  // FixedPointScale
  Aligned<float> squared_stretch_limit;                             // [m2]
  Aligned<float> contact_distance;                                  // [m]
  Aligned<float> highest_length_rate;                               // [m/s]
  Aligned<float> face_force_bound;  // no face's force exceeds this times |2 A n| |sum of velocities|^2 [units]
  Aligned<float> squared_diagonal;  // of the box around all masses of the lane [m2]; infinite if not known

  Body& body_in(std::size_t lane) const { return *bodies[lane < bodies.size() ? lane : 0]; }
  bool holds_state() const { return !bodies.empty() && bodies.front()->location.group == this; }
  std::uint32_t offset_of(std::uint32_t slot) const { return static_cast<std::uint32_t>(3 * lanes) * slot; }
  std::size_t offset_of(std::uint32_t slot, std::size_t lane) const { return offset_of(slot) + lane; }
};

// A group of at most as many bodies as they have lanes, `merged` being their topology. It has no spring parameters and
// no state yet.
LockstepGroup make_lockstep_group(std::vector<Body*> members, MergedTopology merged, bool contacts);

// Copies the bodies' spring parameters; `factors`, by member, are those of the materials.
void set_spring_parameters(LockstepGroup& group, const AnyEnvironmentModel& model,
                           std::span<const std::array<FactorId, max_materials>> factors);

// Takes the bodies' states, and gives them back.
void load(LockstepGroup& group);
void store(LockstepGroup& group);

// Puts padding back where it could leave its robot within the next steps.
void reset_padding(LockstepGroup& group, std::int64_t steps_ahead);

// Copies the members' perturbations; adds their forces.
void set_perturbations(LockstepGroup& group);
void add_perturbations(LockstepGroup& group);

// Searches near pairs in these lanes, one bit per lane. `search` does it for a body, from the positions in body.x.
void search_near_pairs(LockstepGroup& group, std::uint32_t lanes, void (*search)(Body&));
// Adds the forces of all lanes' contacts.
void add_contacts(LockstepGroup& group);

void make_checkpoint(LockstepGroup& group);
void return_to_checkpoint(LockstepGroup& group);

}  // namespace mercury::cpu
