// SPDX-License-Identifier: Apache-2.0
// A small evolution for tests: genomes of bytes, scored without a simulation.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mercury/error.h"
#include "mercury/evolution.h"
#include "mercury/quantity.h"
#include "mercury/random.h"
#include "mercury/run_folder.h"
#include "mercury/voxel.h"
#include "robots/file/whole_file.h"
#include "tests/folder.h"
#include "tests/refusal.h"

namespace mercury {

class ByteGenome : public Genome {
 public:
  explicit ByteGenome(std::string bytes) : bytes_(std::move(bytes)) {}

  // One voxel of a material that depends on the bytes.
  Robot grow(const std::string& name) const override {
    VoxelGrid grid(1, 1, 1, static_cast<MaterialId>(1 + identity() % 20));
    return make_voxel_robot(grid, {.name = name});
  }
  GenomePointer mutate(double, std::uint64_t seed) const override {
    Random random(seed);
    std::string bytes = bytes_;
    for (int i = 0; i < 4; ++i) bytes[random.below(bytes.size())] = static_cast<char>(random.below(256));
    return std::make_shared<ByteGenome>(bytes);
  }
  GenomePointer cross(const Genome& other, std::uint64_t seed) const override {
    Random random(seed);
    std::string bytes = other.encode();
    for (std::size_t i = 0; i < bytes.size(); ++i)
      if (random.chance(0.5)) bytes[i] = bytes_[i];
    return std::make_shared<ByteGenome>(bytes);
  }
  std::uint64_t identity() const override { return std::hash<std::string>{}(bytes_); }
  std::string encode() const override { return bytes_; }
  std::optional<double> distance(const Genome& other) const override {
    const std::string bytes = other.encode();
    double differing = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) differing += bytes[i] != bytes_[i];
    return differing / 10;
  }
  std::vector<double> numbers() const override {
    std::vector<double> numbers;
    for (const char byte : bytes_) numbers.push_back(static_cast<unsigned char>(byte) / step);
    return numbers;
  }
  GenomePointer with_numbers(std::span<const double> numbers) const override {
    std::string bytes;
    for (const double number : numbers)
      bytes.push_back(static_cast<char>(static_cast<unsigned char>(std::clamp(number * step, 0.0, 255.0))));
    return std::make_shared<ByteGenome>(bytes);
  }

 private:
  static constexpr double step = 30;
  std::string bytes_;
};

class ByteSpace : public GenomeSpace {
 public:
  GenomePointer random(std::uint64_t seed, std::uint64_t index) const override {
    Random random(seed_of(seed, index));
    std::string bytes(length, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random.below(256));
    return std::make_shared<ByteGenome>(bytes);
  }
  GenomePointer decode(std::string_view bytes) const override {
    if (bytes.size() != length) throw InputError("a genome of another length");
    return std::make_shared<ByteGenome>(std::string(bytes));
  }
  static constexpr std::size_t length = 100;
};

inline std::unique_ptr<GenomeSpace> byte_space(const GenomeSpaceRequest&) { return std::make_unique<ByteSpace>(); }

// Scores are sums of bytes; one individual in eight does not end well.
class ByteAssessor : public Assessor {
 public:
  explicit ByteAssessor(std::size_t objectives = 1) : objectives_(objectives) {}

  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates, std::span<const double>,
                                                const Watch&) override {
    std::vector<Assessment> assessments;
    for (const GenomePointer& genome : candidates) assessments.push_back(assessment_of(genome->encode()));
    return assessments;
  }
  std::string device_name() const override { return "no device"; }

 private:
  Assessment assessment_of(const std::string& bytes) const {
    Assessment assessment{.fate = Fate::sound, .hash = std::hash<std::string>{}(bytes)};
    Random random(assessment.hash);
    if (random.below(8) == 0) assessment.fate = static_cast<Fate>(2 + random.below(3));
    if (assessment.fate == Fate::failed) assessment.problem = "a problem, \"quoted\"";
    for (std::size_t i = 0; i < objectives_; ++i) {
      double sum = 0;
      for (std::size_t k = i; k < bytes.size(); k += objectives_) sum += static_cast<unsigned char>(bytes[k]) / 255.0;
      assessment.scores.push_back(assessment.fate == Fate::sound ? sum : worst_score);
    }
    if (assessment.fate != Fate::failed)
      for (std::size_t q = 0; q < quantities().size(); ++q) assessment.values.push_back(random.uniform(-1, 1));
    return assessment;
  }

  std::size_t objectives_;
};

