// SPDX-License-Identifier: Apache-2.0
// Finds things in the view: the nearest face, spring or mass that a ray meets, such as the mouse's, and the springs
// that made robots explode.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live/snapshot.h"
#include "render/camera.h"
#include "render/scene.h"
#include "render/vector.h"

namespace mercury {

struct Hit {
  RobotId robot = 0;
  std::size_t index = 0;                // of the robot in the snapshot
  std::uint16_t mass = 0;               // the mass of the face or spring that is nearest to `point`
  std::optional<std::uint32_t> face;    // index in Robot::faces, if the ray met the skin
  std::optional<std::uint32_t> spring;  // index in Robot::springs: the one met, or the nearest edge of the face
  render::Vector3 point{0, 0, 0};       // in the view [m]
  float distance = 0;                   // from the ray's origin [m]
};

struct PickOptions {
  bool skin = true, springs = false, masses = false;  // what the ray can meet: what is shown
  float radius = 0;                      // how near the ray must pass a spring or mass [m]; 0 = from the lengths
  std::optional<render::Cut> cut;        // the ray ignores what it cuts away
  std::span<const bool> hidden;          // robots left out; empty = none
  std::span<const render::Bounds> near;  // about where each robot is, so that others need not be read; empty = unknown
};

// Returns the nearest hit. `offsets`: per robot, added to its coordinates in the view [m]. A robot without faces is
// hit at its springs, a robot without springs at its masses.
std::optional<Hit> pick(const Snapshot& snapshot, std::span<const render::Vector3> offsets, const render::Ray& ray,
                        const PickOptions& options = {});

// The numbers that the window shows beside the mouse.
struct HitDetails {
  struct OfMass {
    Vec3 position;               // [m]
    std::optional<float> speed;  // [m/s]; nothing if the snapshot has no velocities
    std::size_t springs = 0;     // springs at the mass
  };
  struct OfSpring {
    MaterialId material = 0;
    std::string material_name;
    float rest_length = 0, length = 0;  // [m]
    float strain = 0;                   // (|d| - L0) / L0 [1]
    float activation = 0;               // how far its muscle is contracted, (L0 - L) / L0 [1]
    float force = 0;                    // [N], > 0 pulls the ends together
  };
  std::string robot;  // name
  OfMass mass;
  std::optional<OfSpring> spring;
};
// Describes a hit in a later snapshot. If the robot is gone the result is empty; if it has changed, only its name is
// set.
HitDetails describe(const Snapshot& snapshot, const Hit& hit);
// Describes a spring of the robot with index `robot` in the snapshot. If the robot has exploded: at the time of the
// explosion.
HitDetails::OfSpring spring_details(const Snapshot& snapshot, std::size_t robot, std::uint32_t spring);

// The first spring that became invalid in a robot.
struct CulpritSpring {
  std::uint32_t index = 0;       // in Robot::springs
  std::uint16_t a = 0, b = 0;    // its masses
  HitDetails::OfSpring figures;  // at the explosion
};

struct ExplodedRobot {
  RobotId robot = 0;
  std::size_t index = 0;  // in the snapshot
  std::string name;
  double time = 0;                      // of the explosion [s]
  std::optional<CulpritSpring> spring;  // nothing if the cause is no spring
  // As it was built, at the place where it was last: what a spring that is torn across the world belongs to.
  std::shared_ptr<const Robot> body;
  render::Vector3 offset;  // added to the coordinates of the body's masses in the view [m]
  render::Bounds box;      // of the body in the view
};

// The exploded robots of a snapshot in the order of their explosions. `boxes`: per robot, where it was last in the
// view, with the size that it has at rest.
std::vector<ExplodedRobot> exploded_robots(const Snapshot& snapshot, std::span<const render::Bounds> boxes);

}  // namespace mercury
