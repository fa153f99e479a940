// SPDX-License-Identifier: Apache-2.0
// The network: its rules and its evaluation.
#include "mercury/cppn.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <unordered_map>
#include <utility>

#include "mercury/error.h"
#include "robots/cppn/cppn_graph.h"
#include "robots/portable_math.h"

namespace mercury {
namespace {

constexpr double largest_value = 1e6;  // of a node

double kept_in_range(double value) { return std::clamp(value, -largest_value, largest_value); }

// Numbers of nodes in the order of their places: inputs, hidden nodes, outputs.
class Numbers {
 public:
  explicit Numbers(const Cppn& network) : hidden_(network.nodes.size()), outputs_(network.outputs) {
    for (std::size_t i = 0; i < hidden_; ++i) of_hidden_.emplace(network.nodes[i].id, cppn_inputs + i);
  }
  // SIZE_MAX if there is no such node.
  std::size_t of(std::uint32_t id) const {
    if (is_input(id)) return id;
    if (!is_hidden(id)) return output_of(id) < outputs_ ? cppn_inputs + hidden_ + output_of(id) : SIZE_MAX;
    const auto found = of_hidden_.find(id);
    return found == of_hidden_.end() ? SIZE_MAX : found->second;
  }

 private:
  std::size_t hidden_;
  std::uint32_t outputs_;
  std::unordered_map<std::uint32_t, std::size_t> of_hidden_;
};

[[noreturn]] void refuse(const char* list, std::size_t index, const std::string& what) {
  throw InputError(std::string("/") + list + "/" + std::to_string(index), what);
}

void validate_nodes(const std::vector<CppnNode>& nodes) {
  if (nodes.size() > max_cppn_nodes)
    throw InputError("/nodes", std::to_string(nodes.size()) + " nodes are not accepted; give at most " +
                                   std::to_string(max_cppn_nodes));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& [id, place, function] = nodes[i];
    if (!is_hidden(id)) refuse("nodes", i, "id " + std::to_string(id) + " is taken; give 9 to 4294967293");
    if (place < 1 || place >= output_place)
      refuse("nodes", i, "place " + std::to_string(place) + " is not accepted; give 1 to 1073741823");
    if (static_cast<std::size_t>(function) >= cppn_function_names.size()) refuse("nodes", i, "has no known function");
    if (i > 0 && std::pair(nodes[i - 1].place, nodes[i - 1].id) >= std::pair(place, id))
      refuse("nodes", i, "nodes must be in the order of place, then id");
    for (std::size_t j = 0; j < i; ++j)
      if (nodes[j].id == id) refuse("nodes", i, "id " + std::to_string(id) + " stands twice");
  }
}

void validate_edges(const Cppn& network) {
  const std::vector<CppnEdge>& edges = network.edges;
  if (edges.size() > max_cppn_edges)
    throw InputError("/edges", std::to_string(edges.size()) + " edges are not accepted; give at most " +
                                   std::to_string(max_cppn_edges));
  const Numbers numbers(network);
  std::pair<std::size_t, std::size_t> previous{0, 0};
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (const std::uint32_t end : {edges[i].from, edges[i].to})
      if (numbers.of(end) == SIZE_MAX) refuse("edges", i, "there is no node " + std::to_string(end));
    if (*place_of(network, edges[i].from) >= *place_of(network, edges[i].to))
      refuse("edges", i, "must lead from a lower to a higher place");
    if (!(std::abs(edges[i].weight) <= max_cppn_weight))
      refuse("edges", i, "the weight must be a number from -1000 to 1000");
    const std::pair now(numbers.of(edges[i].to), numbers.of(edges[i].from));
    if (i > 0 && previous >= now) refuse("edges", i, "edges must be in the order of their ends, each once");
    previous = now;
  }
}

}  // namespace

