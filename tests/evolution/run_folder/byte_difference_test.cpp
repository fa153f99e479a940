// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/generation_record.h"

#include <gtest/gtest.h>

#include "mercury/random.h"
#include "robots/bytes.h"

namespace mercury {
namespace {

std::string random_bytes(Random& random, std::size_t size) {
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random.below(256));
  return bytes;
}

TEST(ByteDifference, GivesTheTargetBack) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    const std::string base = random_bytes(random, random.below(300));
    std::string target = base;
    target.resize(random.chance(0.5) ? base.size() : random.below(300), 'x');
    for (auto changes = random.below(20); changes > 0 && !target.empty(); --changes)
      target[random.below(target.size())] = static_cast<char>(random.below(256));
    EXPECT_EQ(with_difference(base, difference_of(base, target)), target) << "seed " << seed;
  }
}

TEST(ByteDifference, OfEqualBytesIsTheirNumber) {
  EXPECT_EQ(difference_of("", ""), std::string(1, '\0'));
  EXPECT_EQ(difference_of("abc", "abc"), "\x03");
}

TEST(ByteDifference, OfFewChangesIsShort) {
  Random random(1);
  const std::string base = random_bytes(random, 24'000);
  std::string target = base;
  // A tenth of 6,000 weights of 4 bytes.
  for (std::size_t weight = 0; weight < 6000; weight += 10) target.replace(4 * weight, 4, random_bytes(random, 4));
  EXPECT_LT(difference_of(base, target).size(), 600u * (4 + 2) + 4);
}

TEST(ByteDifference, DamagedOnesAreRefusedOrGiveNoMoreThanTheyCan) {
  Random random(1);
  const std::string base = random_bytes(random, 100);
  const std::string sound = difference_of(base, random_bytes(random, 90));
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    std::string damaged = sound;
    for (auto changes = 1 + random.below(3); changes > 0; --changes)
      damaged[random.below(damaged.size())] = static_cast<char>(random.below(256));
    try {
      EXPECT_LE(with_difference(base, damaged).size(), base.size() + damaged.size());
    } catch (const DamagedBytes&) {
    }
  }
}

}  // namespace
}  // namespace mercury
