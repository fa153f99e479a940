// SPDX-License-Identifier: Apache-2.0
#include "evolution/genomes/growing_brain.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "mercury/error.h"
#include "mercury/random.h"
#include "robots/mutation_step.h"

namespace mercury {
namespace {

constexpr StepRange steps{GrowingBrain::smallest_step, GrowingBrain::largest_step};

constexpr double toggle_rate = 0.01;              // of mutations that turn a connection off or on
constexpr double stays_off = 0.75;                // the paper's chance that a gene is off if it is in a parent
constexpr double weight_share_of_distance = 0.4;  // the paper's c3
constexpr double replacement_rate = 0.5;          // of moves after which a number is drawn again
constexpr int tries_to_connect = 64;

enum Kind : std::uint64_t { of_sense = 1, of_neuron, of_split, of_connection };

// A sense or a neuron of a genome.
struct Node {
  Marking marking;
  double depth = 0;       // 0 = a sense
  bool is_frame = false;  // after those of the same depth that grew

  // Whether it acts on the other one within one thought.
  bool is_before(const Node& other) const {
    return depth != other.depth ? depth < other.depth : !is_frame && other.is_frame;
  }
};

// Senses, then the frame's neurons, then those that grew.
std::vector<Node> nodes_of(const BrainFrame& frame, const GrowingBrain& genes) {
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < frame.senses(); ++i) nodes.push_back({frame.sense(i)});
  for (std::size_t i = 0; i < frame.neurons(); ++i) nodes.push_back({frame.neuron(i), frame.depth(i), true});
  for (const NeuronGene& neuron : genes.neurons) nodes.push_back({neuron.marking, neuron.depth});
  return nodes;
}

// Genes are in the order of their markings.
template <class Gene>
bool contains(const std::vector<Gene>& genes, Marking marking) {
  return std::ranges::binary_search(genes, marking, {}, &Gene::marking);
}
template <class Gene>
void insert(std::vector<Gene>& genes, const Gene& gene) {
  genes.insert(std::ranges::lower_bound(genes, gene.marking, {}, &Gene::marking), gene);
}

// Calls visit(gene or null, gene or null) for each marking that a or b has, in their order.
template <class Gene, class Visit>
void for_each_pair(const std::vector<Gene>& a, const std::vector<Gene>& b, const Visit& visit) {
  auto p = a.begin(), q = b.begin();
  while (p != a.end() || q != b.end()) {
    const bool has_p = p != a.end() && (q == b.end() || p->marking <= q->marking);
    const bool has_q = q != b.end() && (p == a.end() || q->marking <= p->marking);
    visit(has_p ? &*p : nullptr, has_q ? &*q : nullptr);
    p += has_p;
    q += has_q;
  }
}

float normal_weight(Random& random) { return static_cast<float>(random.normal()); }

std::size_t size_of(const BrainFrame& frame, const std::string& from) {
  if (from == "senses") return frame.senses();
  return std::ranges::find(frame.brain().layers, from, &NeuronLayer::name)->neurons;
}

bool split(GrowingBrain& genes, const std::vector<Node>& nodes, Random& random) {
  std::vector<std::size_t> enabled;
  for (std::size_t i = 0; i < genes.connections.size(); ++i)
    if (genes.connections[i].enabled) enabled.push_back(i);
  if (enabled.empty() || genes.neurons.size() >= GrowingBrain::most_grown) return false;
  ConnectionGene& old = genes.connections[enabled[random.below(enabled.size())]];
  old.enabled = false;
  const auto depth = [&](Marking marking) { return std::ranges::find(nodes, marking, &Node::marking)->depth; };
  NeuronGene neuron{.depth = (depth(old.from) + depth(old.to)) / 2};
  std::uint64_t times = 0;
  do neuron.marking = split_marking(old.from, old.to, times++);
  while (contains(genes.neurons, neuron.marking));
  const ConnectionGene first(old.from, neuron.marking, 1), second(neuron.marking, old.to, old.weight);
  insert(genes.neurons, neuron);
  insert(genes.connections, first);
  insert(genes.connections, second);
  return true;
}

bool connect(GrowingBrain& genes, const std::vector<Node>& nodes, std::size_t senses, double recurrence,
             Random& random) {
  const bool forward = !random.chance(recurrence);
  for (int attempt = 0; attempt < tries_to_connect; ++attempt) {
    const Node& from = nodes[random.below(nodes.size())];
    const Node& to = nodes[senses + random.below(nodes.size() - senses)];
    if (from.is_before(to) != forward || contains(genes.connections, connection_marking(from.marking, to.marking)))
      continue;
    insert(genes.connections, ConnectionGene(from.marking, to.marking, normal_weight(random)));
    return true;
  }
  return false;
}

bool toggle(GrowingBrain& genes, Random& random) {
  if (genes.connections.empty()) return false;
  ConnectionGene& connection = genes.connections[random.below(genes.connections.size())];
  connection.enabled = !connection.enabled;
  return true;
}

void move(GrowingBrain& genes, double strength, Random& random) {
  const std::size_t numbers = genes.biases.size() + genes.neurons.size() + genes.connections.size();
  genes.step = adapted_step(genes.step, numbers, steps, random);
  const std::size_t replaced = random.chance(replacement_rate) ? random.below(numbers) : numbers;
  std::size_t number = 0;
  const auto change = [&](float& weight) {
    weight = number++ == replaced
                 ? normal_weight(random)
                 : BrainGenes::limited_weight(static_cast<double>(weight) + strength * genes.step * random.normal());
  };
  for (float& bias : genes.biases) change(bias);
  for (NeuronGene& neuron : genes.neurons) change(neuron.bias);
  for (ConnectionGene& connection : genes.connections) change(connection.weight);
}

}  // namespace

