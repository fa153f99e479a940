// SPDX-License-Identifier: Apache-2.0
// By how much mutations move numbers, and values within bounds as numbers without.
//
// Steps that adapt themselves are those of evolution strategies with one step per individual (Schwefel 1981; Beyer and
// Schwefel 2002, section 4.2): a child inherits the step of its parent, a little larger or smaller, and is made with
// it. So steps that make good children survive with them:
//
//   step  <-  step exp(tau N(0, 1))             tau = 1 / sqrt(2 n), n = how many numbers move by it
//
// Numbers with heavy tails move far more often than normal ones, out of the reach of an optimum that is only the
// nearest one (Yao, Liu and Lin 1999, "Evolutionary Programming Made Faster", with Cauchy's distribution).
#pragma once

#include <cstddef>

#include "mercury/random.h"

namespace mercury {

struct StepRange {
  double smallest, largest;
};

// The child's step, within the range.
double adapted_step(double step, std::size_t numbers, StepRange range, Random& random);
// Of two parents: the geometric mean.
double crossed_step(double a, double b, StepRange range);

// A normal random number, or one of Student's t with `tail` degrees of freedom: 1 = Cauchy's, many = almost normal,
// 0 = normal. At most a million of either sign.
double step_number(Random& random, int tail);

// The value mirrored at the ends of the range until it is within: no value is preferred. low < high, the value is
// finite.
double reflected(double value, double low, double high);

// The value within [low, high] of any finite number: the number itself, but for a twentieth of the range at both ends,
// where a parabola meets the bound with slope 0; beyond, mirror images repeat. It is smooth, and no value is preferred
// over a whole period (Hansen, "Boundary transformation" of c-cmaes). low < high.
double bounded(double number, double low, double high);

// The number nearest to the range that has this value: bounded()'s inverse. Values outside count as the bound.
double unbounded(double value, double low, double high);

}  // namespace mercury
