// SPDX-License-Identifier: Apache-2.0
// A fixed number of damaged documents for each target of the fuzzers.
#include <gtest/gtest.h>

#include "tests/fuzz/mutation.h"
#include "tests/fuzz/target.h"

namespace mercury::fuzz {
namespace {

class Readers : public testing::TestWithParam<Target> {};

TEST_P(Readers, ReadWhatMercuryWrites) {
  for (const std::string& seed : GetParam().seeds()) EXPECT_EQ(run(GetParam(), seed), "");
}

TEST_P(Readers, RefuseOrReadDamagedDocuments) {
  const std::vector<std::string> seeds = GetParam().seeds();
  constexpr std::uint64_t runs = 400;
  for (std::uint64_t i = 0; i < runs; ++i) {
    Random random(i);
    const std::string& seed = seeds[random.below(seeds.size())];
    run(GetParam(), mutated(seed, seeds[random.below(seeds.size())], random));
  }
  run(GetParam(), "");
}

INSTANTIATE_TEST_SUITE_P(All, Readers, testing::ValuesIn(targets().begin(), targets().end()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace mercury::fuzz
