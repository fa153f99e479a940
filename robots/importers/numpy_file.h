// SPDX-License-Identifier: Apache-2.0
// Arrays of numbers in a file of numpy.savez: a ZIP archive of .npy files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace mercury {

struct NumpyArray {
  std::string name;  // "arr_0"
  std::vector<std::size_t> shape;
  std::vector<double> values;  // row by row, as C has them
};

// In the order of the archive. Throws InputError for a file that is no such archive, is damaged, or holds what is no
// number. Memory follows the file: an array is unpacked up to 64 MB.
std::vector<NumpyArray> numpy_arrays(std::string_view file);

}  // namespace mercury
