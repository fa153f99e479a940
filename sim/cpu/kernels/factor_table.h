// SPDX-License-Identifier: Apache-2.0
// Looks up the factors L(t) / L0 of a row of springs, each by the number of its muscle.
//
// Every row of springs does it, so it is made in the way that is fastest here:
//
//   AVX-512, up to 256 factors   the table is in registers of 16 numbers, of which the first 8 are loaded once per
//                                step; one instruction picks from two of them by the lower five bits of an index, and
//                                the higher bits choose among the results
//   gather                       one instruction, on most processors as many loads as lanes
//   one by one                   a load per lane, where gathers are slower still (AMD; Intel with a protection
//                                against Downfall)
#pragma once

#include <algorithm>
#include <chrono>
#include <type_traits>

#include "sim/cpu/kernels/gather.h"
#include "sim/cpu/layout/muscles.h"
#include "sim/cpu/layout/step_setting.h"

HWY_BEFORE_NAMESPACE();
namespace mercury::cpu::HWY_NAMESPACE {

// table[id] by lane.
HWY_INLINE Lanes look_up_one_by_one(const float* table, const FactorId* ids) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
  const auto four = [&](std::size_t i) HWY_ATTR {
    const auto with = [&](__m128 v, std::size_t lane, auto place)
                          HWY_ATTR { return _mm_insert_ps(v, _mm_load_ss(table + ids[i + lane]), place.value); };
    const __m128 first = _mm_load_ss(table + ids[i]);
    return hn::Vec<decltype(four_floats)>{
        with(with(with(first, 1, std::integral_constant<int, 0x10>()), 2, std::integral_constant<int, 0x20>()), 3,
             std::integral_constant<int, 0x30>())};
  };
  return concatenated(floats, four, 0);
#else
  const auto narrow = hn::LoadU(hn::Rebind<FactorId, decltype(integers)>(), ids);
  return hn::GatherIndex(floats, table, hn::PromoteTo(integers, narrow));
#endif
}

// table[id] by lane, where the mask is set; elsewhere 0 or table[id].
HWY_INLINE Lanes look_up_gathering(const float* table, const FactorId* ids, Mask wanted) {
  const auto narrow = hn::LoadU(hn::Rebind<FactorId, decltype(integers)>(), ids);
  const auto index = hn::PromoteTo(integers, narrow);
  // An x86 gather keeps the register's old value in lanes that are not wanted, so it waits for whatever wrote that
  // register last. The compiler clears the register first only if the mask is not a constant.
#if HWY_TARGET == HWY_AVX2
  return hn::Vec<decltype(floats)>{_mm256_mask_i32gather_ps(_mm256_setzero_ps(), table, index.raw, wanted.m.raw, 4)};
#elif HWY_TARGET == HWY_AVX3
  return hn::Vec<decltype(floats)>{_mm512_mask_i32gather_ps(_mm512_setzero_ps(), wanted.m.raw, index.raw, table, 4)};
#else
  (void)wanted;
  return hn::GatherIndex(floats, table, index);
#endif
}

class FactorTable {
 public:
  HWY_INLINE explicit FactorTable(StepFactors factors) : factors_(factors) {
#if HWY_TARGET == HWY_AVX3
    for (std::size_t i = 0; i < in_registers; ++i) registers_[i] = _mm512_load_ps(factors.first + 16 * i);
#endif
  }

  // The factors of these springs, where the mask is set; elsewhere 0 or any factor.
  HWY_INLINE Lanes look_up(const FactorId* ids, Mask wanted) const {
#if HWY_TARGET == HWY_AVX3
    const __m512i index = hn::PromoteTo(integers, hn::LoadU(hn::Rebind<FactorId, decltype(integers)>(), ids)).raw;
    if (HWY_LIKELY(factors_.count <= 16 * in_registers)) return hn::Vec<decltype(floats)>{among_first(index)};
    if (factors_.count <= Factors::readable) return hn::Vec<decltype(floats)>{among_all(index)};
#endif
    if (factors_.one_by_one) return look_up_one_by_one(factors_.first, ids);
    return look_up_gathering(factors_.first, ids, wanted);
  }

 private:
  StepFactors factors_;
#if HWY_TARGET == HWY_AVX3
  static constexpr std::size_t in_registers = 8;  // more do not stay there
  __m512 registers_[in_registers];

  static HWY_INLINE __mmask16 has_bit(__m512i index, int bit) {
    return _mm512_test_epi32_mask(index, _mm512_set1_epi32(bit));
  }
  // The result for an index whose bit is not set, or the other.
  static HWY_INLINE __m512 choose(__mmask16 bit, __m512 no, __m512 yes) { return _mm512_mask_mov_ps(no, bit, yes); }

  HWY_INLINE __m512 among_first(__m512i index) const {
    const __mmask16 odd = has_bit(index, 32);
    const auto among_32 = [&](std::size_t i)
                              HWY_ATTR { return _mm512_permutex2var_ps(registers_[i], index, registers_[i + 1]); };
    const __m512 lower = choose(odd, among_32(0), among_32(2));
    return choose(has_bit(index, 64), lower, choose(odd, among_32(4), among_32(6)));
  }
  HWY_INLINE __m512 among_all(__m512i index) const {
    const float* const upper = factors_.first + 16 * in_registers;
    const __mmask16 odd = has_bit(index, 32);
    const auto among_32 = [&](std::size_t i) HWY_ATTR {
      return _mm512_permutex2var_ps(_mm512_load_ps(upper + 16 * i), index, _mm512_load_ps(upper + 16 * i + 16));
    };
    const __m512 lower = choose(odd, among_32(0), among_32(2));
    return choose(has_bit(index, 128), among_first(index),
                  choose(has_bit(index, 64), lower, choose(odd, among_32(4), among_32(6))));
  }
#endif
};

// Measures it in less than 0.1 ms.
inline bool one_by_one_is_faster() {
  constexpr std::size_t rows = 64, table_size = 128;
  constexpr int attempts = 8;
  alignas(64) float table[table_size], sums[lane_count];
  alignas(64) FactorId ids[rows * lane_count];
  for (std::size_t i = 0; i < table_size; ++i) table[i] = static_cast<float>(i);
  for (std::size_t i = 0; i < rows * lane_count; ++i) ids[i] = static_cast<FactorId>(37 * i % table_size);
  const auto best_of = [&](const auto& look_up_row) HWY_ATTR {
    auto best = std::chrono::steady_clock::duration::max();
    for (int attempt = 0; attempt < attempts; ++attempt) {
      const auto start = std::chrono::steady_clock::now();
      Lanes sum = 0.0f;
      for (std::size_t i = 0; i < rows * lane_count; i += lane_count) sum = sum + look_up_row(ids + i);
      store_aligned(sum, sums);
      volatile float used = sums[0];
      (void)used;
      best = std::min(best, std::chrono::steady_clock::now() - start);
    }
    return best;
  };
  const Mask all = Lanes(table[1]) > 0.0f;
  return best_of([&](const FactorId* row) HWY_ATTR { return look_up_one_by_one(table, row); }) <
         best_of([&](const FactorId* row) HWY_ATTR { return look_up_gathering(table, row, all); });
}

// Kernel::looks_up_one_by_one.
inline bool looks_up_one_by_one() {
  if constexpr (lane_count < 8) return false;  // there is no gather
  static const bool is_faster = one_by_one_is_faster();
  return is_faster;
}

}  // namespace mercury::cpu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
