// SPDX-License-Identifier: Apache-2.0
// Sorts numbers by counting digits, without comparing any two: no branch depends on the numbers.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <vector>

namespace mercury {

struct SortEntry {
  double number;  // at least 0
  std::uint32_t index;
};

// The number rounded down to 44 bits, 32 of them after the leading one: what radix_sort() looks at.
inline double rounded_down(double number) {
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(number) & ~std::uint64_t{0xfffff});
}

// Sorts by rounded_down(number); equals keep their order. `spare` is memory.
inline void radix_sort(std::vector<SortEntry>& entries, std::vector<SortEntry>& spare) {
  constexpr int digit_bits = 11, digits = 4, lowest_bit = 64 - digits * digit_bits;
  constexpr std::size_t values = 1 << digit_bits;
  // Positive floating-point numbers are in the order of their bits.
  const auto digit_of = [](const SortEntry& e, int digit) {
    return std::bit_cast<std::uint64_t>(e.number) >> (lowest_bit + digit * digit_bits) & (values - 1);
  };
  std::array<std::array<std::uint32_t, values>, digits> begins{};
  for (const SortEntry& e : entries)
    for (int digit = 0; digit < digits; ++digit) ++begins[static_cast<std::size_t>(digit)][digit_of(e, digit)];
  spare.resize(entries.size());
  for (int digit = 0; digit < digits; ++digit) {
    auto& begin = begins[static_cast<std::size_t>(digit)];
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), 0u);
    for (const SortEntry& e : entries) spare[begin[digit_of(e, digit)]++] = e;
    entries.swap(spare);
  }
}

}  // namespace mercury
