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
//    so on for each further mass in that bank. A column takes as many passes as its busiest bank has masses.
// 2. The two triangles can be listed in four vertex orders, which put other masses into the columns. A face's force
//    does not depend on the order, so each pair takes one that fits.
// 3. There are as few face tiles as there can be, because a pass costs less than one more face tile would. Padding
//    (padding_faces) fills the last one.
// 4. At first a column may use each bank once. Each pair goes to the first face tile that has its four banks free. For
//    each column and bank there is a word with a bit per face tile, so that four ANDs find it. If there is none, a pair
//    that is in the way may move to another face tile.
// 5. For the pairs that are left, columns may use banks once more, one column after the other: each time the column
//    that lets most pairs in. So the second passes of a column serve many pairs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/cuda/tile.h"
#include "sim/physics/face_pairs.h"

namespace mercury::cuda {

// Padding of a face tile.
inline constexpr FacePair padding_faces{0, 0, 0, 0};

// How often the corners of pairs lie in each bank. A vertex order can exchange a and c, or b and d, so each of these
// two sets has two columns to spread over.
struct CornerBanks {
  std::array<std::uint32_t, lanes> shared{};  // a and c
  std::array<std::uint32_t, lanes> outer{};   // b and d

  void add(const FacePair& pair);
  // The columns of all face tiles together take at least this many passes, however the pairs are dealt out.
  std::uint32_t fewest_passes(std::size_t pairs) const;
};

// The pairs in face tiles: a multiple of 32 pairs, in another order and with other vertex orders than given. The
// corners of `pairs` are slots.
std::vector<FacePair> make_face_tiles(std::span<const FacePair> pairs);

}  // namespace mercury::cuda
