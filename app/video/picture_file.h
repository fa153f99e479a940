// SPDX-License-Identifier: Apache-2.0
// Pictures as PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "render/readback.h"

namespace mercury {

// Writes an rgb or rgba image as a PNG, whole or not at all: under a temporary name that is then renamed, which
// replaces an existing file. Writes directly into a device or a pipe. Throws VideoError, as in "a.png: the disk is
// full". `comment`: see render::png_bytes().
void write_picture(const std::filesystem::path& file, const render::Image& image, std::string_view comment = {},
                   double dpi = 0);
// The same for a file of any bytes.
void write_picture_bytes(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace mercury
