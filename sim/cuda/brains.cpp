// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/brains.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>

namespace mercury::cuda {
namespace {

template <class T>
DeviceArray<T> uploaded(const std::vector<T>& values, cudaStream_t stream) {
  DeviceArray<T> array(values.size());
  array.write(0, values, stream);
  return array;
}

// A list of the bytes of several lists, each of which begins at a multiple of 16.
class Bytes {
 public:
  std::vector<std::byte> all;

  // Returns where they begin.
  template <class T>
  std::uint32_t append(std::span<const T> list) {
    const auto first = static_cast<std::uint32_t>(all.size());
    const std::span<const std::byte> bytes = std::as_bytes(list);
    all.insert(all.end(), bytes.begin(), bytes.end());
    all.resize((all.size() + 15) / 16 * 16);
    return first;
  }
};

// All brains as device memory has them, on the host. In a robot, pointers are offsets until address() adds where their
// arrays begin.
class TableMaker {
 public:
  std::vector<ThinkingRobot> robots;  // in the order of the batch
  std::vector<std::byte> plans, bodies;
  std::vector<BrainMaterial> materials;
  std::vector<std::uint16_t> slots;
  std::vector<SensedSpring> springs;
  std::vector<RestingMass> rest;
  std::size_t activations = 0, samples = 0, weights = 0;
  BrainBytes largest;  // of each part

  void add(const DeviceBrains::Thinker& thinker) {
    const BrainPlan& plan = *thinker.plan;
    ThinkingRobot robot = of_plan(plan);
    robot.robot = static_cast<std::uint32_t>(thinker.robot);
    rows_ = 0;
    std::vector<SensedPlace> places;
    shares_.clear();
    robot.slots = offset<std::uint16_t>(0);
    robot.springs = offset<SensedSpring>(0);
    for (std::size_t i = 0; i < plan.places.size(); ++i) places.push_back(place(thinker, i, robot));
    robot.places = static_cast<std::uint32_t>(places.size());
    robot.listed_shares = static_cast<std::uint32_t>(shares_.size());
    Bytes body;
    body.append(std::span<const SensedPlace>(places));
    robot.at.shares = body.append(std::span<const SensingShare>(shares_));
    robot.body = offset<char>(bodies.size());
    robot.body_bytes = static_cast<std::uint32_t>(body.all.size());
    bodies.insert(bodies.end(), body.all.begin(), body.all.end());
    robot.rest = offset<RestingMass>(rest.size());
    if (robot.tile_shares > 0) add_rest(thinker);
    add_materials(thinker, robot);
    robot.activations = offset<float>(activations);
    robot.samples_of_senses = offset<float>(samples);
    robot.stored_weights = offset<float>(weights);
    activations += plan.neurons.size();
    samples += plan.samples * plan.senses.size();
    weights += plan.weights.size();
    lay_out(robot, plan);
    robots.push_back(robot);
  }

 private:
  template <class T>
  static T* offset(std::size_t elements) {
    return reinterpret_cast<T*>(elements * sizeof(T));
  }

  // Equal plans share their tables, which the device then finds in its caches.
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
    Bytes tables;
    const auto append = [&](const auto& list) { return tables.append(std::span(list)); };
    append(plan.senses);
    robot.at.neurons = append(plan.neurons);
    robot.at.runs = append(plan.runs);
    robot.at.gates = append(plan.gates);
    robot.at.learnings = append(plan.learnings);
    robot.at.layers = append(plan.layers);
    robot.at.outputs = append(plan.outputs);
    robot.plan = offset<char>(plans.size());
    robot.plan_bytes = static_cast<std::uint32_t>(tables.all.size());
    plans.insert(plans.end(), tables.all.begin(), tables.all.end());
    robot.senses = count(plan.senses);
    robot.neurons = count(plan.neurons);
    robot.layers = count(plan.layers);
    robot.outputs = count(plan.outputs);
    robot.weight_count = count(plan.weights);
    robot.samples = static_cast<std::uint32_t>(plan.samples);
    robot.uses_frame = plan.uses_frame;
    robot.uses_turn_rate = plan.uses_turn_rate;
    return robot;
  }

