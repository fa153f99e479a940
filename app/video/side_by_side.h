// SPDX-License-Identifier: Apache-2.0
// One picture of several that stand side by side.
#pragma once

#include <span>
#include <vector>

#include "app/video/frame_writer.h"
#include "render/readback.h"

namespace mercury {

// The sizes of two halves of a picture, from left to right. Both have even widths, as yuv420 needs, if the picture has.
// Throws ParameterError("size", ...) for a picture that is too narrow.
std::vector<PictureSize> halves_of(PictureSize whole);

// Puts pictures of one height and format beside each other. `into` keeps its memory if that is large enough.
void join(std::span<const render::Image> parts, render::Image& into);

}  // namespace mercury
