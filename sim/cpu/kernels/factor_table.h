// SPDX-License-Identifier: Apache-2.0
// Looks up the factors L(t) / L0 of a row of springs, each by the number of its muscle.
//
// Every row of springs does it, so it is made in the way that is fastest here:
//
//   AVX-512, up to 256 factors   the table is in registers of 16, and one instruction picks from two of them by the
//                                lower five bits of a number; the higher bits choose among the results
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

#if HWY_TARGET == HWY_AVX3
// table[index] for at most 256 numbers.
HWY_INLINE __m512 look_up_in_registers(const float* table, std::size_t count, __m512i index) {
  const auto among_32 = [&](std::size_t first) HWY_ATTR {
    return _mm512_permutex2var_ps(_mm512_load_ps(table + first), index, _mm512_load_ps(table + first + 16));
  };
  const auto has_bit = [&](int bit) HWY_ATTR { return _mm512_test_epi32_mask(index, _mm512_set1_epi32(bit)); };
  __m512 result = among_32(0);
  if (count <= 32) return result;
  const __mmask16 odd = has_bit(32);
  result = _mm512_mask_mov_ps(result, odd, among_32(32));
  if (count <= 64) return result;
  const __mmask16 upper = has_bit(64);
  if (count <= 96) return _mm512_mask_mov_ps(result, upper, among_32(64));
  result = _mm512_mask_mov_ps(result, upper, _mm512_mask_mov_ps(among_32(64), odd, among_32(96)));
  if (count <= 128) return result;
  const __m512 third = _mm512_mask_mov_ps(among_32(128), odd, among_32(160));
  const __m512 fourth = _mm512_mask_mov_ps(among_32(192), odd, among_32(224));
  return _mm512_mask_mov_ps(result, has_bit(128), _mm512_mask_mov_ps(third, upper, fourth));
}
#endif

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

// The factors of these springs, where the mask is set; elsewhere 0 or any factor.
HWY_INLINE Lanes look_up(StepFactors factors, const FactorId* ids, Mask wanted) {
#if HWY_TARGET == HWY_AVX3
  if (factors.count <= Factors::readable) {
    const auto index = hn::PromoteTo(integers, hn::LoadU(hn::Rebind<FactorId, decltype(integers)>(), ids));
    return hn::Vec<decltype(floats)>{look_up_in_registers(factors.first, factors.count, index.raw)};
  }
#endif
  if (factors.one_by_one) return look_up_one_by_one(factors.first, ids);
  return look_up_gathering(factors.first, ids, wanted);
}

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
