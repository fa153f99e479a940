// SPDX-License-Identifier: Apache-2.0
// Particles and bubbles that drift with the water and follow what moves through it.
#pragma once

#include <span>
#include <vector>

#include "render/scene.h"

namespace mercury::render {

// The velocity of the water that these carry along [m/s]: that of each in its middle, and with the opposite sign beside
// it, where water flows back. Of the vector potential A = f (v x r) / 2 with f = (1 - r^2 / R^2)^3 for r < R, R 2.5
// radii: u = curl A = f v + r f' / 2 (v - n (n . v)), r = r n. So it has no sources, and is zero from R on.
Vector3 carried_flow(std::span<const Mover> movers, const Vector3& point);

// Of the layout of shaders/particle.vert.
struct Particle {
  Vector3 center;    // [m]
  float radius = 0;  // [m]
  Vector3 flow;      // [m/s]
  float bubble = 0;  // 1 = a bubble, which rises; 0 = a particle
};

// `count` particles in the cube of this middle and half side at that time [s]; the cube is filled again and again, so
// they are everywhere and stay where they are while it moves.
std::vector<Particle> particles_in(const Scene& scene, const Vector3& middle, float half_side, int count);

}  // namespace mercury::render
