// SPDX-License-Identifier: Apache-2.0
// Finer skins for pictures from near: every triangle becomes four, again and again, and the points of the finer skin
// are means of masses (C. Loop, Smooth subdivision surfaces based on triangles, 1987). Loop's rules make a skin
// smaller, so masses are first moved the other way by a part of that.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/body_data.h"

namespace mercury::render {

// The weighted mean that a point of a finer skin is: entries from ends[i - 1] to ends[i] belong to point i.
struct Means {
  std::vector<std::uint32_t> ends, masses;
  std::vector<float> weights;  // those of a point add up to 1; some are negative
};

struct FineSkin {
  BodyData bodies;  // its points in place of masses; without springs. Face i stands for face i / 4^times of the skin
  Means means;      // of the masses of the skin that it was made from
};
// The points count as one body's, the faces as those of their bodies.
FineSkin subdivided(const BodyData& bodies, int times);

}  // namespace mercury::render
