// SPDX-License-Identifier: Apache-2.0
// The journal `genomes`: what is written is read; what is cut off or damaged is noticed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evolution/run_folder/generation_record.h"
#include "robots/bytes.h"
#include "tests/evolution/run_folder/test_run.h"
#include "tests/size_limit.h"

namespace mercury {
namespace {

using testing::HasSubstr;

class Journal : public RunFolderTest {
 protected:
  // Where records begin, and the end.
  std::vector<std::size_t> borders(const std::string& journal) const {
    std::vector<std::size_t> found;
    for (std::size_t at = journal.find(head_mark); at != std::string::npos; at = journal.find(head_mark, at + 1))
      if (decode_head(std::string_view(journal).substr(at))) found.push_back(at);
    found.push_back(journal.size());
    return found;
  }
};

TEST_F(Journal, HoldsEveryoneWhoWasBornWithTheirGenomes) {
  RunFolder run = create("run");
  Evolution evolution(run.history().settings().evolution, run.space());
  ByteAssessor assessor;
  std::vector<Generation> generations;
  while (const auto generation = evolution.advance(assessor)) {
    run.append(*generation, {.seconds = 2, .device = "a device"});
    generations.push_back(*generation);
  }
  ASSERT_EQ(generations.size(), 6u);
  const RunHistory read = history("run");
  std::size_t id = 0;
  for (const Generation& generation : generations)
    for (const Individual& born : generation.born) {
      const Individual& stored = read.individuals()[id];
      EXPECT_EQ(stored.id, id);
      EXPECT_EQ(stored.generation, generation.number);
      EXPECT_EQ(stored.parents, born.parents);
      EXPECT_EQ(stored.seed, born.seed);
      EXPECT_EQ(stored.line_began, born.line_began);
      EXPECT_EQ(stored.assessment, born.assessment);
      EXPECT_EQ(read.genome(id)->encode(), born.genome->encode());
      ++id;
    }
  EXPECT_EQ(id, read.individuals().size());
  EXPECT_TRUE(std::ranges::equal(read.living(), generations.back().living));
  EXPECT_EQ(read.generations().back().times.device, "a device");
  EXPECT_EQ(read.generations().back().times.seconds, 2);
}

TEST_F(Journal, ChainsOfDifferencesAreBounded) {
  RunSettings settings = test_settings(3 * longest_chain);
  settings.evolution.algorithm = {.name = "ga", .population = 2, .crossover = 0};
  make_run("run", settings);
  const RunHistory read = history("run");
  EXPECT_GT(read.line_of(read.individuals().size() - 1).size(), static_cast<std::size_t>(longest_chain));
  for (std::size_t id = 0; id < read.individuals().size(); ++id) EXPECT_NO_THROW(read.genome(id));
  // Children that differ in 4 of 100 bytes take less than half of the space.
  std::uint64_t stored = 0;
  const std::string journal = this->read("run/genomes");
  for (const std::size_t at : borders(journal))
    if (const auto head = decode_head(std::string_view(journal).substr(at))) stored += head->genomes_size;
  EXPECT_LT(stored, read.individuals().size() * ByteSpace::length / 2);
}

TEST_F(Journal, CutOffAtAnyByteHoldsTheGenerationsBefore) {
  make_run("run", test_settings(3));
  std::filesystem::copy(path("run"), path("whole"));
  const RunHistory whole = history("whole");
  const std::string journal = read("run/genomes");
  const std::vector<std::size_t> border = borders(journal);
  ASSERT_EQ(border.size(), 5u);
  // Every byte of the last generation and of the head; of those between, which are read alike, each seventh.
  for (std::size_t size = journal.size() - 1; size > 0; --size) {
    if (size > border[0] && size < border[3] && size % 7 != 0) continue;
    std::filesystem::resize_file(path("run/genomes"), size);
    if (size < border[0]) {
      EXPECT_TRUE(is_one_line(error_of([&] { history("run"); }))) << size;
      continue;
    }
    const auto generations = static_cast<std::size_t>(std::ranges::upper_bound(border, size) - border.begin()) - 1;
    ASSERT_EQ(history("run").generations().size(), generations) << size;
    // Not at every byte, since the writer waits for the disk.
    if (size % 1001 != 0) continue;
    std::filesystem::remove_all(path("copy"));
    std::filesystem::copy(path("run"), path("copy"));
    RunFolder run = open("copy");
    ASSERT_EQ(read("copy/genomes"), journal.substr(0, border[generations]));
    evolve(run);
    expect_same_run(run.history(), whole);
  }
}

TEST_F(Journal, EndThatWasWrittenInPartsIsIgnored) {
  make_run("run", test_settings(2));
  const std::string journal = read("run/genomes");
  const std::vector<std::size_t> border = borders(journal);
  // After a power cut, pages of the last record may be zero.
  for (std::size_t at = border[2]; at < journal.size(); at += 97) {
    std::string damaged = journal;
    damaged.replace(at, std::min<std::size_t>(512, journal.size() - at), 512, '\0');
    damaged.resize(journal.size());
    write("run/genomes", damaged);
    ASSERT_EQ(history("run").generations().size(), 2u) << at;
  }
}

TEST_F(Journal, DamageBeforeTheLastRecordIsAnErrorAndNothingIsRemoved) {
  make_run("run", test_settings(2));
  const RunHistory whole = history("run");
  const std::string journal = read("run/genomes");
  const std::size_t last = borders(journal)[2];
  for (std::size_t at = 0; at < last; at += 7) {
    std::string damaged = journal;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    write("run/genomes", damaged);
    std::string error = error_of([&] { open("run"); });
    // Genomes are checked when they are read.
    if (error.empty())
      error = error_of([&] {
        const RunHistory read = history("run");
        for (std::size_t id = 0; id < read.individuals().size(); ++id) read.genome(id);
      });
    EXPECT_TRUE(is_one_line(error)) << "byte " << at << ": " << error;
    EXPECT_THAT(error, HasSubstr("genomes"));
    ASSERT_EQ(read("run/genomes"), damaged);
  }
}

// Bytes that pass all checksums and lie.
TEST_F(Journal, CountsThatTheBytesDoNotBackAreRefused) {
  const GenerationRecord record{.generation = {.number = 0, .born = {{}}, .living = {0}}, .genomes = {{.size = 3}}};
  const std::string index = encode_index(record);
  EXPECT_NO_THROW(decode_index(index, 0, 0, 3));
  for (std::size_t at = 0; at < index.size(); ++at)
    for (const int value : {0x00, 0x01, 0x7f, 0xff}) {
      std::string damaged = index;
      damaged[at] = static_cast<char>(value);
      try {
        const GenerationRecord read = decode_index(damaged, 0, 0, 3);
        EXPECT_LE(read.generation.born.size(), 2u);
      } catch (const DamagedBytes&) {
      }
    }
}

TEST_F(Journal, ANewerVersionIsRefused) {
  make_run("run", test_settings(1));
  std::string journal = read("run/genomes");
  journal[16] = 4;
  write("run/genomes", journal);
  EXPECT_EQ(error_of([&] { history("run"); }),
            path("run/genomes").string() + ": version 4 is newer than this program, which reads up to version 3");
  EXPECT_EQ(read("run/genomes"), journal);
}

TEST_F(Journal, AFailedAppendLeavesItAsItWas) {
  RunFolder run = create("run", test_settings(4));
  evolve(run, 2);
  const std::string journal = read("run/genomes");
  std::string error;
  {
    const SizeLimit limited(journal.size() + 500);
    error = error_of([&] { evolve(run, 1); });
  }
  EXPECT_THAT(error, HasSubstr("ulimit -f"));
  EXPECT_EQ(read("run/genomes"), journal);
  evolve(run);
  make_run("other", test_settings(4));
  expect_same_run(history("run"), history("other"));
}

}  // namespace
}  // namespace mercury
