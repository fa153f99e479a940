// SPDX-License-Identifier: Apache-2.0
// Names of robots as names of files.
#pragma once

#include <string>
#include <string_view>

namespace mercury {

// A file name without folder and extension that holds this name: what file systems or shells would misread becomes "_".
// Never empty, at most 120 bytes.
std::string file_name_of(std::string_view name);

}  // namespace mercury
