// SPDX-License-Identifier: Apache-2.0
#include "render/particles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mercury::render {
namespace {

constexpr float reach = 2.5f;      // of the water that a mover carries, in its radii
constexpr float lag = 0.35f;       // particles are that far ahead of where they would be [s]
constexpr float farthest = 0.55f;  // but at most so far, in radii
constexpr std::size_t most_movers = 48;
constexpr std::uint32_t bubble_every = 11;

float hash(std::uint32_t n) {
  n = (n ^ 61u) ^ (n >> 16);
  n *= 9u;
  n ^= n >> 4;
  n *= 0x27d4eb2du;
  return float((n ^ (n >> 15)) & 0xffffffu) / 16777216.0f;
}

// The movers whose water reaches the cube; of many, those that move most of it.
std::vector<Mover> movers_near(std::span<const Mover> all, const Vector3& middle, float half_side) {
  std::vector<Mover> near;
  for (const Mover& mover : all) {
    const Vector3 off = (mover.center - middle).absolute();
    if (mover.radius > 0 && std::max({off.x, off.y, off.z}) < half_side + reach * mover.radius) near.push_back(mover);
  }
  if (near.size() <= most_movers) return near;
  std::ranges::stable_sort(near, {}, [](const Mover& m) { return -m.velocity.norm() * m.radius; });
  near.resize(most_movers);
  return near;
}

// Where particles are is the flow of a moment ago, summed up; fast movers push them less far.
std::vector<Mover> pushing(std::vector<Mover> movers) {
  for (Mover& mover : movers) {
    const float speed = mover.velocity.norm();
    if (speed > 0) mover.velocity *= std::min(lag, farthest * mover.radius / speed);
  }
  return movers;
}

float wrapped(float x, float half_side) { return x - 2 * half_side * std::floor((x + half_side) / (2 * half_side)); }

}  // namespace

Vector3 carried_flow(std::span<const Mover> movers, const Vector3& point) {
  Vector3 sum(0, 0, 0);
  for (const Mover& mover : movers) {
    const Vector3 off = point - mover.center;
    const float range = reach * mover.radius, s = off.dot(off) / (range * range);
    if (!(s < 1)) continue;
    const float left = 1 - s;
    // r f' / 2 = -3 s (1 - s)^2; n (n . v) = off (off . v) / r^2, and s / r^2 = 1 / R^2.
    const Vector3 along = off.dot(mover.velocity) / (range * range) * off;
    sum += left * left * (left * mover.velocity - 3 * (s * mover.velocity - along));
  }
  return sum;
}

std::vector<Particle> particles_in(const Scene& scene, const Vector3& middle, float half_side, int count) {
  const auto drift = [&](double speed) { return float(std::remainder(speed * scene.time, 2.0 * half_side)); };
  const Vector3 drifted(drift(scene.flow.x), drift(scene.flow.y), drift(scene.flow.z));
  const float rise = drift(0.035 * half_side);
  const float time = float(std::fmod(scene.time, 3600.0));
  const std::vector<Mover> movers = movers_near(scene.movers, middle, half_side);
  const std::vector<Mover> pushes = pushing(movers);
  std::vector<Particle> particles;
  particles.reserve(std::size_t(count));
  for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
    const Vector3 home = 2 * half_side * Vector3(hash(3 * i), hash(3 * i + 1), hash(3 * i + 2));
    const float t = time * (0.15f + 0.2f * hash(7 * i + 11));
    Vector3 at =
        home + drifted +
        0.03f * half_side *
            Vector3(std::sin(t + home.x * 3), std::sin(1.3f * t + home.y * 2), std::cos(0.9f * t + home.z * 3));
    const bool bubble = i % bubble_every == 4;
    // Whole multiples of one rise, which all come back at the same time.
    if (bubble) at.z += rise * float(1 + i / bubble_every % 2);
    const Vector3 off = at - middle;
    at = middle + Vector3(wrapped(off.x, half_side), wrapped(off.y, half_side), wrapped(off.z, half_side));
    const Vector3 flow = scene.flow + carried_flow(movers, at);
    at += carried_flow(pushes, at);
    const float radius = half_side * 0.0009f * (0.5f + hash(5 * i + 3)) * (bubble ? 2.4f : 1.0f);
    particles.push_back({at, radius, flow, bubble ? 1.0f : 0.0f});
  }
  return particles;
}

}  // namespace mercury::render
