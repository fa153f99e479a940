// SPDX-License-Identifier: Apache-2.0
// PNG files.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "render/readback.h"

namespace mercury::render {

// Writes an rgb or rgba image to a temporary name and renames it, so that a file is complete or absent. Throws
// std::runtime_error "<path>: <what the system says>"; std::invalid_argument for another format.
void write_png(const std::string& path, const Image& image);

// The bytes of a PNG file; a comment in Latin-1, if there is one, is its text "Comment". `dpi`: how large it is on
// paper [pixels per inch]; 0 = it does not say. Throws as write_png() does.
std::vector<std::uint8_t> png_bytes(const Image& image, std::string_view comment = {}, double dpi = 0);

// Reads a PNG as rgb, or as rgba if it has transparency. Throws std::runtime_error.
Image read_png(const std::string& path);

}  // namespace mercury::render
