// SPDX-License-Identifier: Apache-2.0
#include "mercury/evolution.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <unordered_set>
#include <utility>

#include "evolution/selection/islands.h"
#include "evolution/selection/ranking.h"
#include "mercury/error.h"
#include "mercury/parallel.h"
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

// `start` = the genome with which a search among numbers begins.
GenomePointer genome_of(const ChildPlan& plan, const GenomePointer& start) {
  return plan.numbers.empty() ? start : start->with_numbers(plan.numbers);
}

std::size_t children_per_generation(const EvolutionSettings& settings) {
  return settings.children > 0 ? settings.children : settings.algorithm.population;
}

}  // namespace

bool operator==(const Generation& a, const Generation& b) {
  const auto same = [](const Individual& x, const Individual& y) {
    return x.id == y.id && x.parents == y.parents && x.generation == y.generation && x.line_began == y.line_began &&
           x.seed == y.seed && x.island == y.island && x.is_migrant == y.is_migrant && x.assessment == y.assessment;
  };
  return a.number == b.number && a.living == b.living && std::ranges::equal(a.born, b.born, same);
}

namespace {

// The founder, or the first random genome that can be made.
GenomePointer start_of_search(const GenomeSpace& space, std::uint64_t seed) {
  for (int attempt = 0;; ++attempt) {
    try {
      return space.random(seed_of_child(seed, 0, 0, attempt),
                          space.founders() > 0 ? 0 : static_cast<std::uint64_t>(attempt));
    } catch (const InputError&) {
      if (attempt + 1 == tries_for_a_new_genome) throw;
    }
  }
}

}  // namespace

void validate(const EvolutionSettings& settings, const GenomeSpace& space) {
  const AlgorithmDescription& algorithm = algorithm_named(settings.algorithm.name);
  if (!algorithm.of_numbers && !algorithm.of_species) return;
  const std::string name(algorithm.name);
  if (algorithm.of_species) {
    const GenomePointer start = start_of_search(space, settings.seed);
    if (!start->distance(*start))
      throw ParameterError("algorithm", name + " divides robots into species by brains that grow; let brains grow");
    return;
  }
  if (space.founders() > 1)
    throw ParameterError("algorithm",
                         name + " begins with one robot, and there are " + std::to_string(space.founders()));
  if (start_of_search(space, settings.seed)->numbers().empty())
    throw ParameterError("algorithm", name +
                                          " needs genomes that are a fixed list of numbers: the muscles of a robot "
                                          "file, the weights of its brain, or a tapered robot");
}

std::size_t usual_population(std::string_view algorithm, const GenomeSpace& space, std::uint64_t seed) {
  if (!algorithm_named(algorithm).of_numbers) return AlgorithmSettings{}.population;
  const std::size_t n = start_of_search(space, seed)->numbers().size();
  return 4 + static_cast<std::size_t>(3 * portable_log(static_cast<double>(std::max<std::size_t>(1, n))));
}

Evolution::Evolution(const EvolutionSettings& settings, const GenomeSpace& space, std::unique_ptr<Algorithm> algorithm)
    : settings_(settings), space_(space),
      islands_(std::make_unique<Islands>(settings.algorithm, std::move(algorithm))) {
  validate(settings);
  validate(settings, space);
  if (algorithm_named(settings.algorithm.name).of_numbers) start_ = start_of_search(space, settings.seed);
  begin_to_learn();
}

Evolution::~Evolution() = default;

void Evolution::begin_to_learn() {
  islands_->algorithm().begin(start_ ? start_->numbers() : std::vector<double>(), settings_.mutation);
}

void Evolution::restore(int generation, std::vector<Individual> living, std::span<const Individual> born,
                        std::vector<Individual> before) {
  next_generation_ = generation + 1;
  living_ = std::move(living);
  before_ = std::move(before);
  begun_.clear();
  next_id_ = born.size();
  begin_to_learn();
  if (!algorithm_named(settings_.algorithm.name).learns) return;
  std::size_t first = 0;
  for (int number = 0; number <= generation; ++number) {
    std::size_t end = first;
    while (end < born.size() && born[end].generation == number) ++end;
    const Random random(seed_of_plan(settings_.seed, number));
    if (start_ && number == generation) {
      Random again = random;
      const std::vector<ChildPlan> plans = islands_->algorithm().plan({}, settings_.algorithm.population, again);
      for (const Individual& individual : living_) {
        if (individual.generation != number) continue;
        const std::size_t child = static_cast<std::size_t>(individual.id) - first;
        if (child >= plans.size() || genome_of(plans[child], start_)->identity() != individual.genome->identity())
          throw InputError("generation " + std::to_string(number),
                           "is not what the scores before it lead to here; go on with the version of Mercury and on "
                           "the kind of processor that made it");
      }
    }
    islands_->algorithm().learn(born.subspan(first, end - first), random);
    first = end;
  }
}

