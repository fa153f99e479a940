// SPDX-License-Identifier: Apache-2.0
// Mutation and crossover of painted voxel robots.
#include <algorithm>
#include <cmath>
#include <set>

#include "mercury/cppn.h"
#include "mercury/error.h"
#include "mercury/random.h"
#include "robots/cppn/cppn_graph.h"

namespace mercury {
namespace {

constexpr std::uint64_t tries = 50;           // of a child with a body of its own
constexpr std::size_t most_grown_nodes = 64;  // mutation adds none beyond

// The first of make(0), make(1), ... that has a body, and one unlike those of its parents.
template <class Make>
CppnGenome first_of_its_own(const CppnGenome& parent, const std::vector<PaintedBody>& parents, Make make) {
  CppnGenome last = parent;
  for (std::uint64_t attempt = 0; attempt < tries; ++attempt) {
    CppnGenome child = make(attempt);
    const PaintedBody body = painted_body(child);
    if (body.is_empty()) continue;
    if (std::ranges::find(parents, body) == parents.end()) return child;
    last = std::move(child);
  }
  return last;
}

class Mutation {
 public:
  Mutation(Cppn& network, double strength, Random& random) : network_(network), strength_(strength), random_(random) {}

  void run() {
    change_weights();
    change_functions();
    repeat(0.15, [&] { add_node(); });
    repeat(0.08, [&] { remove_node(); });
    repeat(0.2, [&] { add_random_edge(network_, normal(), random_); });
    repeat(0.1, [&] { remove_edge(); });
    prune(network_);
  }

 private:
  float normal() { return static_cast<float>(random_.normal()); }
  bool chance(double rate) { return random_.chance(std::min(1., rate * strength_)); }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_.below(n)); }

  template <class Action>  // rate * strength times on average, at most 100 times
  void repeat(double rate, Action action) {
    const double expected = std::min(100., rate * strength_), whole = std::floor(expected);
    const int count = static_cast<int>(whole) + (random_.chance(expected - whole) ? 1 : 0);
    for (int i = 0; i < count; ++i) action();
  }

  void change_weights() {
    const auto size = static_cast<float>(0.25 * std::clamp(strength_, 1., 100.));
    for (CppnEdge& edge : network_.edges)
      if (chance(0.25))
        edge.weight = std::clamp(edge.weight + size * (0.4f + std::abs(edge.weight)) * normal(), -max_cppn_weight,
                                 max_cppn_weight);
  }
  void change_functions() {
    for (CppnNode& node : network_.nodes)
      if (chance(0.08)) node.function = random_function(random_);
  }
  void add_node() {
    if (network_.edges.empty() || network_.nodes.size() >= most_grown_nodes) return;
    const std::size_t edge = below(network_.edges.size());
    const NewNode node{random_function(random_), normal(), normal()};
    split_edge(network_, edge, node);
  }
  void remove_node() {
    if (network_.nodes.empty()) return;
    network_.nodes.erase(network_.nodes.begin() + static_cast<std::ptrdiff_t>(below(network_.nodes.size())));
    restore_order(network_);
  }
  void remove_edge() {
    if (network_.edges.empty()) return;
    network_.edges.erase(network_.edges.begin() + static_cast<std::ptrdiff_t>(below(network_.edges.size())));
  }

  Cppn& network_;
  double strength_;
  Random& random_;
};

// Inherits nodes from the outputs downward, as long as edges lead to further ones.
class Inheritance {
 public:
  Inheritance(const Cppn& a, const Cppn& b, Random& random) : a_(a), b_(b), random_(random) {}

  Cppn child() {
    child_.outputs = a_.outputs;
    for (std::uint32_t output = 0; output < child_.outputs; ++output) inherit(id_of(output));
    while (!wanted_.empty()) {
      const auto highest = std::prev(wanted_.end());
      const std::uint32_t id = highest->second;
      wanted_.erase(highest);
      inherit(id);
    }
    restore_order(child_);
    prune(child_);
    return std::move(child_);
  }

 private:
  static const CppnNode* find(const Cppn& network, std::uint32_t id) {
    const auto found = std::ranges::find(network.nodes, id, &CppnNode::id);
    return found == network.nodes.end() ? nullptr : &*found;
  }

  void inherit(std::uint32_t id) {
    const CppnNode *of_a = find(a_, id), *of_b = find(b_, id);
    const bool both = is_hidden(id) ? of_a && of_b : output_of(id) < b_.outputs;
    const bool from_b = both ? random_.chance(0.5) : is_hidden(id) && !of_a;
    if (is_hidden(id)) {
      if (child_.nodes.size() >= max_cppn_nodes) return;
      child_.nodes.push_back(from_b ? *of_b : *of_a);
    }
    for (const CppnEdge& edge : (from_b ? b_ : a_).edges) {
      if (edge.to != id || child_.edges.size() >= max_cppn_edges) continue;
      child_.edges.push_back(edge);
      if (is_hidden(edge.from) && seen_.insert(edge.from).second)
        wanted_.insert({*place_of(find(a_, edge.from) ? a_ : b_, edge.from), edge.from});
    }
  }

  const Cppn &a_, &b_;
  Random& random_;
  Cppn child_;
  std::set<std::uint32_t> seen_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> wanted_;  // place and id
};

}  // namespace

CppnGenome cppn_genome_in(const Robot& robot) {
  std::optional<CppnGenome> genome = cppn_genome_of(robot);
  if (!genome) throw InputError("/origin", "holds no painting network");
  return *std::move(genome);
}

CppnGenome mutate(const CppnGenome& genome, double strength, std::uint64_t seed) {
  if (!(std::isfinite(strength) && strength >= 0)) throw ParameterError("strength", "give a number of at least 0");
  const PaintedBody body = painted_body(genome);
  if (strength == 0) return genome;
  return first_of_its_own(genome, {body}, [&](std::uint64_t attempt) {
    Random random(seed_of(seed, attempt));
    CppnGenome child = genome;
    const double stronger = std::ldexp(std::min(strength, 1e6), static_cast<int>(attempt / 5));
    Mutation(child.network, stronger, random).run();
    return child;
  });
}

CppnGenome mutate_muscles(const CppnGenome& genome, double strength, std::uint64_t seed, int tail) {
  validate(genome);
  CppnGenome child = genome;
  move_muscles(child.frequency, child.amplitude, strength, seed, tail);
  return child;
}

CppnGenome crossover(const CppnGenome& a, const CppnGenome& b, std::uint64_t seed) {
  Random random(seed);
  CppnGenome of_a = a;
  if (random.chance(0.5)) of_a.frequency = b.frequency;
  if (random.chance(0.5)) of_a.amplitude = b.amplitude;
  const std::vector<PaintedBody> bodies{painted_body(a), painted_body(b)};
  if (a.network == b.network) return of_a;
  return first_of_its_own(of_a, bodies, [&](std::uint64_t attempt) {
    Random drawn(seed_of(seed, attempt));
    CppnGenome child = of_a;
    child.network = Inheritance(a.network, b.network, drawn).child();
    return child;
  });
}

Robot mutate_cppn_robot(const Robot& parent, const MutationRequest& request, const std::string& name) {
  validate(request);
  const CppnGenome child = mutate(cppn_genome_in(parent), request.strength, request.seed);
  return grow(mutate_muscles(child, request.muscles, seed_of(request.seed, 0)), name);
}

Robot cross_cppn_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name) {
  return grow(crossover(cppn_genome_in(a), cppn_genome_in(b), seed), name);
}

}  // namespace mercury
