// SPDX-License-Identifier: Apache-2.0
// The selection of NEAT (Stanley and Miikkulainen 2002, sections 3.3 and 4.1): robots compete within species, whose
// shares of the children follow from the mean of their members' scores (explicit fitness sharing), so that a new
// structure has time to improve.
//
// It keeps no state: species follow from the living alone. In the order of their birth, each joins the first species
// whose oldest member is near enough, or begins one; the paper takes a random member of the generation before in place
// of the oldest. The best of each species lives on, so that the generation in which it was born says how long the
// species has not improved.
//
// Scores below 0, which the paper does not have, count from the lowest one of a sound robot.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "evolution/selection/ranking.h"
#include "evolution/selection/registry.h"

namespace mercury {
namespace {

constexpr double parents_share = 0.2;        // of a species may have children
constexpr double interspecies_rate = 0.001;  // of second parents
constexpr int longer_patience = 5;           // generations, of all species together

class Neat : public Algorithm {
 public:
  explicit Neat(const AlgorithmSettings& settings) : settings_(settings) {}

  std::vector<ChildPlan> plan(std::span<const Individual> living, std::size_t children, Random& random) const override {
    if (living.empty()) return std::vector<ChildPlan>(children);
    const std::vector<Species> breeding = improving(living, species_of(living));
    const std::vector<std::size_t> shares = shares_of(living, breeding, children);
    std::vector<ChildPlan> plans;
    for (std::size_t k = 0; k < breeding.size(); ++k) {
      const Species& species = breeding[k];
      const auto parents = static_cast<std::size_t>(std::ceil(parents_share * static_cast<double>(species.size())));
      for (std::size_t i = 0; i < shares[k]; ++i) {
        ChildPlan& plan =
            plans.emplace_back(plan_child(parents, settings_.crossover, random, [&] { return random.below(parents); }));
        for (std::size_t& parent : plan.parents) parent = species[parent];
        if (const std::size_t other = random.below(living.size());
            random.chance(settings_.crossover * interspecies_rate) && other != plan.parents[0])
          plan.parents = {plan.parents[0], other};
      }
    }
    return plans;
  }

  // The best of each species, and the children. Of too many, the worst of the largest species go.
  std::vector<std::size_t> survivors(std::span<const Individual> pool, std::size_t living) const override {
    if (pool.empty()) return {};
    std::vector<Species> species = improving(pool, species_of(pool));
    std::vector<bool> is_champion(pool.size()), is_chosen(pool.size());
    for (const Species& one : species) is_champion[one.front()] = true;
    std::size_t count = 0;
    const auto choose = [&](std::size_t i) {
      count += !is_chosen[i];
      is_chosen[i] = true;
    };
    for (std::size_t i = 0; i < pool.size(); ++i)
      if (is_champion[i] || i >= living) choose(i);
    const std::vector<std::size_t> order = best_first(pool);
    for (const std::size_t i : order)
      if (count < settings_.population) choose(i);
    if (count > settings_.population) thin_out(species_of(pool), is_champion, is_chosen, count - settings_.population);
    std::vector<std::size_t> chosen;
    for (const std::size_t i : order)
      if (is_chosen[i]) chosen.push_back(i);
    chosen.resize(std::min(chosen.size(), settings_.population));
    return chosen;
  }

  std::size_t species(std::span<const Individual> living) const override { return species_of(living).size(); }

 private:
  using Species = std::vector<std::size_t>;  // the best first

  // How near the oldest member of a species the others are, as in the settings; or farther, in steps, until there are
  // at most as many species as the settings say.
  std::vector<Species> species_of(std::span<const Individual> pool) const {
    constexpr double step = 1.25;
    constexpr int steps = 64;  // to a million times as far
    std::vector<std::size_t> by_birth(pool.size());
    std::iota(by_birth.begin(), by_birth.end(), std::size_t{0});
    std::ranges::sort(by_birth, {}, [&](std::size_t i) { return pool[i].id; });
    std::vector<Species> species;
    double radius = settings_.species_distance;
    for (int i = 0; i <= steps && !divide(pool, by_birth, radius, i == steps, species); ++i) radius *= step;
    for (Species& members : species)
      std::ranges::sort(members, [&](std::size_t a, std::size_t b) { return better(pool[a], pool[b]); });
    std::ranges::sort(species, [&](const Species& a, const Species& b) { return better(pool[a[0]], pool[b[0]]); });
    return species;
  }

