// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "evolution/run_folder/plot.h"
#include "mercury/run_folder.h"

namespace mercury {

// The picture progress.svg: scores over generations, one panel per objective; the living in the plane of two
// objectives; for map-elites the map.
std::string progress_plot(const RunHistory& run);

// Its panels. Each draws into a box; axes and their titles stand outside, 80 px to the left, 50 px below and 130 px to
// the right.
void draw_scores(Svg& svg, const Box& box, const RunHistory& run, std::size_t objective);
void draw_front(Svg& svg, const Box& box, const RunHistory& run);
void draw_map(Svg& svg, const Box& box, const RunHistory& run);

}  // namespace mercury
