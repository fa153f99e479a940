// SPDX-License-Identifier: Apache-2.0
#include "mercury/evolution.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <unordered_set>
#include <utility>

#include "mercury/error.h"
#include "mercury/random.h"

namespace mercury {
namespace {

constexpr int tries_for_a_new_genome = 16;
constexpr double interim_quantile = 0.25;  // racing stops a robot whose score is below this quantile of the living

std::uint64_t seed_of_generation(std::uint64_t run, int generation) {
  return seed_of(run, static_cast<std::uint64_t>(generation));
}
std::uint64_t seed_of_plan(std::uint64_t run, int generation) {
  return seed_of(seed_of_generation(run, generation), 0);
}
std::uint64_t seed_of_child(std::uint64_t run, int generation, std::size_t child, int attempt) {
  return seed_of(seed_of(seed_of_generation(run, generation), child + 1), static_cast<std::uint64_t>(attempt));
}

std::size_t children_per_generation(const EvolutionSettings& settings) {
  return settings.children > 0 ? settings.children : settings.algorithm.population;
}

}  // namespace

bool operator==(const Generation& a, const Generation& b) {
  const auto same = [](const Individual& x, const Individual& y) {
    return x.id == y.id && x.parents == y.parents && x.generation == y.generation && x.line_began == y.line_began &&
           x.seed == y.seed && x.assessment == y.assessment;
  };
  return a.number == b.number && a.living == b.living && std::ranges::equal(a.born, b.born, same);
}

Evolution::Evolution(const EvolutionSettings& settings, const GenomeSpace& space)
    : settings_(settings), space_(space), algorithm_(make_algorithm(settings.algorithm)) {
  validate(settings);
}

void Evolution::restore(int generation, std::vector<Individual> living, std::uint64_t next_id) {
  next_generation_ = generation + 1;
  living_ = std::move(living);
  next_id_ = next_id;
}

namespace {

// Makes the children of a generation on all cores, and makes those again that are not new.
class Breeding {
 public:
  Breeding(const EvolutionSettings& settings, const GenomeSpace& space, std::span<const Individual> living,
           int generation, std::vector<ChildPlan> plans)
      : settings_(settings), space_(space), living_(living), generation_(generation), plans_(std::move(plans)),
        seeds_(plans_.size()), genomes_(plans_.size()), identities_(plans_.size()) {}

  std::vector<Individual> children(const Watch& watch) {
    std::unordered_set<std::uint64_t> known;
    for (const Individual& individual : living_) known.insert(individual.genome->identity());
    std::vector<std::size_t> missing(plans_.size());
    std::iota(missing.begin(), missing.end(), std::size_t{0});
    for (int attempt = 0; !missing.empty() && attempt < tries_for_a_new_genome; ++attempt) {
      for (std::size_t first = 0; first < missing.size(); first += portion) {
        if (watch) watch(0, plans_.size());
        oneapi::tbb::parallel_for(first, std::min(first + portion, missing.size()),
                                  [&](std::size_t k) { make(missing[k], attempt); });
      }
      std::erase_if(missing, [&](std::size_t i) { return genomes_[i] && known.insert(identities_[i]).second; });
    }
    return individuals();
  }

 private:
  static constexpr std::size_t portion = 256;  // children between two calls of the watch

  // A try that fails leaves the child of an earlier one, which is like another but can live.
  void make(std::size_t i, int attempt) {
    const std::uint64_t seed = seed_of_child(settings_.seed, generation_, i, attempt);
    try {
      GenomePointer genome = make_genome(i, attempt, seed);
      identities_[i] = genome->identity();
      genomes_[i] = std::move(genome);
      seeds_[i] = seed;
    } catch (const InputError&) {
    }
  }

  GenomePointer make_genome(std::size_t i, int attempt, std::uint64_t seed) const {
    const std::vector<std::size_t>& parents = plans_[i].parents;
    if (parents.empty()) {
      const bool may_be_founder = generation_ == 0 && attempt == 0;
      return space_.random(seed, may_be_founder ? i : space_.founders() + i);
    }
    const double strength = settings_.mutation * (1 + attempt / 4.0);  // each further try changes a little more
    GenomePointer genome = living_[parents[0]].genome;
    if (parents.size() > 1) genome = genome->cross(*living_[parents[1]].genome, seed_of(seed, 0));
    return genome->mutate(strength, seed);
  }

