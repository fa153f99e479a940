// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/brains.h"

#include <algorithm>
#include <map>

namespace mercury::cuda {
namespace {

template <class T>
DeviceArray<T> uploaded(const std::vector<T>& values, cudaStream_t stream) {
  DeviceArray<T> array(values.size());
  array.write(0, values, stream);
  return array;
}

bool reads_itself(const BrainPlan& plan, const BrainPlan::Layer& layer) {
  const auto first = static_cast<std::uint32_t>(plan.senses.size()) + layer.first, last = first + layer.count;
  for (const BrainPlan::Neuron& neuron : std::span(plan.neurons).subspan(layer.first, layer.count))
    for (const BrainPlan::Run& run : std::span(plan.runs).subspan(neuron.first_run, neuron.runs))
      if (run.source < last && run.source + run.count > first) return true;
  return false;
}

// All brains as the tables have them, on the host.
class TableMaker {
 public:
  std::vector<ThinkingRobot> robots;  // in the order of the batch
  std::vector<BrainPlan::Sense> senses;
  std::vector<BrainPlan::Neuron> neurons;
  std::vector<BrainPlan::Run> runs;
  std::vector<BrainPlan::Gate> gates;
  std::vector<BrainPlan::Learning> learnings;
  std::vector<BrainLayer> layers;
  std::vector<BrainPlan::Output> outputs;
  std::vector<SensedPlace> places;
  std::vector<SensingShare> shares;
  std::vector<std::uint16_t> slots;
  std::vector<SensedSpring> springs;
  std::vector<Vec3> rest;
  std::size_t activations = 0, samples = 0, weights = 0, scratch = 0, rows = 0;

  void add(const DeviceBrains::Thinker& thinker) {
    const BrainPlan& plan = *thinker.plan;
    ThinkingRobot robot = of_plan(plan);
    robot.robot = static_cast<std::uint32_t>(thinker.robot);
    robot.brain = static_cast<std::uint32_t>(robots.size());
    robot.first_driven = thinker.first_driven;
    robot.driven = static_cast<std::uint32_t>(thinker.driven);
    robot.first_place = places.size();
    robot.places = static_cast<std::uint32_t>(plan.places.size());
    robot.first_share = shares.size();
    robot.first_row = rows;
    for (std::size_t i = 0; i < plan.places.size(); ++i) add_place(thinker, i, robot.first_row);
    robot.shares = static_cast<std::uint32_t>(shares.size() - robot.first_share);
    robot.first_rest = rest.size();
    if (plan.uses_frame) add_rest(thinker);
    robot.first_activation = activations;
    robot.first_sample = samples;
    robot.first_weight = weights;
    robot.first_scratch = scratch;
    activations += plan.neurons.size();
    samples += plan.samples * plan.senses.size();
    weights += plan.weights.size();
    scratch +=
        plan.senses.size() + plan.neurons.size() + std::ranges::max(plan.layers, {}, &BrainPlan::Layer::count).count;
    robots.push_back(robot);
  }

 private:
  template <class T>
  static std::uint64_t append(std::vector<T>& to, const std::vector<T>& from) {
    const std::uint64_t first = to.size();
    to.insert(to.end(), from.begin(), from.end());
    return first;
  }

  // Equal plans share the tables, which the device then finds in its caches.
  const ThinkingRobot& of_plan(const BrainPlan& plan) {
    if (const auto known = plans_.find(&plan); known != plans_.end()) return known->second;
    const auto equal =
        std::ranges::find_if(distinct_, [&](const BrainPlan* other) { return plan.has_tables_of(*other); });
    if (equal != distinct_.end()) return plans_.emplace(&plan, plans_.at(*equal)).first->second;
    if (distinct_.size() < most_compared) distinct_.push_back(&plan);
    const auto count = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
    ThinkingRobot& robot = plans_[&plan];
    robot.period = plan.period;
    robot.seed = plan.seed;
    robot.first_sense = append(senses, plan.senses);
    robot.first_neuron = append(neurons, plan.neurons);
    robot.first_run = append(runs, plan.runs);
    robot.first_gate = append(gates, plan.gates);
    robot.first_learning = append(learnings, plan.learnings);
    robot.first_layer = layers.size();
    for (const BrainPlan::Layer& layer : plan.layers) layers.push_back({layer, reads_itself(plan, layer)});
    robot.first_output = append(outputs, plan.outputs);
    robot.senses = count(plan.senses);
    robot.neurons = count(plan.neurons);
    robot.layers = count(plan.layers);
    robot.outputs = count(plan.outputs);
    robot.weights = count(plan.weights);
    robot.samples = static_cast<std::uint32_t>(plan.samples);
    robot.uses_frame = plan.uses_frame;
    robot.uses_turn_rate = plan.uses_turn_rate;
    return robot;
  }