double value_of(CppnFunction function, double x) {
  switch (function) {
    case CppnFunction::linear:
      return x;
    case CppnFunction::sine:
      return wave(x / 2).sine;
    case CppnFunction::cosine:
      return wave(x / 2).cosine;
    case CppnFunction::gaussian:
      return portable_exp(-4 * x * x);
    case CppnFunction::sigmoid: {
      const double falling = portable_exp(-5 * std::abs(x)), value = (1 - falling) / (1 + falling);
      return x < 0 ? -value : value;
    }
    case CppnFunction::absolute:
      return std::abs(x);
    case CppnFunction::square:
      return x * x;
    case CppnFunction::root:
      return x < 0 ? -std::sqrt(-x) : std::sqrt(x);
  }
  return x;
}

void validate(const Cppn& network) {
  if (network.outputs != cppn_phase_outputs && network.outputs != cppn_outputs)
    throw InputError("/outputs", std::to_string(network.outputs) + " is not accepted; give 4 or 6");
  validate_nodes(network.nodes);
  validate_edges(network);
}

CppnEvaluator::CppnEvaluator(const Cppn& network) : outputs_(network.outputs) {
  const Numbers numbers(network);
  for (const CppnNode& node : network.nodes) nodes_.push_back({node.function, 0});
  nodes_.resize(nodes_.size() + outputs_, {CppnFunction::linear, 0});
  for (const CppnEdge& edge : network.edges) {
    edges_.push_back({numbers.of(edge.from), static_cast<double>(edge.weight)});
    ++nodes_[numbers.of(edge.to) - cppn_inputs].edges;
  }
  values_.resize(cppn_inputs + nodes_.size());
  values_[bias_input].fill(1);
}

// Node by node for all points of the group, so that the sums run in vector registers. Each sum has the order of the
// edges, whatever the width of these.
void CppnEvaluator::operator()(std::span<const Point> points, std::span<Outputs> outputs) {
  const std::size_t count = points.size();
  for (std::size_t input = 0; input < bias_input; ++input)
    for (std::size_t i = 0; i < count; ++i) values_[input][i] = points[i][input];
  auto edge = edges_.begin();
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    std::array<double, group>& sums = values_[cppn_inputs + node];
    sums.fill(0);
    for (std::size_t end = 0; end < nodes_[node].edges; ++end, ++edge) {
      const std::array<double, group>& from = values_[edge->from];
      for (std::size_t i = 0; i < group; ++i) sums[i] += edge->weight * from[i];
    }
    for (std::size_t i = 0; i < count; ++i)
      sums[i] = kept_in_range(value_of(nodes_[node].function, kept_in_range(sums[i])));
  }
  for (std::size_t output = 0; output < outputs_; ++output)
    for (std::size_t i = 0; i < count; ++i) outputs[i][output] = values_[values_.size() - outputs_ + output][i];
}

std::array<double, cppn_outputs> evaluate(const Cppn& network, const std::array<double, cppn_inputs - 1>& point) {
  validate(network);
  CppnEvaluator evaluator(network);
  CppnEvaluator::Outputs outputs{};
  evaluator({&point, 1}, {&outputs, 1});
  return outputs;
}

namespace {

using Key = std::pair<std::uint32_t, std::uint32_t>;  // place and id, by which nodes are ordered

// Places by id.
class Places {
 public:
  explicit Places(const Cppn& network) : outputs_(network.outputs) {
    for (const CppnNode& node : network.nodes) hidden_.emplace(node.id, node.place);
  }
  std::optional<std::uint32_t> of(std::uint32_t id) const {
    if (is_input(id)) return 0;
    if (!is_hidden(id)) return output_of(id) < outputs_ ? std::optional(output_place) : std::nullopt;
    const auto found = hidden_.find(id);
    return found == hidden_.end() ? std::nullopt : std::optional(found->second);
  }
  Key key(std::uint32_t id) const { return {of(id).value_or(0), id}; }
  bool leads_upward(const CppnEdge& edge) const {
    const auto from = of(edge.from), to = of(edge.to);
    return from && to && *from < *to;
  }

