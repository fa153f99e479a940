// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "robots/library/body.h"
#include "robots/library/designs.h"

namespace mercury::library {
namespace {

// A leg's front and back muscles work a quarter turn apart, so the leg stretches and swings, and its foot runs around
// an ellipse: back along the ground while the leg is long.
struct Gait {
  float stiffness = 60;  // [N/m], times 200 on land
  float amplitude = 0.25f;
  float frequency = 6;     // [rad/s]
  float split = turn / 8;  // half the difference of the two muscles' phases [rad]
};

MaterialId leg_muscle(Body& body, const Gait& gait, bool front, float phase) {
  return body.muscle({gait.stiffness, gait.amplitude, gait.frequency, phase + (front ? -gait.split : gait.split)});
}

Robot quadruped_of(const Gait& gait, float trot) {
  Body body("quadruped", "land", 10, 6, 6);
  body.set_tissue_stiffness(1.5f * gait.stiffness);
  body.set_bone_stiffness(2.5f * gait.stiffness);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const bool is_leg = (x < 2 || (x > 5 && x < 8)) && (y < 2 || y > 3);
    // In a trot, legs across from each other step together.
    if (z < 3) return is_leg ? leg_muscle(body, gait, x % 2 == 1, (x < 2) == (y < 2) ? 0 : trot) : air;
    if (x > 7) return z > 3 && y > 1 && y < 4 ? bone : air;   // the head
    if (z == 5) return x > 5 && y > 1 && y < 4 ? bone : air;  // the neck
    return z == 3 || (y > 0 && y < 5) ? tissue : air;
  });
  return body.robot();
}

Robot hopper_of(const Gait& gait, float lag) {
  Body body("hopper", "land", 8, 6, 5);
  body.set_tissue_stiffness(1.5f * gait.stiffness);
  body.set_bone_stiffness(2.5f * gait.stiffness);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const bool is_leg_y = y < 2 || y > 3;
    if (z < 2) {
      const bool hind = x<3, fore = x> 5;
      if (!is_leg_y || !(hind || fore)) return air;
      return leg_muscle(body, gait, hind ? x > 1 : x > 6, hind ? 0 : lag);
    }
    if (z == 4) return x > 5 && is_leg_y && y != 0 && y != 5 ? bone : (x < 6 && x > 0 && !is_leg_y ? tissue : air);
    return tissue;
  });
  return body.robot();
}

}  // namespace

Robot beetle() {
  Body body("beetle", "land", 12, 8, 5);
  const Gait gait{.frequency = 8};
  body.fill([&](int x, int y, int z) -> MaterialId {
    const bool is_leg_y = y < 2 || y > 5;
    const int leg = x / 4;  // 0, 1, 2, each two voxels long with a gap of two
    if (z < 2) {
      if (x % 4 > 1 || !is_leg_y) return air;
      const bool tripod = (leg % 2 == 0) == (y < 2);
      return leg_muscle(body, gait, x % 4 == 1, tripod ? 0 : turn / 2);
    }
    const float height = static_cast<float>(z) - 2;
    const float dome = std::hypot(from_middle(x - 1, 11) / 5.5f, from_middle(y, 8) / 4, height / 3);
    if (x == 0 || x == 11) return z == 2 && y > 2 && y < 5 ? bone : (x == 0 && z == 2 && y > 0 && y < 7 ? tissue : air);
    return z == 2 ? tissue : dome < 1 ? bone : air;
  });
  return body.robot();
}

Robot inchworm() {
  Body body("inchworm", "land", 16, 3, 2);
  body.fill([&](int x, int, int z) -> MaterialId {
    const float behind_head = 1 - along(x, body.nx());
    const int segment = std::min(7, static_cast<int>(behind_head * 8));
    const float phase = turn * 0.9f * (static_cast<float>(segment) + 0.5f) / 8;
    return body.muscle({60, z == 1 ? 0.3f : -0.3f, 4, phase});
  });
  return body.robot();
}

Robot caterpillar() {
  Body body("caterpillar", "land", 24, 4, 4);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const float behind_head = 1 - along(x, body.nx());
    const bool is_foot_y = y == 0 || y == 3;
    if (z == 0 && (!is_foot_y || x % 3 == 2)) return air;
    if (z == 3 && (is_foot_y || x == 0)) return air;
    if (x == body.nx() - 1) return z > 0 ? bone : air;
    const int segment = std::min(9, static_cast<int>(behind_head * 10));
    const float phase = turn * 2 * (static_cast<float>(segment) + 0.5f) / 10;
    return body.muscle({60, z >= 2 ? 0.25f : -0.25f, 5, phase});
  });
  return body.robot();
}

// Five arms, lifted by one wave after the other.
Robot sea_star() {
  Body body("sea-star", "land", 21, 21, 2);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const float dx = from_middle(x, body.nx()), dy = from_middle(y, body.ny());
    const float radius = std::hypot(dx, dy);
    const float angle = std::remainder(std::atan2(dy, dx), turn / 5);
    const bool in_arm = radius < 10.6f && std::abs(radius * std::sin(angle)) < 2.6f - 0.12f * radius;
    if (!in_arm && radius > 3.2f) return air;
    const int segment = std::min(9, static_cast<int>((1 - along(x, body.nx())) * 10));
    return body.muscle({60, z == 1 ? 0.25f : -0.25f, 5, turn * 1.6f * (static_cast<float>(segment) + 0.5f) / 10});
  });
  return body.robot();
}

// Tuned by simulation to get far in 20 s, straight ahead.
Robot quadruped() { return quadruped_of({.stiffness = 120, .frequency = 10}, turn / 2); }
Robot hopper() { return hopper_of({.stiffness = 120, .frequency = 10, .split = turn / 6}, 0); }

}  // namespace mercury::library
