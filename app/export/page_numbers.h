// SPDX-License-Identifier: Apache-2.0
// Numbers of a web page: tables of whole numbers as few bytes. app/export/page/decoding.js reads them.
//
// Motion is smooth, so a position is predicted well by the two frames before it. What is left fits into one byte almost
// always; it is a whole number, so errors do not add up over time.
//
//     value        412  431  448  462        in steps of 0.5 mm
//     predicted      0  412  450  465        nothing, the same, the same change
//     left         412   19   -2   -3
//     zigzag       824   38    3    5        2 n, or -2 n - 1 below 0
//     bytes        the low bytes of all numbers, then the next ones: 56 38 3 5, 3 0 0 0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "app/base/embedded_file.h"

namespace mercury {

// Tables one after another.
class PageNumbers {
 public:
  // `order`: how many rows before a number predict it, 0 to 2. Throws InputError if differences do not fit into 32
  // bits.
  void add(std::string_view name, std::span<const std::int32_t> values, std::size_t columns, int order);

  nlohmann::ordered_json descriptions() const;  // of the tables, in order
  std::string packed() const;                   // all of them, deflated (zlib format), in base64

 private:
  std::string descriptions_;  // JSON, without the brackets
  std::string bytes_;
};

// The files of app/export/page, from which web pages are put together.

// cmake/EmbedFiles.cmake writes this function at build time.
std::span<const EmbeddedFile> page_files();

}  // namespace mercury
