// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace mercury {

// The test of Mann and Whitney (1947) of whether two samples come from one distribution: the probability of ranks at
// least this uneven, to both sides, if they do. Exact for up to 20 values each without ties, else by the normal
// distribution with corrections for ties and continuity. 1 if a sample is empty.
double rank_test(std::span<const double> a, std::span<const double> b);

}  // namespace mercury