  void add_place(const DeviceBrains::Thinker& thinker, std::size_t number, std::size_t first_row) {
    const BrainPlan& plan = *thinker.plan;
    const BrainPlan::Place& from = plan.places[number];
    SensedPlace place{.first_row = static_cast<std::uint32_t>(rows - first_row),
                      .mass_shares = 0,
                      .spring_shares = 0,
                      .masses = static_cast<std::uint32_t>(from.masses.size()),
                      .springs = 0,
                      .mass = 0};
    const auto cut = [&](SensingShare::Kind kind, std::size_t first, std::size_t count, std::uint32_t most) {
      const std::size_t before = shares.size();
      for (std::size_t done = 0; done < count; done += most) {
        shares.push_back({kind, static_cast<std::uint32_t>(rows - first_row),
                          static_cast<std::uint32_t>(std::min<std::size_t>(most, count - done)), first + done});
        rows += kind == SensingShare::tiles && plan.uses_turn_rate ? 2 : 1;
      }
      return static_cast<std::uint32_t>(shares.size() - before);
    };
    if (number == 0) {
      const std::uint32_t tiles = tiles_for(thinker.body->masses.size());
      if (from.measures & ~(measure_strain | measure_strain_rate))
        place.mass_shares = cut(SensingShare::tiles, 0, tiles, tiles_per_share);
    } else {
      const std::size_t first = slots.size();
      for (const std::uint16_t mass : from.masses) {
        slots.push_back(static_cast<std::uint16_t>(thinker.order->slot_of(mass)));
        place.mass += static_cast<double>(mass_of(*thinker.body, mass));
      }
      if (from.measures & ~(measure_strain | measure_strain_rate))
        place.mass_shares = cut(SensingShare::masses, first, from.masses.size(), entries_per_share);
    }
    if (from.measures & (measure_strain | measure_strain_rate)) {
      const std::size_t first = springs.size();
      const auto add = [&](const Spring& spring) {
        springs.push_back({static_cast<std::uint16_t>(thinker.order->slot_of(spring.a)),
                           static_cast<std::uint16_t>(thinker.order->slot_of(spring.b)), 1 / spring.rest_length});
      };
      if (number == 0)
        std::ranges::for_each(thinker.body->springs, add);
      else
        for (const std::uint32_t spring : from.springs) add(thinker.body->springs[spring]);
      place.springs = static_cast<std::uint32_t>(springs.size() - first);
      place.spring_shares = cut(SensingShare::springs, first, place.springs, entries_per_share);
    }
    places.push_back(place);
  }

  void add_rest(const DeviceBrains::Thinker& thinker) {
    const Robot& body = *thinker.body;
    Double3 sum;
    double mass = 0;
    for (std::size_t i = 0; i < body.masses.size(); ++i) {
      const auto m = static_cast<double>(mass_of(body, i));
      sum = sum + m * Double3(body.masses[i]);
      mass += m;
    }
    const Double3 center = (1 / mass) * sum;
    for (const std::uint16_t i : thinker.order->masses()) {
      const Double3 x = Double3(body.masses[i]) - center;
      rest.push_back({static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)});
    }
  }

  static constexpr std::size_t most_compared = 16;
  std::map<const BrainPlan*, ThinkingRobot> plans_;
  std::vector<const BrainPlan*> distinct_;
};

}  // namespace