namespace {

// Makes the children of a generation on all cores, and makes those again that are not new on their island.
class Breeding {
 public:
  // `start` = of a search among numbers, or nullptr.
  Breeding(const EvolutionSettings& settings, const GenomeSpace& space, GenomePointer start,
           std::span<const Individual> living, int generation, std::vector<ChildPlan> plans)
      : settings_(settings), space_(space), start_(std::move(start)), living_(living), generation_(generation),
        plans_(std::move(plans)), seeds_(plans_.size()), genomes_(plans_.size()), identities_(plans_.size()) {}

  std::vector<Individual> children(const Watch& watch) {
    std::vector<std::unordered_set<std::uint64_t>> known(settings_.algorithm.islands);
    for (const Individual& individual : living_) known[individual.island].insert(individual.genome->identity());
    std::vector<std::size_t> missing(plans_.size());
    std::iota(missing.begin(), missing.end(), std::size_t{0});
    const int tries = start_ ? 1 : tries_for_a_new_genome;  // a plan of numbers gives one genome
    for (int attempt = 0; !missing.empty() && attempt < tries; ++attempt) {
      for (std::size_t first = 0; first < missing.size(); first += portion) {
        if (watch) watch(0, plans_.size());
        parallel_for(first, std::min(first + portion, missing.size()),
                     [&](std::size_t k) { make(missing[k], attempt); });
      }
      std::erase_if(missing, [&](std::size_t i) {
        return genomes_[i] && (known[plans_[i].island].insert(identities_[i]).second || plans_[i].is_migrant);
      });
    }
    return individuals();
  }

 private:
  static constexpr std::size_t portion = 256;  // children between two calls of the watch

  // A try that fails leaves the child of an earlier one, which is like another but can live.
  void make(std::size_t i, int attempt) {
    const std::uint64_t seed = plans_[i].is_migrant ? 0 : seed_of_child(settings_.seed, generation_, i, attempt);
    try {
      GenomePointer genome = make_genome(i, attempt, seed);
      identities_[i] = genome->identity();
      genomes_[i] = std::move(genome);
      seeds_[i] = seed;
    } catch (const InputError&) {
    }
  }

  GenomePointer make_genome(std::size_t i, int attempt, std::uint64_t seed) const {
    if (start_) return genome_of(plans_[i], start_);
    const std::vector<std::size_t>& parents = plans_[i].parents;
    if (parents.empty()) {
      const bool may_be_founder = generation_ == 0 && attempt == 0;
      return space_.random(seed, may_be_founder ? i : space_.founders() + i);
    }
    if (plans_[i].is_migrant) return living_[parents[0]].genome;
    const double strength = settings_.mutation * (1 + attempt / 4.0);  // each further try changes a little more
    GenomePointer genome = living_[parents[0]].genome;
    if (parents.size() > 1)
      genome = genome->cross_by_fitness(*living_[parents[1]].genome,
                                        compare_fitness(living_[parents[0]], living_[parents[1]]), seed_of(seed, 0));
    return genome->mutate(strength, seed);
  }

  std::vector<Individual> individuals() {
    std::vector<std::size_t> made;
    for (std::size_t i = 0; i < plans_.size(); ++i)
      if (genomes_[i]) made.push_back(i);
    std::vector<Individual> children(made.size());
    parallel_for(0, made.size(), [&](std::size_t k) {
      const std::size_t i = made[k];
      Individual& child = children[k];
      child.generation = child.line_began = generation_;
      child.seed = seeds_[i];
      child.island = static_cast<std::uint16_t>(plans_[i].island);
      child.is_migrant = plans_[i].is_migrant;
      child.genome = std::move(genomes_[i]);
      for (const std::size_t parent : plans_[i].parents) {
        child.parents.push_back(living_[parent].id);
        child.line_began = std::min(child.line_began, living_[parent].line_began);
      }
    });
    return children;
  }

  const EvolutionSettings& settings_;
  const GenomeSpace& space_;
  const GenomePointer start_;
  const std::span<const Individual> living_;
  const int generation_;
  const std::vector<ChildPlan> plans_;
  std::vector<std::uint64_t> seeds_;
  std::vector<GenomePointer> genomes_;  // nullptr = could not be made
  std::vector<std::uint64_t> identities_;
};

}  // namespace

std::vector<ChildPlan> Evolution::plans(int generation, std::span<const Individual> parents) const {
  if (generation > 0 || start_)
    return islands_->plan(generation, parents, children_per_generation(settings_),
                          seed_of_plan(settings_.seed, generation));
  std::vector<ChildPlan> plans(std::max(settings_.algorithm.population, space_.founders()));
  for (std::size_t i = 0; i < plans.size(); ++i) plans[i].island = islands_->island_of(i);
  return plans;
}

std::vector<Individual> Evolution::breed(int generation, const std::vector<Individual>& parents, std::uint64_t first_id,
                                         const Watch& watch) const {
  std::vector<Individual> children =
      Breeding(settings_, space_, start_, parents, generation, plans(generation, parents)).children(watch);
  for (std::size_t i = 0; i < children.size(); ++i) children[i].id = first_id + i;
  return children;
}

