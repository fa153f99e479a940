// SPDX-License-Identifier: Apache-2.0
// Random genomes of network robots: the layers of the network, from features of a body (nn_features.h) to materials.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mercury/nn_robot.h"
#include "mercury/random.h"
#include "robots/nn/nn_features.h"

namespace mercury {
namespace {

struct Plan {
  Vector proportions;  // of the trunk, the longest 1
  std::uint64_t limbs, arms, bends;
  bool cup;
};

Plan random_plan(bool mirrored, Random& random) {
  Plan plan{};
  for (double& p : plan.proportions) p = random.uniform(0.4, 1);
  const double longest = *std::max_element(plan.proportions.begin(), plan.proportions.end());
  plan.proportions = 1 / longest * plan.proportions;
  if (random.chance(0.15))
    plan.arms = 3 + random.below(4);
  else
    plan.limbs = random.below(mirrored ? 4 : 6);
  plan.bends = random.below(3);
  plan.cup = random.chance(0.2);
  return plan;
}

// The hidden layers. `readout` turns the activations of the last of them into a place.
class Trunk {
 public:
  static constexpr std::size_t carried = min_hidden_width;  // neurons that carry a place: max(0, x), max(0, -x), ...

  std::vector<Layer> layers;
  std::vector<Vector> readout = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // place = sum of activation times readout
  std::vector<std::size_t> twins = {0, 1, 2};                       // of each neuron, mirrored in y