void DeviceBrains::set(std::span<const Thinker> thinkers, std::span<const std::uint32_t> class_sizes,
                       cudaStream_t stream) {
  clear();
  TableMaker made;
  std::vector<std::vector<std::uint32_t>> thinkers_of;
  for (const std::uint32_t size : class_sizes) thinkers_of.emplace_back(size, Thoughts::none);
  for (const Thinker& thinker : thinkers) {
    thinkers_of[thinker.size_class][thinker.place] = static_cast<std::uint32_t>(made.robots.size());
    made.add(thinker);
  }
  for (const auto& of_class : thinkers_of) thinkers_of_.push_back(uploaded(of_class, stream));
  thinkers_ = uploaded(made.robots, stream);
  senses_ = uploaded(made.senses, stream);
  neurons_ = uploaded(made.neurons, stream);
  runs_ = uploaded(made.runs, stream);
  gates_ = uploaded(made.gates, stream);
  learnings_ = uploaded(made.learnings, stream);
  layers_ = uploaded(made.layers, stream);
  outputs_ = uploaded(made.outputs, stream);
  places_ = uploaded(made.places, stream);
  shares_ = uploaded(made.shares, stream);
  slots_ = uploaded(made.slots, stream);
  springs_ = uploaded(made.springs, stream);
  rest_ = uploaded(made.rest, stream);
  activations_ = std::make_shared<DeviceArray<float>>(made.activations);
  samples_ = std::make_shared<DeviceArray<float>>(made.samples);
  weights_ = std::make_shared<DeviceArray<float>>(made.weights);
  clamps_ = DeviceArray<float>(made.activations);
  targets_ = DeviceArray<Vec3>(made.robots.size());
  thoughts_ = DeviceArray<std::uint64_t>(made.robots.size());
  noise_seeds_ = DeviceArray<std::uint64_t>(made.robots.size());
  sums_ = DeviceArray<float>(made.rows * sums_per_row);
  measures_ = DeviceArray<PlaceMeasures>(made.places.size());
  bodies_ = DeviceArray<BodyMeasures>(made.robots.size());
  scratch_ = DeviceArray<float>(made.scratch);
  tables_ = {.robots = thinkers_.data(),
             .senses = senses_.data(),
             .neurons = neurons_.data(),
             .runs = runs_.data(),
             .gates = gates_.data(),
             .learnings = learnings_.data(),
             .layers = layers_.data(),
             .outputs = outputs_.data(),
             .places = places_.data(),
             .shares = shares_.data(),
             .slots = slots_.data(),
             .springs = springs_.data(),
             .rest = rest_.data(),
             .activations = activations_->data(),
             .samples = samples_->data(),
             .weights = weights_->data(),
             .clamps = clamps_.data(),
             .targets = targets_.data(),
             .thoughts = thoughts_.data(),
             .noise_seeds = noise_seeds_.data(),
             .sums = reinterpret_cast<float(*)[sums_per_row]>(sums_.data()),
             .measures = measures_.data(),
             .bodies = bodies_.data(),
             .scratch = scratch_.data()};
}

void DeviceBrains::write(const PackedBrains& brains, cudaStream_t stream) {
  activations_->write(0, brains.neurons, stream);
  samples_->write(0, brains.senses, stream);
  weights_->write(0, brains.weights, stream);
  thoughts_.write(0, brains.thoughts, stream);
  clamps_.write(0, brains.clamps, stream);
  targets_.write(0, brains.targets, stream);
  noise_seeds_.write(0, brains.noise_seeds, stream);
}

PackedBrains DeviceBrains::read(bool weights, cudaStream_t stream) const {
  PackedBrains brains;
  const auto read = [&](auto& to, const auto& from) {
    to.resize(from.size());
    from.read(0, to, stream);
  };
  read(brains.neurons, *activations_);
  read(brains.senses, *samples_);
  if (weights) read(brains.weights, *weights_);
  read(brains.thoughts, thoughts_);
  return brains;
}

BrainArrays DeviceBrains::share(int device) {
  shared_ = true;
  const std::size_t robots = thinkers_.size();
  const auto array = [&](const SharedNumbers& numbers) {
    return SharedArray<float>{.data = std::shared_ptr<float>(numbers, numbers->data()),
                              .rows = robots,
                              .columns = numbers->size() / robots,
                              .cuda_device = device};
  };
  return {.weights = array(weights_), .neurons = array(activations_), .senses = array(samples_)};
}

Thoughts DeviceBrains::thoughts(std::uint32_t size_class, const Environment& environment,
                                const Actuators& actuators) const {
  if (empty()) return {};
  return {.thinkers = thinkers_of_[size_class].data(),
          .tables = tables_,
          .world = SensedWorld::of(environment),
          .sources = actuators.sources(),
          .driven = actuators.driven()};
}

}  // namespace mercury::cuda
