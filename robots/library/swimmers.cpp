// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "robots/library/body.h"
#include "robots/library/designs.h"

namespace mercury::library {
namespace {

// A wave of muscle that runs down a body.
struct Wave {
  float stiffness = 6000;  // [N/m]
  float amplitude = 0.3f;  // at its strongest
  float frequency = 5;     // [rad/s]
  float waves = 1;         // wavelengths along the body
  int segments = 10;       // muscles along the wave; at most 10, since antagonists count too
};

// The muscle at `way` (0 to 1) of the wave. `strength` scales the amplitude; a negative one makes the antagonist.
MaterialId muscle_of(Body& body, const Wave& wave, float way, float strength) {
  const int segment = std::clamp(static_cast<int>(way * static_cast<float>(wave.segments)), 0, wave.segments - 1);
  const float middle = (static_cast<float>(segment) + 0.5f) / static_cast<float>(wave.segments);
  return body.muscle({wave.stiffness, wave.amplitude * strength, wave.frequency, -turn * wave.waves * middle});
}

float sign(float x) { return x < 0 ? -1.f : 1.f; }

Robot eel_of(const Wave& wave) {
  Body body("eel", "ocean", 28, 2, 3);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const bool tip = x == 0 || x == body.nx() - 1;
    if (tip && z != 1) return air;
    return muscle_of(body, wave, 1 - along(x, body.nx()), sign(from_middle(y, 2)));
  });
  return body.robot();
}

Robot fish_of(const Wave& wave) {
  Body body("fish", "ocean", 24, 2, 7);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const float height = std::abs(from_middle(z, body.nz()));
    const bool is_tail_fin = x < 3;
    // A deep body that narrows to the tail's stem, and a forked fin.
    const float half_height = is_tail_fin
                                  ? 3.2f - 0.9f * static_cast<float>(x)
                                  : 2.4f * std::sin(turn / 2 * std::pow(along(x - 3, body.nx() - 2), 0.7f)) + 0.9f;
    if (height > half_height || (x == 0 && height < 1.5f)) return air;
    return muscle_of(body, wave, 1 - along(x, body.nx()), sign(from_middle(y, 2)));
  });
  return body.robot();
}

// Fin rays of bone lie across the wings, so that muscles between them bend the sheet along the wave alone.
Robot ray_of(const Wave& wave) {
  Body body("ray", "ocean", 20, 17, 2);
  body.set_bone_stiffness(wave.stiffness);
  body.set_tissue_stiffness(wave.stiffness / 4);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const float out = std::abs(from_middle(y, body.ny())) / 8;
    const float ahead = from_middle(x, body.nx()) / 9.5f;
    const bool is_tail = out < 0.1f;
    const float half_length = 0.75f * std::sqrt(std::max(0.f, 1.02f - out * out));
    if (std::abs(ahead - 0.25f) > half_length && !(is_tail && ahead < 0)) return air;
    if (is_tail && ahead < -0.5f) return tissue;
    if (x % 2 == 0) return bone;
    return muscle_of(body, wave, 1 - along(x, body.nx()), sign(from_middle(z, 2)));
  });
  return body.robot();
}

Robot manta_of(const Wave& wave) {
  Body body("manta", "ocean", 17, 23, 2);
  body.set_bone_stiffness(2 * wave.stiffness);
  body.set_tissue_stiffness(wave.stiffness / 4);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const float out = std::abs(from_middle(y, body.ny())) / 11;
    const float behind_head = 1 - along(x, body.nx());
    // Wings swept back: the leading edge falls off faster than the trailing edge.
    const float leading = 0.12f + 0.4f * out * out, trailing = 0.7f - 0.05f * out;
    const bool is_tail = out < 0.05f;
    const bool is_horn = std::abs(out - 2.f / 11) < 0.05f && behind_head < 0.2f;
    if (!is_tail && !is_horn && (behind_head < leading || behind_head > trailing)) return air;
    if (is_tail && behind_head < 0.1f) return air;
    if (is_tail && behind_head > 0.7f) return tissue;
    if (is_horn || x % 2 == 0) return bone;
    // The body waves less than its wings.
    return muscle_of(body, wave, behind_head / 0.8f, sign(from_middle(z, 2)) * (out < 0.25f ? 0.8f : 1.f));
  });
  return body.robot();
}

