// SPDX-License-Identifier: Apache-2.0
// For each target of the fuzzers: a fixed number of damaged documents, and those that fuzzers found earlier.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

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

// What fuzzers found earlier (docs/building.md). A suite of its own, because it takes longer.
class Corpus : public Readers {
 protected:
  Corpus() { std::signal(SIGABRT, name_document); }  // fail() ends the program; this says where
  ~Corpus() override { std::signal(SIGABRT, SIG_DFL); }
  static void name_document(int) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, document.data(), document.size());
  }
  static inline std::string document;
};

TEST_P(Corpus, IsRefusedOrRead) {
  const std::filesystem::path folder = std::filesystem::path(MERCURY_FUZZ_CORPUS) / GetParam().name;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "nothing is kept yet; run_all --keep does that";
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    document = "while reading " + file.path().string() + "\n";
    run(GetParam(), content_of(file.path()));
  }
}

const auto name = [](const auto& test) { return std::string(test.param.name); };
INSTANTIATE_TEST_SUITE_P(All, Readers, testing::ValuesIn(targets().begin(), targets().end()), name);
INSTANTIATE_TEST_SUITE_P(All, Corpus, testing::ValuesIn(targets().begin(), targets().end()), name);

}  // namespace
}  // namespace mercury::fuzz
