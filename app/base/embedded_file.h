// SPDX-License-Identifier: Apache-2.0
// A file that is built into the program (cmake/EmbedFiles.cmake).
#pragma once

#include <string_view>

namespace mercury {

struct EmbeddedFile {
  std::string_view name;  // "eel.json"
  std::string_view contents;
};

}  // namespace mercury
