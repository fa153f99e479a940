// SPDX-License-Identifier: Apache-2.0
#include "app/export/page_numbers.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/base/output_files.h"
#include "mercury/error.h"

namespace mercury {
namespace {

std::uint32_t zigzag(std::int64_t value) {
  if (value < std::numeric_limits<std::int32_t>::min() || value > std::numeric_limits<std::int32_t>::max())
    throw InputError("html", "holds no motion of this size; export a part of it");
  return static_cast<std::uint32_t>(value >= 0 ? 2 * value : -2 * value - 1);
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION) != Z_OK)
    throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

}  // namespace

void PageNumbers::add(std::string_view name, std::span<const std::int32_t> values, std::size_t columns, int order) {
  std::vector<std::uint32_t> left(values.size());
  std::uint32_t largest = 0;
  const auto before = [&](std::size_t i, std::size_t rows) { return std::int64_t{values[i - rows * columns]}; };
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t row = i / columns;
    std::int64_t predicted = order > 0 && row > 0 ? before(i, 1) : 0;
    if (order > 1 && row > 1) predicted += before(i, 1) - before(i, 2);
    left[i] = zigzag(values[i] - predicted);
    largest = std::max(largest, left[i]);
  }
  const int width = (static_cast<int>(std::bit_width(largest)) + 7) / 8;
  for (int byte = 0; byte < width; ++byte)
    for (const std::uint32_t number : left) bytes_ += static_cast<char>(number >> (8 * byte) & 255);
  const nlohmann::ordered_json description{{"name", name},
                                           {"rows", columns > 0 ? values.size() / columns : 0},
                                           {"columns", columns},
                                           {"order", order},
                                           {"width", width}};
  descriptions_ += (descriptions_.empty() ? "" : ",") + description.dump();
}

nlohmann::ordered_json PageNumbers::descriptions() const {
  return nlohmann::ordered_json::parse("[" + descriptions_ + "]");
}

std::string PageNumbers::packed() const { return base64(deflated(bytes_)); }

}  // namespace mercury
