// SPDX-License-Identifier: Apache-2.0
// What a line of sight meets, and what can be told of it.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>
#include <string>

#include "app/live/snapshot.h"
#include "render/camera.h"
#include "render/scene.h"

namespace mercury {

struct Hit {
  RobotId robot = 0;
  std::size_t index = 0;                // of the robot, at that snapshot
  std::uint16_t mass = 0;               // of the face's or spring's, the one nearest to the place
  std::optional<std::uint32_t> face;    // index in Robot::faces, where the skin was met
  std::optional<std::uint32_t> spring;  // index in Robot::springs: the one met, or the face's nearest edge that is one
  Eigen::Vector3f point{0, 0, 0};       // in the picture [m]
  float distance = 0;                   // from the ray's origin [m]
};

struct PickOptions {
  bool skin = true, springs = false, masses = false;  // what is to be met, as what is shown
  float radius = 0;                     // how near the ray must pass a spring or mass [m]; 0 = chosen from the lengths
  std::optional<render::CutPlane> cut;  // what it cuts away is not met
  std::span<const bool> hidden;         // robots left out; empty = none
};

// The nearest thing a ray meets. `offsets`: one a robot, added to its coordinates in the picture. Robots without faces
// are met at their springs, those without springs at their masses.
std::optional<Hit> pick(const Snapshot& snapshot, std::span<const Eigen::Vector3f> offsets, const render::Ray& ray,
                        const PickOptions& options = {});

struct HitDetails {
  struct OfMass {
    Vec3 position;               // [m]
    std::optional<float> speed;  // [m/s]; nothing where the snapshot has no velocities
    std::size_t springs = 0;     // that end at it
  };
  struct OfSpring {
    MaterialId material = 0;
    std::string material_name;
    float rest_length = 0, length = 0;  // [m]
    float strain = 0;                   // (|d| - L0) / L0 [1]
    float force = 0;                    // it pulls its ends together with [N]
  };
  std::string robot;  // name
  OfMass mass;
  std::optional<OfSpring> spring;
};
// The figures of a hit at another snapshot of the same robots, or of robots that still have it; nothing but the name
// otherwise.
HitDetails describe(const Snapshot& snapshot, const Hit& hit);
// Those of one spring of the robot at that place of the snapshot; of one that has exploded, as it did.
HitDetails::OfSpring spring_details(const Snapshot& snapshot, std::size_t robot, std::uint32_t spring);

}  // namespace mercury