 private:
  std::uint32_t outputs_;
  std::unordered_map<std::uint32_t, std::uint32_t> hidden_;
};

void sort_edges(Cppn& network) {
  const Places places(network);
  std::ranges::sort(network.edges, {},
                    [&](const CppnEdge& edge) { return std::pair(places.key(edge.to), places.key(edge.from)); });
}

CppnEdge* find_edge(Cppn& network, std::uint32_t from, std::uint32_t to) {
  const auto found =
      std::ranges::find_if(network.edges, [&](const CppnEdge& edge) { return edge.from == from && edge.to == to; });
  return found == network.edges.end() ? nullptr : &*found;
}

// The same for the same ends in every network, unless the network has such a node.
std::uint32_t new_id(const Cppn& network, const CppnEdge& split) {
  for (std::uint64_t attempt = 0;; ++attempt) {
    const auto id = static_cast<std::uint32_t>(seed_of(std::uint64_t{split.from} << 32 | split.to, attempt));
    if (is_hidden(id) && !place_of(network, id)) return id;
  }
}

}  // namespace

std::optional<std::uint32_t> place_of(const Cppn& network, std::uint32_t id) {
  if (is_input(id)) return 0;
  if (!is_hidden(id)) return output_of(id) < network.outputs ? std::optional(output_place) : std::nullopt;
  const auto found = std::ranges::find(network.nodes, id, &CppnNode::id);
  return found == network.nodes.end() ? std::nullopt : std::optional(found->place);
}

void restore_order(Cppn& network) {
  std::ranges::sort(network.nodes, {}, [](const CppnNode& node) { return Key(node.place, node.id); });
  const Places places(network);
  std::erase_if(network.edges, [&](const CppnEdge& edge) { return !places.leads_upward(edge); });
  sort_edges(network);
}

void prune(Cppn& network) {
  while (true) {
    std::set<std::uint32_t> entered, left;
    for (const CppnEdge& edge : network.edges) {
      left.insert(edge.from);
      entered.insert(edge.to);
    }
    const auto dropped = std::erase_if(
        network.nodes, [&](const CppnNode& node) { return !entered.contains(node.id) || !left.contains(node.id); });
    if (dropped == 0) return;
    restore_order(network);
  }
}

float& weight_of(Cppn& network, std::uint32_t from, std::uint32_t to) {
  if (CppnEdge* edge = find_edge(network, from, to)) return edge->weight;
  network.edges.push_back({from, to, 0});
  sort_edges(network);
  return find_edge(network, from, to)->weight;
}

bool split_edge(Cppn& network, std::size_t edge, const NewNode& node) {
  const CppnEdge split = network.edges[edge];
  const std::uint32_t low = *place_of(network, split.from), high = *place_of(network, split.to);
  if (high - low < 2 || network.nodes.size() >= max_cppn_nodes || network.edges.size() + 2 > max_cppn_edges)
    return false;
  const CppnNode added{new_id(network, split), low + (high - low) / 2, node.function};
  network.nodes.push_back(added);
  network.edges.push_back({split.from, added.id, node.weight_in});
  network.edges.push_back({added.id, split.to, node.weight_out});
  restore_order(network);
  return true;
}

bool add_random_edge(Cppn& network, float weight, Random& random) {
  if (network.edges.size() >= max_cppn_edges) return false;
  const std::size_t hidden = network.nodes.size();
  // Inputs and hidden nodes, or hidden nodes and outputs.
  const auto draw = [&](std::uint32_t others, auto id_of_other) {
    const auto chosen = static_cast<std::size_t>(random.below(hidden + others));
    return chosen < hidden ? network.nodes[chosen].id : id_of_other(static_cast<std::uint32_t>(chosen - hidden));
  };
  constexpr int tries = 20;
  for (int i = 0; i < tries; ++i) {
    const std::uint32_t from = draw(cppn_inputs, [](std::uint32_t input) { return input; });
    const std::uint32_t to = draw(network.outputs, id_of);
    if (*place_of(network, from) >= *place_of(network, to) || find_edge(network, from, to)) continue;
    weight_of(network, from, to) = weight;
    return true;
  }
  return false;
}

CppnFunction random_function(Random& random) {
  return static_cast<CppnFunction>(random.below(cppn_function_names.size()));
}

}  // namespace mercury
