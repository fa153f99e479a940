// SPDX-License-Identifier: Apache-2.0
// Initial weights of network robots. Weights drawn from one normal distribution give the same body
// over and over, a lump with spikes: a sum of many small bends is again a normal cloud, and its outliers decide the
// alpha shape. Here a few neurons have a large say, each drawn as a feature of a body: a limb, a bend, a cup. The
// others have little, and are there for evolution. Nothing but + - * / and square roots is used, and no two numbers are
// drawn in one expression whose order is the compiler's choice, so that the weights are the same everywhere.
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <tuple>
#include <utility>

#include "mercury/error.h"
#include "mercury/nn_robot.h"
#include "mercury/random.h"

namespace mercury {
namespace {

using Vector = std::array<double, 3>;

Vector operator*(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
Vector operator*(const Vector& a, const Vector& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator-(const Vector& a) { return {-a[0], -a[1], -a[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector& a) { return 1 / std::sqrt(dot(a, a)) * a; }
Vector mirror(const Vector& a) { return {a[0], -a[1], a[2]}; }

Vector direction(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return unit({x, y, z});
}

Vector direction_across(const Vector& axis, Random& random) {
  const Vector d = direction(random);
  return unit(d + -dot(d, axis) * axis);
}

// A neuron max(0, along . place - threshold); places move by `move` times its value.
struct Feature {
  Vector along{};
  double threshold = 0;
  Vector move{};
  std::size_t twin = 0;  // index of the feature mirrored in y; its own if there is none
};

// The features of a layer, as many as it has neurons for.
class Features {
 public:
  Features(std::size_t room, bool mirrored) : room_(room), mirrored_(mirrored) {}
  const std::vector<Feature>& list() const { return list_; }

  // In a mirrored body the mirrored feature comes with it. False if there is no room.
  bool add(const Vector& along, double threshold, const Vector& move) {
    const std::size_t self = list_.size(), needed = mirrored_ ? 2 : 1;
    if (room_ - self < needed) return false;
    list_.push_back({along, threshold, move, self + needed - 1});
    if (mirrored_) list_.push_back({mirror(along), threshold, mirror(move), self});
    return true;
  }

  void add_alone(const Feature& feature) {
    if (list_.size() < room_) list_.push_back(feature);
  }

 private:
  std::vector<Feature> list_;
  std::size_t room_;
  bool mirrored_;
};

constexpr double ball_radius = 1.7;  // what `gather` leaves of a normal cloud

// Normal points have outliers, of which the alpha shape would make spikes. They are drawn in from twelve sides, the
// corners of an icosahedron, in two steps: what is left is a ball whose skin has many points.
void gather(Features& features, const Vector& proportions) {
  const double golden = (1 + std::sqrt(5.)) / 2;
  for (const auto& [threshold, pull] : {std::pair(1.05, 0.3), std::pair(1.45, 0.15)})
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const double one : {-1., 1.})
        for (const double other : {-golden, golden}) {
          Vector corner{};
          corner[axis] = one;
          corner[(axis + 1) % 3] = other;
          corner = unit(corner);
          const std::size_t self = features.list().size();
          const std::size_t flip_of_y = axis == 0 ? 1 : axis == 1 ? 2 : 0;  // bit of `other` or of `one`
          features.add_alone({corner, threshold, -pull * (proportions * corner), self ^ flip_of_y});
        }
}

// A cap of the ball is pulled out, in a direction of its own.
void add_limbs(Features& features, std::uint64_t count, Random& random) {
  std::vector<Vector> taken;
  const auto crowded = [&](const Vector& d) {
    return std::any_of(taken.begin(), taken.end(), [&](const Vector& t) { return dot(t, d) > 0.6; });
  };
  for (std::uint64_t i = 0; i < count; ++i) {
    Vector along = direction(random);
    for (int attempt = 0; attempt < 20 && crowded(along); ++attempt) along = direction(random);
    taken.push_back(along);
    taken.push_back(mirror(along));
    const double threshold = random.uniform(0.3, 0.9), reach = random.uniform(1.5, 3);
    const Vector move = reach / (ball_radius - threshold) * unit(along + 0.5 * direction(random));
    features.add(along, threshold, move);
  }
}

// Three to six equal limbs around the z axis: a star.
void add_arms(Features& features, std::uint64_t count, Random& random) {
  const double threshold = random.uniform(0.6, 0.9), reach = random.uniform(1.5, 3);
  const double lean = random.uniform(-0.4, 0.4), droop = random.uniform(-0.8, 0.8);
  const double cosine[] = {-0.5, 0, (std::sqrt(5.) - 1) / 4, 0.5};  // of a third, a quarter, a fifth, a sixth of a turn
  const double c = cosine[count - 3], s = std::sqrt(1 - c * c);
  const std::size_t first = features.list().size();
  double x = 1, y = 0;
  for (std::size_t arm = 0; arm < count; ++arm) {
    const Vector move = reach / (ball_radius - threshold) * unit({x, y, droop});
    features.add_alone({unit({x, y, lean}), threshold, move, first + (count - arm) % count});
    std::tie(x, y) = std::pair(c * x - s * y, s * x + c * y);
  }
}

// All beyond a plane is sheared sideways; planes mostly stand across the long axes.
void add_bends(Features& features, std::uint64_t count, const Vector& proportions, Random& random) {
  for (std::uint64_t i = 0; i < count; ++i) {
    const Vector along = unit(proportions * proportions * direction(random));
    const double threshold = random.uniform(-0.6, 0.6), amount = random.uniform(0.3, 0.9);
    const Vector move = amount * direction_across(along, random);
    features.add(along, threshold, move);
  }
}

// The rim all around an axis is moved along it: a bell.
void add_cup(Features& features, const Vector& axis, Random& random) {
  const double amount = random.uniform(0.2, 0.5), height = std::sqrt(0.75);
  const Vector x = direction_across(axis, random), y = cross(axis, x);
  for (const Vector& d : {x, 0.5 * x + height * y, -0.5 * x + height * y})
    for (const Vector& out : {d, -d}) features.add(out, 0.3, -amount * axis);
}

void fill_with_small_features(Features& features, Random& random) {
  for (bool room = true; room;) {
    const Vector along = direction(random), move = 0.03 * direction(random);
    room = features.add(along, random.uniform(-1.2, 1.2), move);
  }
}

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

// Grows layers from the input on and knows how the place is read from the last one.
class Trunk {
 public:
  static constexpr std::size_t carried = 6;  // neurons that hand a place on: max(0, x), max(0, -x), ...

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
    while (next.size() < width) add_neuron({{}, 0, {}, next.size()});  // odd one out of pairs
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
  std::vector<float> sample(3 * points);
  Random random(1);
  for (float& x : sample) x = static_cast<float>(random.normal());
  if (!trunk.layers.empty()) sample = evaluate(std::span(trunk.layers), sample);
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

// Which materials a robot is likely to show: muscles of one frequency, two to four phases of it, so that they work
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

// The place is read from the trunk. A score is a slope across the body, some relief, and a handicap for materials
// outside the palette.
Layer last_layer(const Trunk& trunk, bool mirrored, Random& random) {
  const std::size_t inputs = trunk.readout.size();
  Layer layer{static_cast<int>(inputs), network_outputs, {}, {0, 0, 0}};
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Vector& r : trunk.readout) layer.weights.push_back(static_cast<float>(r[axis]));
  const Activity activity = activity_of(trunk);
  const double relief = 0.7 / (activity.size * std::sqrt(static_cast<double>(inputs)));
  for (const bool chosen : random_palette(random)) {
    double bias = 0.2 * random.normal() - (chosen ? 0 : 3);
    std::vector<double> weights(inputs);
    for (double& weight : weights) weight = relief * random.normal();
    for (std::size_t j = 0; j < std::min(inputs, Trunk::carried); ++j) weights[j] += random.normal();
    for (std::size_t j = 0; j < inputs; ++j) {
      if (mirrored) weights[j] = weights[std::min(j, trunk.twins[j])];
      bias -= weights[j] * activity.means[j];
      layer.weights.push_back(static_cast<float>(weights[j]));
    }
    layer.biases.push_back(static_cast<float>(bias));
  }
  return layer;
}

}  // namespace

void validate(const NnOptions& options) {
  const auto refuse = [](const char* option, const auto& value, const char* accepted) {
    std::ostringstream given;
    given << value;
    throw InputError(option, given.str() + " is not accepted; give " + accepted);
  };
  if (options.hidden.size() >= max_network_layers) refuse("--hidden", options.hidden.size(), "at most 15 layers");
  for (const int width : options.hidden)
    if (width < static_cast<int>(Trunk::carried) || width > max_network_width)
      refuse("--hidden", width, "6 to 4096 neurons a layer");
  if (options.points < min_cloud_points || options.points > max_masses)
    refuse("--points", options.points, "64 to 65535");
  if (!(options.alpha >= 0 && std::isfinite(options.alpha)))
    refuse("--alpha", options.alpha, "a radius > 0 m, or 0 for the smallest that holds all points");
  if (!(options.mirrored >= 0 && options.mirrored <= 1)) refuse("--mirrored", options.mirrored, "a share from 0 to 1");
}

NnGenome random_nn_genome(const NnOptions& options, std::uint64_t seed, std::uint64_t index) {
  validate(options);
  Random random(seed_of(seed, index));
  NnGenome genome;
  genome.cloud_seed = random.bits();
  genome.points = options.points;
  genome.alpha = options.alpha;
  genome.environment = options.environment;
  genome.mirrored = random.chance(options.mirrored);
  Trunk trunk = random_trunk(options.hidden, genome.mirrored, random);
  Layer last = last_layer(trunk, genome.mirrored, random);
  genome.network.layers = std::move(trunk.layers);
  genome.network.layers.push_back(std::move(last));
  return genome;
}

}  // namespace mercury