  // Whether they are few enough; all others of the last one then.
  bool divide(std::span<const Individual> pool, std::span<const std::size_t> by_birth, double radius, bool always,
              std::vector<Species>& species) const {
    species.clear();
    for (const std::size_t i : by_birth) {
      const auto joins = [&](const Species& members) { return distance(pool[members.front()], pool[i]) < radius; };
      auto own = std::ranges::find_if(species, joins);
      if (own == species.end()) {
        if (species.size() < settings_.species)
          own = species.emplace(own);
        else if (always)
          --own;
        else
          return false;
      }
      own->push_back(i);
    }
    return true;
  }

  static double distance(const Individual& a, const Individual& b) {
    return a.genome && b.genome ? a.genome->distance(*b.genome).value_or(0) : 0;
  }

  // Those that may have children, the best first: that of the best robot, and all whose best one is not too old. If
  // the best robot of all is older still, the two best alone.
  std::vector<Species> improving(std::span<const Individual> pool, std::vector<Species> species) const {
    if (settings_.stagnation == 0) return species;
    int now = 0;
    for (const Individual& individual : pool) now = std::max(now, individual.generation);
    const auto age = [&](const Species& one) { return now - pool[one.front()].generation; };
    if (age(species.front()) > settings_.stagnation + longer_patience) {
      species.resize(std::min<std::size_t>(species.size(), 2));
    } else {
      const auto is_stale = [&](const Species& one) { return age(one) > settings_.stagnation; };
      species.erase(std::remove_if(species.begin() + 1, species.end(), is_stale), species.end());
    }
    return species;
  }

  // How many of the children each species has: in proportion to the mean of its scores; what is left over goes to the
  // largest remainders.
  static std::vector<std::size_t> shares_of(std::span<const Individual> living, const std::vector<Species>& species,
                                            std::size_t children) {
    double lowest = 0;
    for (const Individual& individual : living)
      if (std::isfinite(individual.score())) lowest = std::min(lowest, individual.score());
    std::vector<double> means;
    double sum = 0;
    for (const Species& one : species) {
      double total = 0;
      for (const std::size_t i : one)
        if (std::isfinite(living[i].score())) total += living[i].score() - lowest;
      means.push_back(total / static_cast<double>(one.size()));
      sum += means.back();
    }
    if (!(sum > 0 && std::isfinite(sum))) {
      means.assign(species.size(), 1);
      sum = static_cast<double>(species.size());
    }
    std::vector<std::size_t> shares(species.size()), order(species.size());
    std::vector<double> remainders(species.size());
    std::size_t given = 0;
    for (std::size_t k = 0; k < species.size(); ++k) {
      const double share = means[k] / sum * static_cast<double>(children);
      given += shares[k] = std::min(static_cast<std::size_t>(share), children - given);
      remainders[k] = share - std::floor(share);
    }
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t k) { return remainders[k]; });
    for (std::size_t k = 0; given < children; ++k, ++given) ++shares[order[k % order.size()]];
    return shares;
  }

  // Champions go last, and then the worst of them.
  static void thin_out(std::vector<Species> species, const std::vector<bool>& is_champion, std::vector<bool>& is_chosen,
                       std::size_t surplus) {
    for (Species& one : species) std::erase_if(one, [&](std::size_t i) { return !is_chosen[i] || is_champion[i]; });
    for (; surplus > 0; --surplus) {
      const auto largest = std::ranges::max_element(species, {}, &Species::size);
      if (largest->empty()) return;
      is_chosen[largest->back()] = false;
      largest->pop_back();
    }
  }

  const AlgorithmSettings settings_;
};

}  // namespace

AlgorithmDescription neat() {
  return {.name = "neat",
          .help = "selection of NEAT, for brains that grow: robots compete within species, which share the children",
          .of_species = true,
          .make = [](const AlgorithmSettings& settings) -> std::unique_ptr<Algorithm> {
            return std::make_unique<Neat>(settings);
          }};
}

}  // namespace mercury
