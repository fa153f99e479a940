// SPDX-License-Identifier: Apache-2.0
// How files store voxels: the layers of VXA files, and arrays of numpy.savez, a ZIP archive of .npy files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mercury {

// The bytes of a base64 text. White space is passed over. Throws InputError for other characters, and for a text that
// breaks off. No more memory than the text has.
std::string base64_decoded(std::string_view text);
std::string base64_encoded(std::string_view bytes);

// The content of a zlib stream, which must have exactly `size` bytes. Throws InputError for one that is damaged, breaks
// off, or holds more or fewer bytes. Memory grows with what comes out, up to `size`.
std::string inflated(std::string_view stream, std::size_t size);

struct NumpyArray {
  std::string name;  // "arr_0"
  std::vector<std::size_t> shape;
  std::vector<double> values;  // row by row, as C has them
};

// In the order of the archive. Throws InputError for a file that is no such archive, is damaged, or holds what is no
// number. Memory follows the file: an array is unpacked up to 64 MB.
std::vector<NumpyArray> numpy_arrays(std::string_view file);

}  // namespace mercury