Marking sense_marking(std::size_t sense) { return seed_of(of_sense, sense); }
Marking neuron_marking(std::size_t layer, std::size_t neuron) { return seed_of(seed_of(of_neuron, layer), neuron); }
Marking split_marking(Marking from, Marking to, std::uint64_t times_before) {
  return seed_of(seed_of(seed_of(of_split, from), to), times_before);
}
Marking connection_marking(Marking from, Marking to) { return seed_of(seed_of(of_connection, from), to); }

BrainFrame::BrainFrame(const Robot& robot) : sensors_(robot.sensors), brain_(*robot.brain) {
  constexpr std::size_t most_layers = max_inputs - 1 - GrowingBrain::most_grown;
  if (brain_.layers.size() > most_layers)
    throw InputError("/brain/layers", std::to_string(brain_.layers.size()) + " layers; brains that grow have at most " +
                                          std::to_string(most_layers) + " at first");
  for (const Sensor& sensor : sensors_) senses_ += description_of(sensor.kind).width;
  for (std::size_t i = 0; i < senses_; ++i) sense_markings_.push_back(sense_marking(i));
  for (std::size_t i = 0; i < brain_.layers.size(); ++i) {
    NeuronLayer& layer = brain_.layers[i];
    for (NeuronInput& input : layer.inputs) {
      if (input.rate > 0)
        throw InputError("/brain/layers/" + std::to_string(i),
                         "learns while the robot lives, which brains that grow do not");
      input.weights.clear();
      input.edges.clear();
    }
    std::ranges::fill(layer.bias, 0.f);
    const double depth = static_cast<double>(i + 1) / static_cast<double>(brain_.layers.size());
    for (std::size_t k = 0; k < layer.neurons; ++k) neurons_.push_back({neuron_marking(i, k), depth});
  }
}

GrowingBrain GrowingBrain::of(const BrainFrame& frame, const Brain& brain) {
  GrowingBrain genes;
  std::map<Marking, ConnectionGene> connections;
  for (std::size_t i = 0; i < brain.layers.size(); ++i) {
    const NeuronLayer& layer = brain.layers[i];
    for (std::size_t k = 0; k < layer.neurons; ++k) genes.biases.push_back(layer.bias.empty() ? 0 : layer.bias[k]);
    for (const NeuronInput& input : layer.inputs) {
      const bool of_senses = input.from == "senses";
      const auto source = std::ranges::find(brain.layers, input.from, &NeuronLayer::name) - brain.layers.begin();
      const auto connect = [&](std::size_t to, std::size_t from, float weight) {
        const ConnectionGene gene(
            of_senses ? sense_marking(from) : neuron_marking(static_cast<std::size_t>(source), from),
            neuron_marking(i, to), weight);
        const auto [at, is_new] = connections.emplace(gene.marking, gene);
        if (!is_new)
          at->second.weight =
              BrainGenes::limited_weight(static_cast<double>(at->second.weight) + static_cast<double>(weight));
      };
      const std::size_t width = size_of(frame, input.from);
      for (std::size_t k = 0; k < input.weights.size(); ++k) connect(k / width, k % width, input.weights[k]);
      for (const NeuronEdge& edge : input.edges) connect(edge.to, edge.from, edge.weight);
    }
  }
  for (const auto& [marking, connection] : connections) genes.connections.push_back(connection);
  return genes;
}

