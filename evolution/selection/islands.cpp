// SPDX-License-Identifier: Apache-2.0
#include "evolution/selection/islands.h"

#include <algorithm>
#include <utility>

#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"

namespace mercury {
namespace {

// Some of the individuals, and which of them they are.
struct Group {
  std::vector<Individual> individuals;
  std::vector<std::size_t> indices;
  void add(std::span<const Individual> all, std::size_t index) {
    individuals.push_back(all[index]);
    indices.push_back(index);
  }
};

}  // namespace

Islands::Islands(const AlgorithmSettings& settings, std::unique_ptr<Algorithm> custom) : settings_(settings) {
  const AlgorithmDescription& algorithm = algorithm_named(settings.name);
  validate(settings);
  algorithms_.resize(settings.islands);
  for (std::size_t island = 0; island < settings.islands; ++island) {
    AlgorithmSettings own = settings;
    own.population = share_of(settings.population, island);
    algorithms_[island] = algorithm.make(own);
  }
  if (custom) algorithms_.front() = std::move(custom);
  if (settings.islands > 1 && algorithm.many_objectives) all_ = algorithm.make(settings);
}

std::size_t Islands::share_of(std::size_t count, std::size_t island) const {
  return count / algorithms_.size() + (island < count % algorithms_.size() ? 1 : 0);
}

bool Islands::is_migration(int generation) const {
  return settings_.migration_interval > 0 && generation > 0 && generation % settings_.migration_interval == 0;
}

std::vector<ChildPlan> Islands::plan(int generation, std::span<const Individual> living, std::size_t children,
                                     std::uint64_t seed) const {
  const std::size_t count = algorithms_.size();
  if (count == 1) {
    Random random(seed);
    return algorithm().plan(living, children, random);
  }
  std::vector<Group> groups(count);
  for (std::size_t i = 0; i < living.size(); ++i) groups[living[i].island].add(living, i);
  std::vector<ChildPlan> plans(children);
  for (std::size_t island = 0; island < count; ++island) {
    const std::size_t room = share_of(children, island);
    std::vector<ChildPlan> own;
    if (is_migration(generation)) {
      const std::vector<std::size_t>& from = groups[(island + count - 1) % count].indices;  // the best first
      for (std::size_t i = 0; i < std::min({settings_.migrants, from.size(), room}); ++i)
        own.push_back({.parents = {from[i]}, .is_migrant = true});
    }
    Random random(seed_of(seed, island));
    for (ChildPlan& plan : algorithms_[island]->plan(groups[island].individuals, room - own.size(), random)) {
      for (std::size_t& parent : plan.parents) parent = groups[island].indices[parent];
      own.push_back(std::move(plan));
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
      ChildPlan& place = plans[island + i * count];
      place = std::move(own[i]);
      place.island = island;
    }
  }
  return plans;
}

std::vector<std::size_t> Islands::survivors(std::span<const Individual> pool, std::size_t living) const {
  if (algorithms_.size() == 1) return algorithm().survivors(pool, living);
  std::vector<Group> natives(algorithms_.size());
  std::vector<std::vector<std::size_t>> migrants(algorithms_.size());
  std::vector<std::size_t> alive(algorithms_.size());
  for (std::size_t i = 0; i < pool.size(); ++i) {
    const std::size_t island = pool[i].island;
    if (i >= living && pool[i].is_migrant) {
      migrants[island].push_back(i);
    } else {
      natives[island].add(pool, i);
      alive[island] += i < living;
    }
  }
  Group chosen;
  for (std::size_t island = 0; island < algorithms_.size(); ++island) {
    const std::size_t room = share_of(settings_.population, island) - migrants[island].size();
    std::vector<std::size_t> own = algorithms_[island]->survivors(natives[island].individuals, alive[island]);
    own.resize(std::min(own.size(), room));
    for (const std::size_t i : own) chosen.add(pool, natives[island].indices[i]);
    for (const std::size_t i : migrants[island]) chosen.add(pool, i);
  }
  // Which of several objectives come first is known to the algorithm alone.
  std::vector<std::size_t> order =
      all_ ? all_->survivors(chosen.individuals, chosen.individuals.size()) : best_first(chosen.individuals);
  for (std::size_t& i : order) i = chosen.indices[i];
  return order;
}

std::size_t Islands::species(std::span<const Individual> living) const {
  if (algorithms_.size() == 1) return algorithm().species(living);
  std::vector<Group> groups(algorithms_.size());
  for (std::size_t i = 0; i < living.size(); ++i) groups[living[i].island].add(living, i);
  std::size_t count = 0;
  for (std::size_t island = 0; island < groups.size(); ++island)
    count += algorithms_[island]->species(groups[island].individuals);
  return count;
}

}  // namespace mercury
