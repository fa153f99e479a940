// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mercury/run_folder.h"

namespace mercury {

// lineage.csv: every individual, in the ALife data standard for phylogenies
// (https://alife-data-standards.github.io/alife-data-standards/phylogeny): id, ancestor_list ("[3,7]", "[none]"),
// origin_time and destruction_time in generations ("inf" for the living). Then generation, line_began, seed, fate, one
// score per objective, hash, and one column per quantity ("robot_length" for the quantity length, since tools take a
// column of that name for the length of a branch).
void write_lineage(const RunHistory& run);

// generations.csv: one line per generation. All columns but the last three are the same in every repetition.
void write_generations(const RunHistory& run);

}  // namespace mercury
