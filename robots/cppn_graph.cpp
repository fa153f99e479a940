// SPDX-License-Identifier: Apache-2.0
#include "robots/cppn_graph.h"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

namespace mercury {
namespace {

using Key = std::pair<std::uint32_t, std::uint32_t>;  // place and id, by which nodes are ordered

// Places by id.
class Places {
 public:
  explicit Places(const Cppn& network) {
    for (const CppnNode& node : network.nodes) hidden_.emplace(node.id, node.place);
  }
  std::optional<std::uint32_t> of(std::uint32_t id) const {
    if (is_input(id)) return 0;
    if (!is_hidden(id)) return output_place;
    const auto found = hidden_.find(id);
    return found == hidden_.end() ? std::nullopt : std::optional(found->second);
  }
  Key key(std::uint32_t id) const { return {of(id).value_or(0), id}; }
  bool leads_upwards(const CppnEdge& edge) const {
    const auto from = of(edge.from), to = of(edge.to);
    return from && to && *from < *to;
  }

 private:
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
  if (!is_hidden(id)) return output_place;
  const auto found = std::ranges::find(network.nodes, id, &CppnNode::id);
  return found == network.nodes.end() ? std::nullopt : std::optional(found->place);
}

void restore_order(Cppn& network) {
  std::ranges::sort(network.nodes, {}, [](const CppnNode& node) { return Key(node.place, node.id); });
  const Places places(network);
  std::erase_if(network.edges, [&](const CppnEdge& edge) { return !places.leads_upwards(edge); });
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
  const auto draw = [&](std::uint32_t others, std::uint32_t first) {
    const auto chosen = static_cast<std::size_t>(random.below(hidden + others));
    return chosen < hidden ? network.nodes[chosen].id : first + static_cast<std::uint32_t>(chosen - hidden);
  };
  constexpr int tries = 20;
  for (int i = 0; i < tries; ++i) {
    const std::uint32_t from = draw(cppn_inputs, 0), to = draw(cppn_outputs, cppn_inputs);
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
