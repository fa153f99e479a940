// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/rest_lengths.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "sim/cuda/layout.h"

namespace mercury::cuda {
namespace {

// Numbers rest lengths in the order in which they come. A hash table of open addressing finds them again.
class LengthNumbers {
 public:
  LengthNumbers() { number(0); }

  std::uint16_t number(float length) {
    const auto bits = std::bit_cast<std::uint32_t>(length);
    std::uint32_t at = bits * 0x9e3779b1u >> (32 - table_bits);
    while (entries_[at].bits != bits) {
      if (entries_[at].bits == Entry().bits) {
        entries_[at] = {bits, static_cast<std::uint16_t>(lengths_.size())};
        lengths_.push_back(length);
      } else {
        at = (at + 1) % (1u << table_bits);
      }
    }
    return entries_[at].number;
  }

  const std::vector<float>& lengths() const { return lengths_; }

 private:
  static constexpr int table_bits = 10;
  struct Entry {
    std::uint32_t bits = 0xffffffffu;  // not those of a length
    std::uint16_t number = 0;
  };

  std::array<Entry, 1 << table_bits> entries_;
  std::vector<float> lengths_;  // [number]
};

}  // namespace

RestLengths rest_lengths(const Robot& robot) {
  LengthNumbers numbers;
  std::vector<std::uint16_t> number_of_spring(robot.springs.size());
  for (std::size_t i = 0; i < robot.springs.size() && numbers.lengths().size() <= max_lengths; ++i)
    number_of_spring[i] = numbers.number(robot.springs[i].rest_length);
  RestLengths result{numbers.lengths(), {}};
  std::ranges::sort(result.table);
  if (result.table.size() > max_lengths) return result;
  std::array<std::uint8_t, max_lengths> index{};  // [number]
  for (std::size_t number = 0; number < result.table.size(); ++number)
    index[number] = static_cast<std::uint8_t>(std::ranges::lower_bound(result.table, numbers.lengths()[number]) -
                                              result.table.begin());
  result.index.resize(robot.springs.size());
  for (std::size_t i = 0; i < robot.springs.size(); ++i) result.index[i] = index[number_of_spring[i]];
  return result;
}

std::uint32_t record_words_for(const Robot& robot) { return rest_lengths(robot).table.size() <= max_lengths ? 1 : 2; }

}  // namespace mercury::cuda