GrowingBrain GrowingBrain::minimal(const BrainFrame& frame, const BrainGrowth& growth, std::uint64_t seed) {
  Random random(seed);
  GrowingBrain genes{.biases = std::vector<float>(frame.neurons())};
  const std::size_t last = frame.neurons() - frame.brain().layers.back().neurons;
  for (std::size_t neuron = last; neuron < frame.neurons(); ++neuron) {
    genes.biases[neuron] = normal_weight(random);
    const std::size_t always = frame.senses() > 0 ? random.below(frame.senses()) : 0;
    for (std::size_t sense = 0; sense < frame.senses(); ++sense)
      if (random.chance(growth.first_connections) || sense == always)
        insert(genes.connections, ConnectionGene(frame.sense(sense), frame.neuron(neuron), normal_weight(random)));
  }
  const auto numbers = static_cast<double>(genes.biases.size() + genes.connections.size());
  genes.step = first_length / std::sqrt(std::max(1.0, numbers));
  return genes;
}

GrowingBrain GrowingBrain::mutated(const BrainFrame& frame, const BrainGrowth& growth, double strength,
                                   std::uint64_t seed) const {
  Random random(seed);
  GrowingBrain child = *this;
  const double choice = random.uniform();
  const double neuron = strength * growth.new_neurons, connection = neuron + strength * growth.new_connections;
  const std::vector<Node> nodes = nodes_of(frame, child);
  if (choice < neuron       ? split(child, nodes, random)
      : choice < connection ? connect(child, nodes, frame.senses(), growth.recurrence, random)
                            : choice < connection + strength * toggle_rate && toggle(child, random))
    return child;
  move(child, strength, random);
  return child;
}

GrowingBrain GrowingBrain::crossed(const GrowingBrain& other, std::partial_ordering fitness, std::uint64_t seed) const {
  Random random(seed);
  const GrowingBrain& first = fitness == std::partial_ordering::less ? other : *this;
  const GrowingBrain& second = &first == this ? other : *this;
  const bool one_is_fitter = fitness == std::partial_ordering::less || fitness == std::partial_ordering::greater;
  const double of_first = one_is_fitter ? 1 : 0.5, of_second = one_is_fitter ? 0 : 0.5;
  GrowingBrain child{.step = crossed_step(step, other.step, steps)};
  for (std::size_t i = 0; i < first.biases.size(); ++i)
    child.biases.push_back(random.chance(0.5) ? first.biases[i] : second.biases[i]);

  std::set<Marking> needed;  // neurons of the child's connections
  for_each_pair(first.connections, second.connections, [&](const ConnectionGene* a, const ConnectionGene* b) {
    if (!(a && b) && !random.chance(a ? of_first : of_second)) return;
    ConnectionGene gene = !b || (a && random.chance(0.5)) ? *a : *b;
    const bool may_be_off = (a && !a->enabled) || (b && !b->enabled);
    gene.enabled = !(may_be_off && random.chance(stays_off));
    child.connections.push_back(gene);
    needed.insert({gene.from, gene.to});
  });
  for_each_pair(first.neurons, second.neurons, [&](const NeuronGene* a, const NeuronGene* b) {
    const NeuronGene& gene = !b || (a && random.chance(0.5)) ? *a : *b;
    if (needed.contains(gene.marking)) child.neurons.push_back(gene);
  });
  return child.neurons.size() > most_grown ? first : child;
}

double GrowingBrain::distance(const GrowingBrain& other) const {
  double sum = 0;
  std::size_t alone = 0, both = 0;
  const auto compare = [&](float a, float b) {
    sum += std::abs(static_cast<double>(a) - static_cast<double>(b));
    ++both;
  };
  for (std::size_t i = 0; i < biases.size(); ++i) compare(biases[i], other.biases[i]);
  for_each_pair(neurons, other.neurons, [&](const NeuronGene* a, const NeuronGene* b) {
    if (a && b) compare(a->bias, b->bias);
  });
  for_each_pair(connections, other.connections, [&](const ConnectionGene* a, const ConnectionGene* b) {
    if (a && b)
      compare(a->weight, b->weight);
    else
      ++alone;
  });
  return static_cast<double>(alone) + weight_share_of_distance * sum / static_cast<double>(both);
}

