// SPDX-License-Identifier: Apache-2.0
// One frame of several that stand side by side.
#pragma once

#include <span>
#include <vector>

#include "app/video/frame_writer.h"
#include "render/readback.h"

namespace mercury {

// The sizes of the columns of a frame, from left to right. All have even widths, as yuv420 needs, if the frame has.
// Throws ParameterError("size", ...) for a frame that is too narrow.
std::vector<PictureSize> columns_of(PictureSize whole, int columns = 2);

// Puts frames of one height and format beside each other. `into` keeps its memory if that is large enough.
void join(std::span<const render::Image> parts, render::Image& into);

}  // namespace mercury
