// Robots of one build, one a lane: what a vector loads of a mass or a spring then is that of as many robots, side by side,
// and no lane is empty. Small robots are stepped like this where there are enough that are built alike.
//
// A group is stepped as long as all goes well in it. If a robot of it explodes, the steps since the last checkpoint are
// made again one robot after the other (sim/cpu/stepper.h), where all that an explosion asks for is done; both ways give
// the same bits.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sim/cpu/body.h"
#include "sim/face_pairs.h"

namespace mercury::cpu {

// What robots of one group share: which masses are joined. Springs stand by owner, the mass with the lower index.
struct Build {
  struct Joint {
    std::uint32_t owned = 0;   // springs that the mass owns
    std::uint32_t springs = 0;  // springs at the mass
  };
  std::vector<Joint> joints;            // one a mass
  std::vector<std::uint32_t> springs;   // indices in Robot::springs
  std::vector<std::uint32_t> partners;  // masses, one a spring
  std::vector<FacePair> faces;
};

Build build_of(const Robot& robot);

// Equal for robots of the same build, and seldom for others.
std::uint64_t build_key(const Robot& robot);
bool same_build(const Robot& a, const Robot& b);

struct Lockstep {
  std::shared_ptr<const Build> build;
  std::size_t lanes = 1;
  std::vector<std::size_t> bodies;  // one a lane; lanes that are left do what the first does
  std::vector<Body*> members;       // of every lane, from load() on

  // Of each spring of the build, a lane.
  Aligned<float> rest_length, hardness;
  Aligned<MaterialId> material;

  // [mass][x, y, z][lane]
  Aligned<float> x, v;           // during XPBD's springs: the prediction and v + dt F
  Aligned<std::int32_t> sums;    // what acts on the masses, in units; zero between steps
  Aligned<float> checkpoint_x, checkpoint_v;
  // Where the masses were when their robot's near pairs were listed, and which of its lists that was, by lane.
  Aligned<float> listed_x;
  std::vector<std::uint64_t> lists;  // empty = none

  // Of each lane's robot.
  Aligned<float> force_scale, correction_scale;  // FixedPointScale
  Aligned<float> squared_stretch_limit;
  Aligned<float> contact_distance;
  bool compact = false;  // no two masses of a robot are farther apart than its springs may be long
};

// Bytes that a step of a group touches.
std::size_t footprint_in_lockstep(const Robot& robot, std::size_t lanes);

// A group of 1 to `lanes` bodies of this build, made for the present laws of the bodies.
Lockstep make_lockstep(std::shared_ptr<const Build> build, std::span<const Body> bodies, std::vector<std::size_t> members,
                       const Configuration& configuration);

// Takes the bodies' states; gives them back.
void load(Lockstep& group, std::span<Body> bodies);
void store(const Lockstep& group, std::span<Body> bodies);

// Lists the near pairs of these lanes' robots, one bit a lane, where they are now; adds the forces of all lanes' contacts.
void list_near_pairs(Lockstep& group, std::uint32_t lanes);
void add_contacts(Lockstep& group, float stiffness);

void make_checkpoint(Lockstep& group);
void return_to_checkpoint(Lockstep& group);

}  // namespace mercury::cpu
