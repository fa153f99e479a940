// SPDX-License-Identifier: Apache-2.0
// A search whose optimum is known: genomes are vectors of numbers, and the best one is given. No robot is stepped.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mercury/assessor.h"
#include "mercury/error.h"
#include "mercury/evolution.h"
#include "mercury/genome.h"
#include "mercury/quantity.h"
#include "mercury/random.h"

namespace mercury {

class VectorGenome : public Genome {
 public:
  explicit VectorGenome(std::vector<double> numbers) : numbers_(std::move(numbers)) {}
  std::vector<double> numbers() const override {
    std::vector<double> numbers = numbers_;
    for (double& x : numbers) x /= step;
    return numbers;
  }
  GenomePointer with_numbers(std::span<const double> numbers) const override {
    std::vector<double> scaled(numbers.begin(), numbers.end());
    for (double& x : scaled) x *= step;
    return std::make_shared<VectorGenome>(scaled);
  }
  std::optional<double> distance(const Genome& other) const override {
    double sum = 0;
    for (std::size_t i = 0; i < numbers_.size(); ++i)
      sum += std::abs(numbers_[i] - dynamic_cast<const VectorGenome&>(other).numbers_[i]);
    return sum;
  }
  const std::vector<double>& values() const { return numbers_; }

  Robot grow(const std::string&) const override { throw InputError("genome", "has no robot"); }

  // Each number moves with probability 1/3.
  GenomePointer mutate(double strength, std::uint64_t seed) const override {
    Random random(seed);
    std::vector<double> numbers = numbers_;
    for (double& x : numbers)
      if (random.chance(1.0 / 3)) x += step * strength * random.normal();
    return std::make_shared<VectorGenome>(numbers);
  }
  GenomePointer cross(const Genome& other, std::uint64_t seed) const override {
    Random random(seed);
    std::vector<double> numbers = numbers_;
    const std::vector<double>& others = dynamic_cast<const VectorGenome&>(other).numbers_;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (random.chance(0.5)) numbers[i] = others[i];
    return std::make_shared<VectorGenome>(numbers);
  }
  std::uint64_t identity() const override { return std::hash<std::string>()(encode()); }
  std::string encode() const override {
    std::string bytes(numbers_.size() * sizeof(double), '\0');
    std::memcpy(bytes.data(), numbers_.data(), bytes.size());
    return bytes;
  }

 private:
  static constexpr double step = 0.1;  // of a mutation
  std::vector<double> numbers_;
};

// Vectors in a cube around 0. Every `refused`-th random genome does not exist; 0 = all do.
class VectorSpace : public GenomeSpace {
 public:
  explicit VectorSpace(std::size_t dimensions = 8, std::uint64_t refused = 0)
      : dimensions_(dimensions), refused_(refused) {}

  GenomePointer random(std::uint64_t seed, std::uint64_t index) const override {
    if (refused_ > 0 && seed_of(seed, index) % refused_ == 0) throw InputError("genome", "there is none");
    Random random(seed_of(seed, index));
    std::vector<double> numbers(dimensions_);
    for (double& x : numbers) x = random.uniform(-1, 1);
    return std::make_shared<VectorGenome>(numbers);
  }
  GenomePointer decode(std::string_view bytes) const override {
    if (bytes.size() != dimensions_ * sizeof(double)) throw InputError("genome", "has the wrong length");
    std::vector<double> numbers(dimensions_);
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return std::make_shared<VectorGenome>(numbers);
  }

 private:
  const std::size_t dimensions_;
  const std::uint64_t refused_;
};

// Scores minus the squared distance to (0.5, 0.5, ...), or, for two objectives, to that and to (-0.5, -0.5, ...). The
// quantities size and symmetry are the first two numbers.
class VectorAssessor : public Assessor {
 public:
  explicit VectorAssessor(std::size_t objectives = 1, std::uint64_t failing = 0)
      : objectives_(objectives), failing_(failing) {}

  std::optional<std::vector<Assessment>> assess(std::span<const GenomePointer> candidates, std::span<const double>,
                                                const Watch& watch) override {
    std::vector<Assessment> assessments;
    for (const GenomePointer& candidate : candidates) {
      if (watch && !watch(assessments.size(), candidates.size())) return std::nullopt;
      assessments.push_back(assess_one(dynamic_cast<const VectorGenome&>(*candidate)));
    }
    count_ += candidates.size();
    return assessments;
  }
  std::string device_name() const override { return "a formula"; }
  std::size_t count() const { return count_; }  // of those assessed so far

 private:
  Assessment assess_one(const VectorGenome& genome) const {
    Assessment assessment;
    if (failing_ > 0 && genome.identity() % failing_ == 0) {
      assessment.problem = "of bad luck";
      assessment.scores.assign(objectives_, worst_score);
      return assessment;
    }
    assessment.fate = Fate::sound;
    for (std::size_t o = 0; o < objectives_; ++o) {
      const double target = o == 0 ? 0.5 : -0.5;
      double score = 0;
      for (const double x : genome.values()) score -= (x - target) * (x - target);
      assessment.scores.push_back(score);
    }
    assessment.values.assign(quantities().size(), 0);
    assessment.values[find_quantity("size").value()] = genome.values()[0];
    assessment.values[find_quantity("symmetry").value()] = genome.values()[1];
    assessment.hash = genome.identity();
    return assessment;
  }

  const std::size_t objectives_;
  const std::uint64_t failing_;
  std::size_t count_ = 0;
};

// All generations.
inline std::vector<Generation> run(Evolution& evolution, Assessor& assessor) {
  std::vector<Generation> generations;
  while (std::optional<Generation> generation = evolution.advance(assessor)) generations.push_back(*generation);
  return generations;
}
inline std::vector<Generation> run(const EvolutionSettings& settings, const GenomeSpace& space = VectorSpace()) {
  VectorAssessor assessor(settings.objectives.size());
  Evolution evolution(settings, space);
  return run(evolution, assessor);
}

// Makes each generation by an evolution of its own, restored from what files hold.
inline void expect_the_same_when_restored(const EvolutionSettings& settings) {
  const VectorSpace space;
  const std::vector<Generation> whole = run(settings);
  VectorAssessor assessor;
  std::vector<Individual> living, before, born;
  for (std::size_t number = 0; number < whole.size(); ++number) {
    Evolution evolution(settings, space);
    if (number > 0) evolution.restore(static_cast<int>(number) - 1, living, born, before);
    before = living;
    const std::optional<Generation> generation = evolution.advance(assessor);
    ASSERT_TRUE(generation);
    EXPECT_EQ(*generation, whole[number]);
    living = evolution.living();
    born.insert(born.end(), generation->born.begin(), generation->born.end());
  }
}

}  // namespace mercury