inline RunSettings test_settings(int generations = 5) {
  RunSettings settings{.program = "a test"};
  settings.evolution.algorithm = {.name = "afpo", .population = 12};
  settings.evolution.generations = generations;
  settings.space.kind = "bytes";
  return settings;
}

// Of 4, 4 and 4 robots; one migrates every other generation.
inline RunSettings island_settings(int generations) {
  RunSettings settings = test_settings(generations);
  settings.evolution.algorithm.islands = 3;
  settings.evolution.algorithm.migration_interval = 2;
  settings.evolution.algorithm.migrants = 1;
  return settings;
}

// Takes generations until it is over, or as many as given.
inline void evolve(RunFolder& run, int most = 1'000'000) {
  Evolution evolution(run.history().settings().evolution, run.space());
  restore(run.history(), evolution);
  ByteAssessor assessor(run.history().settings().evolution.objectives.size());
  for (int i = 0; i < most; ++i) {
    const std::optional<Generation> generation = evolution.advance(assessor);
    if (!generation) break;
    run.append_later(*generation, {.seconds = 0.5, .device = assessor.device_name()});
  }
  run.history();  // waits
}

// What an error says; "" if there is none.
template <class Action>
std::string error_of(const Action& action) {
  return refusal<std::exception>(action);
}

inline bool is_one_line(const std::string& message) {
  return !message.empty() && message.size() < 400 &&
         std::ranges::none_of(message, [](char letter) { return letter >= 0 && letter < ' '; });
}

// Expects the same lineage with the same genomes.
inline void expect_same_run(const RunHistory& a, const RunHistory& b) {
  ASSERT_EQ(a.individuals().size(), b.individuals().size());
  for (std::size_t id = 0; id < a.individuals().size(); ++id) {
    const Individual &x = a.individuals()[id], &y = b.individuals()[id];
    EXPECT_EQ(x.parents, y.parents);
    EXPECT_EQ(x.seed, y.seed);
    EXPECT_EQ(x.line_began, y.line_began);
    EXPECT_EQ(x.island, y.island);
    EXPECT_EQ(x.is_migrant, y.is_migrant);
    EXPECT_EQ(x.assessment, y.assessment);
    EXPECT_EQ(a.died(id), b.died(id));
    EXPECT_EQ(a.genome(id)->encode(), b.genome(id)->encode());
  }
  EXPECT_TRUE(std::ranges::equal(a.living(), b.living()));
}

class RunFolderTest : public test::TestWithFolder {
 protected:
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  RunFolder create(const std::string& name, const RunSettings& settings = test_settings(), bool force = false) const {
    return RunFolder::create(path(name), settings, force, byte_space);
  }
  RunFolder open(const std::string& name) const { return RunFolder::open(path(name), byte_space); }
  RunHistory history(const std::string& name) const { return RunHistory(path(name), byte_space); }
  // A run that is over, closed.
  void make_run(const std::string& name, const RunSettings& settings = test_settings()) const {
    RunFolder run = create(name, settings);
    evolve(run);
  }
  std::string read(const std::string& name) const { return read_whole_file(path(name)); }
  void write(const std::string& name, std::string_view content) const {
    std::filesystem::remove(path(name));  // some file systems wait for the disk where a file is shortened
    std::ofstream(path(name), std::ios::binary) << content;
  }
};

}  // namespace mercury
