// SPDX-License-Identifier: Apache-2.0
// PNG files.
#pragma once

#include <string>

#include "render/readback.h"

namespace mercury::render {

// Writes an rgb or rgba image, to a temporary name first and then renamed: the file is whole or not there.
// Throws std::runtime_error "<path>: <what the system says>"; std::invalid_argument for another format.
void write_png(const std::string& path, const Image& image);

// Reads a PNG as rgb or, where it has transparency, rgba. Throws std::runtime_error.
Image read_png(const std::string& path);

}  // namespace mercury::render
