// SPDX-License-Identifier: Apache-2.0
// Changes of a CPPN's graph, and its evaluation at many points. Networks stay valid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mercury/cppn.h"
#include "mercury/generator.h"
#include "mercury/random.h"
#include "robots/muscle_fields.h"

namespace mercury {

enum CppnOutput : std::uint32_t {
  presence_output,
  kind_output,
  phase_output,
  frequency_output,
  amplitude_output,
  stiffness_output
};
inline constexpr std::uint32_t distance_input = 3, bias_input = 4;

constexpr std::uint32_t id_of(std::uint32_t output) {
  return output < cppn_phase_outputs ? cppn_inputs + output : last_hidden_id + 1 + (output - cppn_phase_outputs);
}
constexpr bool is_input(std::uint32_t id) { return id < cppn_inputs; }
constexpr bool is_hidden(std::uint32_t id) { return id >= first_hidden_id && id <= last_hidden_id; }
// Of an id that is neither an input's nor a hidden node's.
constexpr std::uint32_t output_of(std::uint32_t id) {
  return id < first_hidden_id ? id - cppn_inputs : id - last_hidden_id - 1 + cppn_phase_outputs;
}

// The node's place; none if there is no such node.
std::optional<std::uint32_t> place_of(const Cppn& network, std::uint32_t id);

// Puts nodes and edges in order. Edges that do not lead upward, or join nodes that do not exist, are dropped.
void restore_order(Cppn& network);

// Drops hidden nodes that nothing leads into or that lead to no output, and their edges.
void prune(Cppn& network);

// The weight of an edge, which is added if it is missing. The edge must lead upward.
float& weight_of(Cppn& network, std::uint32_t from, std::uint32_t to);

// Puts a new node between the ends of an edge. The edge itself stays. False, without a change, if there is no room.
struct NewNode {
  CppnFunction function = CppnFunction::linear;
  float weight_in = 1, weight_out = 1;
};
bool split_edge(Cppn& network, std::size_t edge, const NewNode& node);

// Adds an edge between two random nodes that none joins yet. False, without a change, if none was found.
bool add_random_edge(Cppn& network, float weight, Random& random);

CppnFunction random_function(Random& random);

// A network prepared for evaluation. Copies what it needs.
class CppnEvaluator {
 public:
  explicit CppnEvaluator(const Cppn& network);  // a valid one

  static constexpr std::size_t group = 64;
  using Point = std::array<double, cppn_inputs - 1>;
  using Outputs = std::array<double, cppn_outputs>;
  // The outputs for up to `group` points.
  void operator()(std::span<const Point> points, std::span<Outputs> outputs);

 private:
  struct Edge {
    std::size_t from;
    double weight;
  };
  struct Node {
    CppnFunction function;
    std::size_t edges;  // into it; they follow those of the previous node
  };
  std::vector<Node> nodes_;  // hidden ones, then outputs
  std::vector<Edge> edges_;
  std::size_t outputs_;
  std::vector<std::array<double, group>> values_;  // of inputs, hidden nodes and outputs
};

// The outputs for all voxels of the genome's grid, x fastest.
std::vector<CppnEvaluator::Outputs> outputs_of(const CppnGenome& genome);

constexpr bool has_fields(const Cppn& network) { return network.outputs == cppn_outputs; }

// The largest connected body of what the network paints.
struct PaintedBody {
  VoxelGrid grid;
  std::vector<FieldValue> values;  // of each cell, with fields
  bool is_empty() const;
  friend bool operator==(const PaintedBody&, const PaintedBody&) = default;
};
PaintedBody painted_body(const CppnGenome& genome);

// Mutation and crossover of painted voxel robots, as the registry of generators has them.

// cppn_genome_of, which must be there. Throws InputError.
CppnGenome cppn_genome_in(const Robot& robot);

Robot mutate_cppn_robot(const Robot& parent, const MutationRequest& request, const std::string& name);
Robot cross_cppn_robots(const Robot& a, const Robot& b, std::uint64_t seed, const std::string& name);

}  // namespace mercury
