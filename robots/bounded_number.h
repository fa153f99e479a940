// SPDX-License-Identifier: Apache-2.0
// Values within bounds as numbers without, for searches among numbers.
#pragma once

namespace mercury {

// The value within [low, high] of any finite number: the number itself, but for a twentieth of the range at both ends,
// where a parabola meets the bound with slope 0; beyond, mirror images repeat. It is smooth, and no value is preferred
// over a whole period (Hansen, "Boundary transformation" of c-cmaes). low < high.
double bounded(double number, double low, double high);

// The number nearest to the range that has this value: bounded()'s inverse. Values outside count as the bound.
double unbounded(double value, double low, double high);

}  // namespace mercury