  // Places leave the layer as proportions * place, moved by the features.
  void add(const Features& features, std::size_t width, const Vector& proportions) {
    Layer layer{static_cast<int>(readout.size()), static_cast<int>(width), {}, {}};
    std::vector<Vector> next;
    twins.clear();
    const auto add_neuron = [&](const Feature& f) {
      for (const Vector& r : readout) layer.weights.push_back(static_cast<float>(dot(f.along, r)));
      layer.biases.push_back(static_cast<float>(-f.threshold));
      next.push_back(f.move);
      twins.push_back(f.twin);
    };
    for (std::size_t i = 0; i < carried; ++i) {
      Vector axis{};
      axis[i / 2] = i % 2 ? -1 : 1;
      add_neuron({axis, 0, proportions * axis, i / 2 == 1 ? i ^ 1 : i});
    }
    for (Feature f : features.list()) {
      f.twin += carried;
      add_neuron(f);
    }
    while (next.size() < width) add_neuron({{}, 0, {}, next.size()});  // features of a mirrored body come in pairs
    layers.push_back(std::move(layer));
    readout = std::move(next);
  }
};

Trunk random_trunk(const std::vector<int>& hidden, bool mirrored, Random& random) {
  Trunk trunk;
  for (std::size_t l = 0; l < hidden.size(); ++l) {
    const auto width = static_cast<std::size_t>(hidden[l]);
    Features features(width - Trunk::carried, mirrored);
    Vector proportions = {1, 1, 1};
    const bool first = l == 0, last = l + 1 == hidden.size();
    const Plan plan = last ? random_plan(mirrored, random) : Plan{};
    if (last) proportions = (plan.limbs + plan.arms > 0 ? random.uniform(0.5, 0.8) : 1) * plan.proportions;
    if (first) gather(features, proportions);
    if (last) {
      add_limbs(features, plan.limbs, random);
      if (plan.arms > 0 && width >= Trunk::carried + plan.arms) add_arms(features, plan.arms, random);
      add_bends(features, plan.bends, plan.proportions, random);
      if (plan.cup) add_cup(features, mirrored ? Vector{0, 0, 1} : direction(random), random);
    }
    fill_with_small_features(features, random);
    trunk.add(features, width, proportions);
  }
  return trunk;
}

// Mean and root mean square of the last layer's activations over a sample of the cloud.
struct Activity {
  std::vector<double> means;
  double size = 1;
};

Activity activity_of(const Trunk& trunk) {
  constexpr std::size_t points = 256;
  static const std::vector<float> cloud = [] {
    std::vector<float> normal(3 * points);
    Random random(1);
    for (float& x : normal) x = static_cast<float>(random.normal());
    return normal;
  }();
  const std::vector<float> sample = trunk.layers.empty() ? cloud : evaluate(std::span(trunk.layers), cloud);
  const std::size_t width = sample.size() / points;
  Activity activity{std::vector<double>(width, 0.), 0};
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const double x = trunk.layers.empty() ? sample[i] : std::max(0.f, sample[i]);
    activity.means[i % width] += x / points;
    activity.size += x * x / static_cast<double>(sample.size());
  }
  activity.size = std::sqrt(activity.size);
  return activity;
}

// The materials that a robot is likely to have: muscles of one frequency and two to four phases, so that they work
// together; often tissue or bone; sometimes a muscle of any frequency.
std::array<bool, base_material_count> random_palette(Random& random) {
  std::array<bool, base_material_count> chosen{};
  const std::size_t frequency = random.below(muscle_count / 4), left_out = random.below(4);
  for (std::size_t phase = 0; phase < 4; ++phase) chosen[4 * frequency + phase] = true;
  if (random.chance(0.5)) chosen[4 * frequency + left_out] = false;
  if (random.chance(0.3)) chosen[4 * frequency + (left_out + 1 + random.below(3)) % 4] = false;
  if (random.chance(0.6)) chosen[tissue - 1] = true;
  if (random.chance(0.4)) chosen[bone - 1] = true;
  if (random.chance(0.3)) chosen[random.below(muscle_count)] = true;
  return chosen;
}

// Reads the place from the trunk. A score is a slope across the body plus some relief, minus a handicap for materials
// outside the palette.
Layer last_layer(const Trunk& trunk, bool mirrored, bool fields, Random& random) {
  const std::size_t inputs = trunk.readout.size();
  Layer layer{static_cast<int>(inputs), fields ? network_field_outputs : network_outputs, {}, {0, 0, 0}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Vector& r : trunk.readout) layer.weights.push_back(static_cast<float>(r[axis]));
  const Activity activity = activity_of(trunk);
  const double relief = 0.7 / (activity.size * std::sqrt(static_cast<double>(inputs)));
  const auto add_row = [&](double bias, double slope, double roughness) {
    std::vector<double> weights(inputs);
    for (double& weight : weights) weight = roughness * relief * random.normal();
    for (std::size_t j = 0; j < std::min(inputs, Trunk::carried); ++j) weights[j] += slope * random.normal();
    for (std::size_t j = 0; j < inputs; ++j) {
      if (mirrored) weights[j] = weights[std::min(j, trunk.twins[j])];
      bias -= weights[j] * activity.means[j];
      layer.weights.push_back(static_cast<float>(weights[j]));
    }
    layer.biases.push_back(static_cast<float>(bias));
  };
  for (const bool chosen : random_palette(random)) {
    const double handicap = chosen ? 0 : 3;
    add_row(0.2 * random.normal() - handicap, 1, 1);
  }
  if (!fields) return layer;
  // Smooth fields: phases run over some part of a turn, the others over a part of their range.
  constexpr std::array<double, 4> slopes{0.8, 1.6, 1.2, 1.2};
  constexpr double roughness = 0.4;
  for (const double slope : slopes) add_row(1.6 * random.normal(), slope, roughness);
  return layer;
}

}  // namespace

NnGenome random_nn_genome(const NnOptions& options, std::uint64_t seed, std::uint64_t index) {
  validate(options);
  Random random(seed_of(seed, index));
  NnGenome genome;
  genome.cloud_seed = random.bits();
  genome.points = options.points;
  genome.alpha = options.alpha;
  genome.spacing = options.spacing;
  genome.environment = options.environment;
  genome.frequencies = options.frequencies;
  genome.frequency = options.frequency;
  genome.mirrored = random.chance(options.mirrored);
  Trunk trunk = random_trunk(options.hidden, genome.mirrored, random);
  Layer last = last_layer(trunk, genome.mirrored, options.muscles == NetworkMuscles::fields, random);
  genome.network.layers = std::move(trunk.layers);
  genome.network.layers.push_back(std::move(last));
  return genome;
}

}  // namespace mercury