namespace {

// Neurons that grew and from which connections that are turned on lead to the frame, and the frame itself.
std::set<Marking> active_neurons(const BrainFrame& frame, const GrowingBrain& genes) {
  std::multimap<Marking, Marking> sources;
  for (const ConnectionGene& connection : genes.connections)
    if (connection.enabled) sources.emplace(connection.to, connection.from);
  std::set<Marking> active;
  std::vector<Marking> open;
  const auto reach = [&](Marking marking) {
    if (active.insert(marking).second) open.push_back(marking);
  };
  for (std::size_t i = 0; i < frame.neurons(); ++i) reach(frame.neuron(i));
  while (!open.empty()) {
    const auto [begin, end] = sources.equal_range(open.back());
    open.pop_back();
    for (auto source = begin; source != end; ++source) reach(source->second);
  }
  return active;
}

// Where a node stands in a brain: its vector, 0 = the senses, i + 1 = layer i, and its index there.
struct Place {
  std::size_t vector = 0;
  std::uint32_t index = 0;
};

// The name that the first layer of neurons that grew would have, without its number.
std::string name_of_grown_layers(const Brain& frame) {
  std::string name = "grown ";
  const auto is_taken = [&](const NeuronLayer& layer) { return layer.name.starts_with(name); };
  while (std::ranges::any_of(frame.layers, is_taken)) name = "re" + name;
  return name;
}

// Puts neurons into layers and connections into their inputs.
class BrainBuilder {
 public:
  BrainBuilder(const BrainFrame& frame, const GrowingBrain& genes) : frame_(frame), genes_(genes) {
    const std::set<Marking> active = active_neurons(frame, genes);
    brain_ = frame.brain();
    brain_.layers.clear();
    for (std::size_t i = 0; i < frame.senses(); ++i) places_[frame.sense(i)] = {0, static_cast<std::uint32_t>(i)};
    std::map<double, std::vector<const NeuronGene*>> grown;
    for (const NeuronGene& neuron : genes.neurons)
      if (active.contains(neuron.marking)) grown[neuron.depth].push_back(&neuron);
    std::size_t first = 0;
    const std::string name = name_of_grown_layers(frame.brain());
    std::size_t number = 0;
    auto next = grown.begin();
    for (const NeuronLayer& layer : frame.brain().layers) {
      for (; next != grown.end() && next->first <= frame.depth(first); ++next)
        add_grown(name + std::to_string(++number), next->second);
      add_frame(layer, first);
      first += layer.neurons;
    }
  }

  Brain build() {
    std::map<std::pair<std::size_t, std::size_t>, std::vector<NeuronEdge>> edges;  // by layer and source
    for (const ConnectionGene& connection : genes_.connections) {
      const auto from = places_.find(connection.from), to = places_.find(connection.to);
      if (!connection.enabled || from == places_.end() || to == places_.end()) continue;
      edges[{to->second.vector - 1, from->second.vector}].push_back(
          {to->second.index, from->second.index, connection.weight});
    }
    for (NeuronLayer& layer : brain_.layers) {  // the frame's inputs stay where they were
      std::vector<NeuronInput> kept;
      for (const NeuronInput& input : layer.inputs)
        if (std::ranges::find(kept, input.from, &NeuronInput::from) == kept.end()) kept.push_back(input);
      layer.inputs = std::move(kept);
    }
    for (auto& [between, list] : edges) add_input(brain_.layers[between.first], between.second, std::move(list));
    for (NeuronLayer& layer : brain_.layers)
      std::erase_if(layer.inputs, [](const NeuronInput& in) { return in.weights.empty() && in.edges.empty(); });
    return std::move(brain_);
  }

 private:
  void add_grown(const std::string& name, const std::vector<const NeuronGene*>& neurons) {
    NeuronLayer& layer = brain_.layers.emplace_back();
    layer.name = name;
    for (const NeuronGene* neuron : neurons) {
      places_[neuron->marking] = {brain_.layers.size(), layer.neurons++};
      layer.bias.push_back(neuron->bias);
    }
  }
  void add_frame(const NeuronLayer& given, std::size_t first) {
    NeuronLayer& layer = brain_.layers.emplace_back(given);
    const std::vector<float> biases(genes_.biases.begin() + static_cast<std::ptrdiff_t>(first),
                                    genes_.biases.begin() + static_cast<std::ptrdiff_t>(first + given.neurons));
    if (!given.bias.empty() || std::ranges::any_of(biases, [](float bias) { return bias != 0; })) layer.bias = biases;
    for (std::uint32_t i = 0; i < given.neurons; ++i) places_[frame_.neuron(first + i)] = {brain_.layers.size(), i};
  }