const std::vector<Individual>& Evolution::parents() const {
  return settings_.pipelined && next_generation_ > 1 ? before_ : living_;
}

std::vector<Individual> Evolution::children(const Watch& watch) const {
  return breed(next_generation_, parents(), next_id_, watch);
}

std::vector<double> Evolution::interim_limits() const { return interim_limits(parents()); }

std::vector<double> Evolution::interim_limits(std::span<const Individual> parents) const {
  std::vector<double> limits;
  if (!settings_.trials.racing || parents.empty()) return limits;
  for (std::size_t check = 0; check < racing_checks; ++check) {
    // Those who were stopped before this check count as the worst. So if many of them live, few more are stopped.
    std::vector<double> scores;
    for (const Individual& individual : parents) {
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
  const std::size_t lived = living_.size();
  return select(std::move(children),
                [&](std::span<const Individual> pool) { return islands_->survivors(pool, lived); });
}

Generation Evolution::select(std::vector<Individual> children, std::span<const std::uint64_t> living) {
  return select(std::move(children), [&](std::span<const Individual> pool) {
    std::vector<std::size_t> survivors;
    for (const std::uint64_t id : living) {
      const auto found = std::ranges::find(pool, id, &Individual::id);
      const auto index = static_cast<std::size_t>(found - pool.begin());
      if (found == pool.end() || std::ranges::find(survivors, index) != survivors.end())
        throw InputError("living", "robot " + std::to_string(id) +
                                       " is not accepted; give each of those that live or are born, at most once");
      survivors.push_back(index);
    }
    return survivors;
  });
}

// While it waits for a generation, a GPU has nothing to do. So individuals are moved, not copied, as far as that goes.
// Those that are gone are freed on all cores: one by one, that takes a fifth of the time.
Generation Evolution::select(std::vector<Individual> children, const SurvivorsOf& survivors_of) {
  const std::size_t lived = living_.size();
  std::vector<Individual> pool = std::exchange(living_, {});
  pool.insert(pool.end(), std::move_iterator(children.begin()), std::move_iterator(children.end()));
  std::vector<std::size_t> survivors;
  try {
    survivors = survivors_of(pool);
  } catch (...) {
    pool.resize(lived);
    living_ = std::move(pool);
    throw;
  }
  living_.resize(survivors.size());
  parallel_for(0, survivors.size(), [&](std::size_t k) {
    Individual& survivor = pool.at(survivors[k]);
    if (survivors[k] < lived && !settings_.pipelined)
      living_[k] = std::move(survivor);
    else
      living_[k] = survivor;
  });
  Generation generation{.number = next_generation_, .born = {}, .living = {}};
  const auto born = pool.begin() + static_cast<std::ptrdiff_t>(lived);
  generation.born.assign(std::move_iterator(born), std::move_iterator(pool.end()));
  for (const Individual& individual : living_) generation.living.push_back(individual.id);
  if (settings_.pipelined) {
    pool.resize(lived);
    std::swap(before_, pool);
  }
  parallel_for(0, pool.size(), [&](std::size_t i) { pool[i] = {}; });
  next_id_ += generation.born.size();
  islands_->algorithm().learn(generation.born, Random(seed_of_plan(settings_.seed, next_generation_)));
  ++next_generation_;
  return generation;
}

namespace {

std::vector<GenomePointer> genomes_of(std::span<const Individual> individuals) {
  std::vector<GenomePointer> genomes;
  for (const Individual& individual : individuals) genomes.push_back(individual.genome);
  return genomes;
}

}  // namespace

std::vector<Individual> Evolution::begun(Assessor& assessor, const Watch& watch) {
  const auto begin = [&](int generation, const std::vector<Individual>& parents, std::uint64_t first_id,
                         const Watch& making) {
    begun_.push_back(breed(generation, parents, first_id, making));
    assessor.prepare(genomes_of(begun_.back()), interim_limits(parents));
  };
  if (begun_.empty()) begin(next_generation_, parents(), next_id_, watch);
  if (settings_.pipelined && next_generation_ > 0 && next_generation_ < settings_.generations)
    begin(next_generation_ + 1, living_, next_id_ + begun_.front().size(), {});
  std::vector<Individual> born = std::move(begun_.front());
  begun_.pop_front();
  return born;
}

std::optional<Generation> Evolution::advance(Assessor& assessor, const Watch& watch) {
  if (is_over()) return std::nullopt;
  std::vector<Individual> born;
  std::optional<std::vector<Assessment>> assessments;
  try {
    born = begun(assessor, watch);
    if (born.empty()) throw InputError("generation " + std::to_string(next_generation_), "no robot could be made");
    assessments = assessor.assess(genomes_of(born), interim_limits(), watch);
  } catch (...) {
    begun_.clear();
    throw;
  }
  if (!assessments) {
    begun_.clear();
    return std::nullopt;
  }
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
