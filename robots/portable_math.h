// SPDX-License-Identifier: Apache-2.0
// Functions that decide what a robot looks like, from the four operations alone. These are rounded alike on every
// machine; std::sin and std::exp are not. (portable_log is in mercury/random.h.)
#pragma once

namespace mercury {

// Sine and cosine of an angle in turns. The error is at most 1e-15 for angles below 1e6 turns.
struct SineCosine {
  double sine, cosine;
};
SineCosine wave(double turns);

// The angle of a point, from 0 to below 1 turn; 0 at the origin. The error is at most 1e-15.
double turns_of(const SineCosine& point);

// e^x for x up to 700; 0 for x below -700, where it is under 1e-304. The error is at most 4 units in the last place.
double portable_exp(double x);

}  // namespace mercury
