// SPDX-License-Identifier: Apache-2.0
// The map of elites of a run as a table for pictures.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "app/scene/board.h"
#include "mercury/run_folder.h"

namespace mercury {

struct RunBoard {
  std::vector<std::uint64_t> robots;  // one per filled cell, in the order of board->cell_of
  std::shared_ptr<const Board> board;
  std::vector<std::string> notes;
};

// The map by its first two axes; each cell shows its best robot. Throws InputError for a run without a map.
RunBoard board_of(const RunHistory& run);

}  // namespace mercury
