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
// 1. A column is read by six accesses to shared memory (x and v) and updated by three additions (sum). If two of its
//    masses share a bank, each of these takes a second pass, and so on for each further mass in that bank.
// 2. Lanes that read the same mass get it in one pass. Only additions take a pass for each corner in a bank, whether
//    the corners are of different masses or of one.
// 3. The two triangles can be listed in four vertex orders, which put other masses into the columns. A face's force
//    does not depend on the order, so each pair takes one that fits, if possible one that repeats masses of the
//    columns.
// 4. There are as few face tiles as there can be, because a pass costs less than one more face tile would. Padding
//    (padding_faces) fills the last one.
// 5. At first the banks of a column have room for one mass each, which may be a corner of two pairs. Each pair goes to
//    the first face tile where its four corners have room. For each column and bank there is a word with a bit per face
//    tile that says where another mass has room, and for each column and mass one that says where the mass is already.
//    So a few operations on words find the face tile.
// 6. For the pairs that are left, the banks of a column get room for another mass, one column after the other: each
//    time the column that lets most pairs in. So the second passes of a column serve many pairs.
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