  SensedPlace place(const DeviceBrains::Thinker& thinker, std::size_t number, ThinkingRobot& robot) {
    const BrainPlan& plan = *thinker.plan;
    const BrainPlan::Place& from = plan.places[number];
    const bool senses_masses = from.measures & ~(measure_strain | measure_strain_rate);
    SensedPlace place{.first_row = rows_,
                      .mass_shares = 0,
                      .spring_shares = 0,
                      .masses = static_cast<std::uint32_t>(from.masses.size()),
                      .springs = 0,
                      .mass = 0};
    const auto cut = [&](bool of_springs, std::size_t first, std::size_t count) {
      const std::uint32_t before = rows_;
      for (std::size_t done = 0; done < count; done += entries_per_share)
        shares_.push_back({of_springs, rows_++,
                           static_cast<std::uint32_t>(std::min<std::size_t>(entries_per_share, count - done)),
                           first + done});
      return rows_ - before;
    };
    if (number == 0) {
      if (senses_masses) place.mass_shares = divide_up(tiles_for(thinker.body->masses.size()), tiles_per_share);
      robot.tile_shares = place.mass_shares;
      rows_ += place.mass_shares * (plan.uses_turn_rate ? 2 : 1);
    } else {
      const std::size_t first = slots.size();
      for (const std::uint16_t mass : from.masses) {
        slots.push_back(static_cast<std::uint16_t>(thinker.order->slot_of(mass)));
        place.mass += static_cast<double>(mass_of(*thinker.body, mass));
      }
      if (senses_masses) place.mass_shares = cut(false, first, from.masses.size());
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
      place.spring_shares = cut(true, first, place.springs);
    }
    return place;
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
      const float m = mass_of(body, i);
      rest.push_back({m * Vec3{static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)}, m});
    }
  }

  // The materials up to the last one that is driven. All pointers are final already.
  void add_materials(const DeviceBrains::Thinker& thinker, ThinkingRobot& robot) {
    robot.material_sources = offset<BrainMaterial>(materials.size());
    if (thinker.driven.empty()) return;
    robot.phases = thinker.phases;
    const auto id_of = [&](const DrivenMaterial& driven) { return driven.phase - thinker.phases; };
    const auto first = static_cast<std::ptrdiff_t>(materials.size());
    robot.materials = static_cast<std::uint32_t>(id_of(thinker.driven.back()) + 1);
    robot.materials_now = thinker.driven.back().now - (robot.materials - 1);
    robot.swings = thinker.driven.back().swing - (robot.materials - 1);
    materials.resize(materials.size() + robot.materials, {nullptr, 0, BrainPlan::none});
    for (const DrivenMaterial& driven : thinker.driven) {
      const std::size_t actuator = driven.setting - thinker.robot * thinker.columns;
      const auto output = std::ranges::find(thinker.plan->outputs, actuator, &BrainPlan::Output::actuator);
      if (output != thinker.plan->outputs.end())
        materials[static_cast<std::size_t>(first + id_of(driven))] = {driven.own, driven.setting, output->neuron};
    }
  }

  // Where the parts of its memory are.
  void lay_out(ThinkingRobot& robot, const BrainPlan& plan) {
    std::size_t end = sizeof(ThinkingRobot);
    const auto part = [&](std::size_t bytes) {
      const std::size_t first = (end + 15) / 16 * 16;
      end = first + bytes;
      return static_cast<std::uint32_t>(first);
    };
    robot.at.measures = part(sizeof(BodyMeasures) + robot.places * sizeof(PlaceMeasures));
    robot.at.sums = part(rows_ * sums_per_row * sizeof(float));
    robot.at.values = part(sizeof(float) * (plan.senses.size() + plan.neurons.size() +
                                            std::ranges::max(plan.layers, {}, &BrainPlan::Layer::count).count));
    robot.at.muscles = part(robot.materials * sizeof(BrainMuscle));
    robot.at.clamps = part(plan.neurons.size() * sizeof(float));
    largest = largest.with({.scratch = part(0),
                            .tables = robot.plan_bytes + robot.body_bytes,
                            .weights = static_cast<std::uint32_t>((4 * plan.weights.size() + 15) / 16 * 16)});
  }

  static constexpr std::size_t most_compared = 16;
  std::map<const BrainPlan*, ThinkingRobot> plans_;
  std::vector<const BrainPlan*> distinct_;
  std::vector<SensingShare> shares_;  // of the robot that is added
  std::uint32_t rows_ = 0;            // of its sums
};

template <class T>
void address(T*& pointer, T* base) {
  pointer = reinterpret_cast<T*>(reinterpret_cast<std::uintptr_t>(base) + reinterpret_cast<std::uintptr_t>(pointer));
}

}  // namespace

void DeviceBrains::set(std::span<const Thinker> thinkers, std::span<const std::uint32_t> class_sizes,
                       cudaStream_t stream) {
  clear();
  TableMaker made;
  std::vector<std::vector<std::uint32_t>> thinkers_of;
  for (const std::uint32_t size : class_sizes) thinkers_of.emplace_back(size, Thoughts::none);
  bytes_.resize(class_sizes.size());
  for (const Thinker& thinker : thinkers) {
    thinkers_of[thinker.size_class][thinker.place] = static_cast<std::uint32_t>(made.robots.size());
    made.largest = bytes_[thinker.size_class];
    made.add(thinker);
    bytes_[thinker.size_class] = made.largest;
    workspace_stride_ = std::max(workspace_stride_, made.largest.scratch);
  }
  for (const auto& of_class : thinkers_of) thinkers_of_.push_back(uploaded(of_class, stream));
  plans_ = uploaded(made.plans, stream);
  bodies_ = uploaded(made.bodies, stream);
  materials_ = uploaded(made.materials, stream);
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
  for (std::size_t i = 0; i < made.robots.size(); ++i) {
    ThinkingRobot& robot = made.robots[i];
    address<const char>(robot.plan, reinterpret_cast<const char*>(plans_.data()));
    address<const char>(robot.body, reinterpret_cast<const char*>(bodies_.data()));
    address<const BrainMaterial>(robot.material_sources, materials_.data());
    address<const std::uint16_t>(robot.slots, slots_.data());
    address<const SensedSpring>(robot.springs, springs_.data());
    address<const RestingMass>(robot.rest, rest_.data());
    robot.clamps = reinterpret_cast<const float*>(robot.activations);
    address<const float>(robot.clamps, clamps_.data());
    address(robot.activations, activations_->data());
    address(robot.samples_of_senses, samples_->data());
    address(robot.stored_weights, weights_->data());
    robot.weights = robot.stored_weights;
    robot.target = targets_.data() + i;
    robot.thoughts = thoughts_.data() + i;
    robot.noise_seed = noise_seeds_.data() + i;
  }
  thinkers_ = uploaded(made.robots, stream);
}

void DeviceBrains::reserve_workspace() {
  const std::size_t bytes = thinkers_.size() * workspace_stride_;
  if (workspace_.size() < bytes) workspace_ = DeviceArray<char>(bytes);
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
          .robots = thinkers_.data(),
          .workspace = workspace_.data(),
          .workspace_stride = workspace_stride_,
          .world = SensedWorld::of(environment),
          .sources = actuators.sources()};
}

}  // namespace mercury::cuda
