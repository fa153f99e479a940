// SPDX-License-Identifier: Apache-2.0
// Whether the frames of a video fit into memory, before they are drawn.
#pragma once

#include <cstddef>

#include "app/video/frame_writer.h"

namespace mercury {

// About what drawing and encoding pictures of a size take of the host's memory [bytes]. `software`: the processor
// draws, so the renderer's textures lie in the same memory. Measured (docs/experiments.md).
std::size_t picture_memory(PictureSize size, bool software);

// Throws ParameterError("size", memory_line()) if pictures of this size would not fit into `usable` bytes. Small
// pictures are always accepted.
void require_memory_for_pictures(PictureSize size, bool software, std::size_t usable);

}  // namespace mercury
