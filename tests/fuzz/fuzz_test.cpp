// SPDX-License-Identifier: Apache-2.0
// For each target of the fuzzers: a fixed number of damaged documents, and those that fuzzers found earlier.
#include <gtest/gtest.h>
#include <sys/resource.h>
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
  const int runs = GetParam().name.starts_with("robot") ? 12'000 : 3000;
  int refused = 0;
  for (int i = 0; i < runs; ++i) {
    Random random(static_cast<std::uint64_t>(i));
    const std::string& seed = seeds[random.below(seeds.size())];
    refused += !run(GetParam(), mutated(seed, seeds[random.below(seeds.size())], random)).empty();
  }
  run(GetParam(), "");
  // Both are common, so the edits reach into the readers. What is wrong in the settings of the window has its default.
  EXPECT_GT(refused, GetParam().name == "session" ? -1 : runs / 2);
  EXPECT_GE(runs - refused, runs / 500);
#ifndef __SANITIZE_ADDRESS__  // which keeps what was freed
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, 600 * 1024) << "kB: nothing is allocated from a number that a file only claims";
#endif
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