  // A matrix if all is joined to all, as in a brain that has not grown.
  void add_input(NeuronLayer& layer, std::size_t source, std::vector<NeuronEdge> edges) {
    const std::string from = source == 0 ? "senses" : brain_.layers[source - 1].name;
    const std::size_t width = source == 0 ? frame_.senses() : brain_.layers[source - 1].neurons;
    auto input = std::ranges::find(layer.inputs, from, &NeuronInput::from);
    if (input == layer.inputs.end()) {
      layer.inputs.emplace_back().from = from;
      input = layer.inputs.end() - 1;
    }
    std::ranges::sort(edges, {}, [](const NeuronEdge& edge) { return std::pair(edge.to, edge.from); });
    if (edges.size() == layer.neurons * width)
      for (const NeuronEdge& edge : edges) input->weights.push_back(edge.weight);
    else
      input->edges = std::move(edges);
  }

  const BrainFrame& frame_;
  const GrowingBrain& genes_;
  Brain brain_;
  std::unordered_map<Marking, Place> places_;
};

}  // namespace

Brain GrowingBrain::grown(const BrainFrame& frame) const { return BrainBuilder(frame, *this).build(); }

// Connections name their ends by their places: senses, the frame's neurons, those that grew.
void GrowingBrain::write(ByteWriter& writer, const BrainFrame& frame) const {
  writer.add(step);
  writer.numbers(biases);
  writer.count(neurons.size());
  for (const NeuronGene& neuron : neurons) {
    writer.add(neuron.marking);
    writer.add(neuron.depth);
    writer.add(neuron.bias);
  }
  std::unordered_map<Marking, std::uint16_t> places;
  for (const Node& node : nodes_of(frame, *this))
    places.emplace(node.marking, static_cast<std::uint16_t>(places.size()));
  writer.count(connections.size());
  for (const ConnectionGene& connection : connections) {
    writer.add(places.at(connection.from));
    writer.add(places.at(connection.to));
    writer.add(connection.weight);
    writer.add(static_cast<std::uint8_t>(connection.enabled));
  }
}

GrowingBrain GrowingBrain::read(ByteReader& reader, const BrainFrame& frame) {
  const auto require = [](bool holds, const char* problem) {
    if (!holds) throw InputError("genome", problem);
  };
  GrowingBrain genes;
  genes.step = reader.read<double>();
  require(genes.step >= smallest_step && genes.step <= largest_step, "the step of its brain's weights is out of range");
  genes.biases = reader.numbers<float>();
  require(genes.biases.size() == frame.neurons(), "its brain has another number of neurons than the run's");
  require(std::ranges::all_of(genes.biases, [](float bias) { return std::isfinite(bias); }),
          "a bias of its brain is not finite");
  const std::size_t grown = reader.count(sizeof(Marking) + sizeof(double) + sizeof(float));
  require(grown <= most_grown, "its brain has too many neurons");
  for (std::size_t i = 0; i < grown; ++i) {
    NeuronGene& neuron = genes.neurons.emplace_back();
    neuron.marking = reader.read<Marking>();
    neuron.depth = reader.read<double>();
    neuron.bias = reader.read<float>();
    require(neuron.depth > 0 && neuron.depth <= 1, "the depth of a neuron is out of range");
    require(std::isfinite(neuron.bias), "a bias of its brain is not finite");
  }
  const auto in_order = [](const auto& list) {
    return std::ranges::adjacent_find(list, [](const auto& a, const auto& b) { return a.marking >= b.marking; }) ==
           list.end();
  };
  require(in_order(genes.neurons), "its neurons are not in the order of their markings");
  const std::vector<Node> nodes = nodes_of(frame, genes);
  std::set<Marking> markings;
  for (const Node& node : nodes) require(markings.insert(node.marking).second, "two neurons have one marking");
  const std::size_t connections = reader.count(2 * sizeof(std::uint16_t) + sizeof(float) + 1);
  for (std::size_t i = 0; i < connections; ++i) {
    const std::size_t from = reader.read<std::uint16_t>(), to = reader.read<std::uint16_t>();
    const auto weight = reader.read<float>();
    const auto enabled = reader.read<std::uint8_t>();
    require(from < nodes.size() && to >= frame.senses() && to < nodes.size(), "a connection is between no neurons");
    require(std::isfinite(weight) && enabled <= 1, "a connection is damaged");
    genes.connections.emplace_back(nodes[from].marking, nodes[to].marking, weight, enabled == 1);
  }
  require(in_order(genes.connections), "its connections are not in the order of their markings");
  return genes;
}

}  // namespace mercury
