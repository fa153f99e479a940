// SPDX-License-Identifier: Apache-2.0
// Face tiles: 32 face pairs that a warp computes together, one per lane.
//
// A face pair is two triangles (a, b, c) and (a, c, d) with a common edge. A warp reads the four masses of its 32 pairs
// column by column, first all a, then all b, and so on:
//
//        d ------ c              lane 0    lane 1    ...   lane 31
//        |      / |    column a |   7    |   40    |     |   66    |   banks  7  8 ...  2
//        |    /   |    column b |   8    |   41    |     |   98    |   banks  8  9 ...  2
//        |  /     |    column c |  39    |    8    |     |  101    |   banks  7  8 ...  5
//        a ------ b    column d |  38    |    7    |     |   69    |   banks  6  7 ...  5
//
// 1. A column is one access to shared memory. If two of its masses share a bank, the access takes a second pass, and
//    so on for each further mass in that bank. Pairs are therefore dealt out to face tiles so that few columns use a
//    bank twice. Masses of a bank that do meet wait for each other, which costs less than one more face tile would.
// 2. The two triangles can be listed in four vertex orders, which put other masses into the columns. A face's force
//    does not depend on the order, so each pair takes the one that fits best.
// 3. There are as few face tiles as there can be. Padding (padding_faces) fills the last one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/cuda/tile.h"
#include "sim/physics/face_pairs.h"

namespace mercury::cuda {

// Padding of a face tile.
inline constexpr FacePair padding_faces{0, 0, 0, 0};

// The least number of passes that the busiest bank forces on a column, however the pairs are dealt out.
std::uint32_t busiest_bank(std::span<const FacePair> pairs);

// The pairs in face tiles: a multiple of 32 pairs, in another order and with other vertex orders than given. The
// corners of `pairs` are slots.
std::vector<FacePair> make_face_tiles(std::span<const FacePair> pairs);

}  // namespace mercury::cuda
