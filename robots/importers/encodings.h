// SPDX-License-Identifier: Apache-2.0
// How VXA files store the voxels of a layer.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace mercury {

// The bytes of a base64 text. White space is passed over. Throws InputError for other characters, and for a text that
// breaks off. No more memory than the text has.
std::string base64_decoded(std::string_view text);
std::string base64_encoded(std::string_view bytes);

// The content of a zlib stream, which must have exactly `size` bytes. Throws InputError for one that is damaged, breaks
// off, or holds more or fewer bytes. Memory grows with what comes out, up to `size`.
std::string inflated(std::string_view stream, std::size_t size);

}  // namespace mercury
