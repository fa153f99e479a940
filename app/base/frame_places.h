// SPDX-License-Identifier: Apache-2.0
// Where the frames of a recording or a film are: every few steps, or a number of times per second, between steps where
// they do not fit.
//
//     step    0     1     2     3     4     5     6     7          3.33 steps per frame
//     frame   0                 .  1           .     2
//                               3 + 0.33             6 + 0.67      from the steps on both sides
#pragma once

#include <cstdint>
#include <span>

#include "mercury/vec3.h"

namespace mercury {

// A moment at a step, or that share of the way to the next one.
struct FramePlace {
  std::int64_t step = 0;
  float share = 0;  // 0 = at the step, below 1
  bool is_between_steps() const { return share > 0; }
};

// The moment that many steps, also parts of one, after step `first`.
FramePlace place_after(std::int64_t first, double steps);

class FramePlaces {
 public:
  // From step `first` on, every `every` steps.
  FramePlaces(std::int64_t first, std::int64_t every);
  // From step `first` on, at `rate` frames per second, at most one per step of `dt` [s].
  FramePlaces(std::int64_t first, double rate, double dt);

  // Of a frame, counted from 0. Steps grow from frame to frame.
  FramePlace of(std::int64_t frame) const;
  // Frames in this number of steps from the first one.
  std::int64_t count(std::int64_t steps) const;
  // Steps per frame, rounded, at least 1.
  std::int64_t every() const;

 private:
  std::int64_t first_;
  double steps_per_frame_;
};

// Throws InputError("--fps: ...") unless a simulation with steps of `dt` [s] has that many frames per second.
void require_frame_rate(const char* option, double rate, double dt);

// A value at that share of the way from one step to the next.
inline Vec3 interpolated(Vec3 earlier, Vec3 later, float share) { return earlier + share * (later - earlier); }
// What a frame between two steps has: `values` of the earlier step become those at `share` of the way to `next`.
void interpolate(std::span<Vec3> values, std::span<const Vec3> next, float share);

}  // namespace mercury