  std::vector<Individual> individuals() {
    std::vector<Individual> children;
    for (std::size_t i = 0; i < plans_.size(); ++i) {
      if (!genomes_[i]) continue;
      Individual& child = children.emplace_back();
      child.generation = child.line_began = generation_;
      child.seed = seeds_[i];
      child.genome = std::move(genomes_[i]);
      for (const std::size_t parent : plans_[i].parents) {
        child.parents.push_back(living_[parent].id);
        child.line_began = std::min(child.line_began, living_[parent].line_began);
      }
    }
    return children;
  }

  const EvolutionSettings& settings_;
  const GenomeSpace& space_;
  const std::span<const Individual> living_;
  const int generation_;
  const std::vector<ChildPlan> plans_;
  std::vector<std::uint64_t> seeds_;
  std::vector<GenomePointer> genomes_;  // nullptr = could not be made
  std::vector<std::uint64_t> identities_;
};

}  // namespace

std::vector<Individual> Evolution::children(const Watch& watch) const {
  std::vector<ChildPlan> plans;
  if (next_generation_ == 0) {
    plans.resize(std::max(settings_.algorithm.population, space_.founders()));
  } else {
    Random random(seed_of_plan(settings_.seed, next_generation_));
    plans = algorithm_->plan(living_, children_per_generation(settings_), random);
  }
  std::vector<Individual> children =
      Breeding(settings_, space_, living_, next_generation_, std::move(plans)).children(watch);
  for (std::size_t i = 0; i < children.size(); ++i) children[i].id = next_id_ + i;
  return children;
}

std::vector<double> Evolution::interim_limits() const {
  std::vector<double> limits;
  if (!settings_.trials.racing || living_.empty()) return limits;
  for (std::size_t check = 0; check < racing_checks; ++check) {
    // Those who were stopped before this check count as the worst. So if many of them live, few more are stopped.
    std::vector<double> scores;
    for (const Individual& individual : living_) {
      const std::vector<double>& known = individual.assessment.interim_scores;
      scores.push_back(check < known.size() ? known[check] : worst_score);
    }
    const auto rank = static_cast<std::ptrdiff_t>(interim_quantile * static_cast<double>(scores.size() - 1));
    std::ranges::nth_element(scores, scores.begin() + rank);
    limits.push_back(scores[static_cast<std::size_t>(rank)]);
  }
  return limits;
}

Generation Evolution::select(std::vector<Individual> children) {
  Generation generation{.number = next_generation_, .born = children};
  const std::size_t before = living_.size();
  std::vector<Individual> pool = std::move(living_);
  next_id_ += children.size();
  std::ranges::move(children, std::back_inserter(pool));
  living_.clear();
  for (const std::size_t i : algorithm_->survivors(pool, before)) living_.push_back(std::move(pool.at(i)));
  for (const Individual& individual : living_) generation.living.push_back(individual.id);
  ++next_generation_;
  return generation;
}

std::optional<Generation> Evolution::advance(Assessor& assessor, const Watch& watch) {
  if (is_over()) return std::nullopt;
  std::vector<Individual> born = children(watch);
  if (born.empty()) throw InputError("generation " + std::to_string(next_generation_), "no robot could be made");
  std::vector<GenomePointer> genomes;
  for (const Individual& child : born) genomes.push_back(child.genome);
  std::optional<std::vector<Assessment>> assessments = assessor.assess(genomes, interim_limits(), watch);
  if (!assessments) return std::nullopt;
  for (std::size_t i = 0; i < born.size(); ++i) born[i].assessment = std::move((*assessments)[i]);
  const auto failed = [](const Individual& individual) { return individual.assessment.fate == Fate::failed; };
  if (next_generation_ == 0 && std::ranges::all_of(born, failed))
    throw InputError("generation 0", "no robot can be tried: " + born.front().assessment.problem);
  return select(std::move(born));
}

namespace {
constexpr std::string_view fates[] = {"sound",  "stopped",   "exploded", "overstretched",
                                      "failed", "too small", "undefined"};
}

std::string_view name_of(Fate fate) { return fates[static_cast<std::size_t>(fate)]; }

std::optional<Fate> fate_named(std::string_view name) {
  const auto* found = std::ranges::find(fates, name);
  if (found == std::end(fates)) return std::nullopt;
  return static_cast<Fate>(found - std::begin(fates));
}

Fate worse(Fate a, Fate b) {
  constexpr int severity[] = {0, 1, 3, 4, 6, 5, 2};
  return severity[static_cast<std::size_t>(a)] < severity[static_cast<std::size_t>(b)] ? b : a;
}

}  // namespace mercury