// A bell whose rim contracts, and a soft skirt that follows late.
Robot jellyfish_of(const Wave& wave) {
  Body body("jellyfish", "ocean", 13, 13, 12);
  body.set_bone_stiffness(wave.stiffness);
  body.set_tissue_stiffness(wave.stiffness / 6);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const float dx = from_middle(x, body.nx()), dy = from_middle(y, body.ny());
    const float height = static_cast<float>(z) - 5.5f;  // above the rim
    const float radius = std::hypot(dx, dy);
    if (radius < 1.2f && height > -4 && height < 5) return tissue;  // the stalk
    if (height < 0) {
      const bool in_skirt = radius > 5.2f && radius < 6.4f;
      const bool is_tentacle = std::abs(radius * std::sin(std::remainder(std::atan2(dy, dx), turn / 8))) < 0.8f;
      return in_skirt && (height > -3 || is_tentacle) ? tissue : air;
    }
    const float distance = std::hypot(radius, height * 1.1f);
    if (distance > 6.4f || distance < 4.6f) return air;
    const float from_apex = std::atan2(radius, height * 1.1f) / (turn / 4);
    return from_apex < 0.45f ? bone : muscle_of(body, wave, (from_apex - 0.45f) / 0.55f, 1);
  });
  return body.robot();
}

// The mantle glides, three pairs of arms behind it wave.
Robot squid_of(const Wave& wave) {
  Body body("squid", "ocean", 28, 8, 4);
  body.set_bone_stiffness(2 * wave.stiffness);
  body.set_tissue_stiffness(wave.stiffness / 2);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const float side = std::abs(from_middle(y, body.ny())), height = std::abs(from_middle(z, body.nz()));
    const int behind_tip = body.nx() - 1 - x;
    if (behind_tip < 12) {
      const float mantle = std::min(2.2f, 0.8f + 0.5f * static_cast<float>(behind_tip));
      const float fin = behind_tip < 6 ? 1 + static_cast<float>(behind_tip) / 2 : 0;
      if (std::hypot(side, height) < mantle)  // breathes
        return body.muscle({wave.stiffness, 0.08f, wave.frequency, 0});
      return height < 1 && side < fin ? tissue : air;
    }
    if (behind_tip < 14) return height < 1 ? bone : air;
    const bool is_arm = side < 1 || side > 2;
    const int longest = side < 1 ? 24 : 28;
    if (height > 1 || !is_arm || behind_tip >= longest) return air;
    return muscle_of(body, wave, static_cast<float>(behind_tip - 14) / 14, sign(from_middle(z, body.nz())));
  });
  return body.robot();
}

// The fore flippers flap and pull the turtle in the direction that they point in.
Robot turtle_of(const Wave& wave) {
  Body body("turtle", "ocean", 20, 19, 4);
  body.set_bone_stiffness(2 * wave.stiffness);
  body.set_tissue_stiffness(wave.stiffness / 4);
  body.fill([&](int x, int y, int z) -> MaterialId {
    const float side = std::abs(from_middle(y, body.ny())), ahead = static_cast<float>(x) - 11;
    const float height = from_middle(z, body.nz());
    const bool in_fin_layers = std::abs(height) < 1;
    const float shell = std::hypot(ahead / 5.6f, side / 4.3f);
    if (shell < 1) return std::abs(height) < 1 || (height > 0 && shell < 0.75f) ? (height > 0 ? bone : tissue) : air;
    if (!in_fin_layers) return air;
    if (side < 1.2f && ahead > 0) return tissue;  // the head
    // Along and across the fore flipper, which leaves the shoulder at 45 degrees, ahead.
    const float fore_along = ((side - 2.6f) + (ahead - 0.5f)) * 0.7071f;
    const float fore_across = ((side - 2.6f) - (ahead - 0.5f)) * 0.7071f;
    if (fore_along > 0 && fore_along < 9 && std::abs(fore_across) < 1.6f)
      return muscle_of(body, wave, fore_along / 9, sign(height));
    return side > 1.2f && side < 3.2f && ahead < 0 && ahead > -8.5f ? tissue : air;  // hind flippers
  });
  return body.robot();
}

}  // namespace

// Tuned by simulation to get far in 20 s.
Robot eel() { return eel_of({.waves = 1.4f}); }
Robot fish() { return fish_of({.stiffness = 12000, .frequency = 7, .waves = 0.7f}); }
Robot ray() { return ray_of({.stiffness = 12000, .amplitude = 0.4f, .frequency = 6, .waves = 1.2f}); }
Robot manta() { return manta_of({.stiffness = 12000, .amplitude = 0.4f, .frequency = 11, .waves = 1, .segments = 5}); }
Robot jellyfish() { return jellyfish_of({.stiffness = 15000, .frequency = 10, .waves = 1.8f, .segments = 5}); }
Robot squid() { return squid_of({.stiffness = 12000, .frequency = 6, .waves = 1, .segments = 9}); }
Robot turtle() { return turtle_of({.stiffness = 12000, .frequency = 10, .waves = 0.5f}); }

}  // namespace mercury::library
