// SPDX-License-Identifier: Apache-2.0
#include "sim/brains.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string>

#include "mercury/error.h"
#include "mercury/parallel.h"
#include "sim/physics/activation.h"

namespace mercury {
namespace {

void set_clamped(std::span<float> neurons, const std::vector<std::pair<std::uint32_t, float>>& clamps) {
  for (const auto& [neuron, value] : clamps) neurons[neuron] = value;
}

void require(std::size_t given, std::size_t wanted, const char* what) {
  if (given != wanted)
    throw std::invalid_argument(std::to_string(given) + " " + what + ", the brain has " + std::to_string(wanted));
}

// y <- k y + g act(W z + b), layer after layer, and what its weights learn.
void update_neurons(const BrainPlan& plan, std::vector<float>& z, std::span<float> weights,
                    const std::vector<std::pair<std::uint32_t, float>>& clamps) {
  const std::span<float> neurons = std::span(z).subspan(plan.senses.size());
  std::vector<float> changed;
  for (const BrainPlan::Layer& layer : plan.layers) {
    changed.resize(layer.count);
    for (std::size_t i = 0; i < layer.count; ++i) {
      const BrainPlan::Neuron& neuron = plan.neurons[layer.first + i];
      float sum = neuron.bias == BrainPlan::none ? 0 : weights[neuron.bias];
      for (std::size_t r = neuron.first_run; r < neuron.first_run + neuron.runs; ++r) {
        const BrainPlan::Run& run = plan.runs[r];
        for (std::size_t k = 0; k < run.count; ++k) sum = multiply_add(weights[run.weight + k], z[run.source + k], sum);
      }
      const float y = neurons[layer.first + i];
      const float act = activation_of(neuron.activation, sum);
      changed[i] = layer.first_gate == BrainPlan::none
                       ? changed_activation(neuron, y, act)
                       : gated_activation(plan.gates[layer.first_gate + i], neuron.alpha, neurons.data(), y, act);
    }
    std::ranges::copy(changed, neurons.begin() + layer.first);
    set_clamped(neurons, clamps);
    for (std::size_t k = layer.first_learning; k < layer.first_learning + layer.learnings; ++k) {
      const BrainPlan::Learning& learning = plan.learnings[k];
      const float y = neurons[learning.neuron];
      float& weight = weights[learning.weight];
      weight = multiply_add(learning.rate * y, fnma(y, weight, z[learning.source]), weight);
    }
  }
}

}  // namespace

void Brains::leave_backend() {
  begin_access();
  fetch(true);
  for (std::size_t i = 0; i < of_.size(); ++i) take(i);
  shared_.reset();
  backend_ = nullptr;
  by_backend_.reset();
}

void Brains::append(std::span<const std::shared_ptr<const Robot>> added) {
  const Robot* last = nullptr;
  std::shared_ptr<const BrainPlan> plan;  // of `last`
  for (const auto& robot : added) {
    targets_.emplace_back();
    if (!robot->brain) {
      of_.push_back(nullptr);
      continue;
    }
    if (robot.get() != last) plan = std::make_shared<const BrainPlan>(make_brain_plan(*robot));
    last = robot.get();
    of_.push_back(std::make_unique<OfRobot>(OfRobot{plan, state_at_start(*plan), {}, 0}));
    ++count_;
    changed_ = true;
  }
}

void Brains::truncate(std::size_t size) {
  of_.resize(size);
  targets_.resize(size);
  count_ = static_cast<std::size_t>(std::ranges::count_if(of_, [](const auto& brain) { return brain != nullptr; }));
}

void Brains::keep(std::span<const std::size_t> robots) {
  std::vector<std::unique_ptr<OfRobot>> kept;
  std::vector<std::optional<Vec3>> targets;
  for (const std::size_t i : robots) {
    kept.push_back(std::move(of_[i]));
    targets.push_back(targets_[i]);
  }
  of_ = std::move(kept);
  targets_ = std::move(targets);
  truncate(of_.size());
  changed_ = true;
}

const BrainArrays& Brains::share(const Backend& backend) {
  if (shared_) return *shared_;
  const auto sizes = [](const BrainPlan& plan) {
    return std::array{plan.weights.size(), plan.neurons.size(), plan.samples * plan.senses.size()};
  };
  if (count_ == 0 || count_ < of_.size() ||
      !std::ranges::all_of(of_, [&](const auto& brain) { return sizes(*brain->plan) == sizes(*of_[0]->plan); }))
    throw InputError("brains",
                     "as arrays they need robots that all have one, with as many weights, neurons and senses");
  if (backend_) return shared_.emplace(backend_->share_brains());
  const auto allocate = [&](std::size_t columns) {
    SharedArray<float> array{.rows = of_.size(), .columns = columns};
    array.data = std::static_pointer_cast<float>(backend.allocate_shared(of_.size() * columns * sizeof(float)));
    return array;
  };
  const auto [weights, neurons, senses] = sizes(*of_[0]->plan);
  shared_ = {.weights = allocate(weights), .neurons = allocate(neurons), .senses = allocate(senses)};
  for (std::size_t i = 0; i < of_.size(); ++i) give(i);
  return *shared_;
}

void Brains::begin_access() const {
  if (shared_ && backend_) backend_is_newer_ = weights_are_newer_ = true;
}

void Brains::end_access() {
  if (shared_ && backend_) think_in_backend(*backend_);
}

void Brains::take(std::size_t robot) const {
  if (!shared_ || backend_) return;
  const auto copy = [&](const SharedArray<float>& from, std::vector<float>& to) {
    std::copy_n(from.data.get() + robot * from.columns, from.columns, to.begin());
  };
  BrainState& state = of_[robot]->state;
  copy(shared_->weights, state.weights);
  copy(shared_->neurons, state.neurons);
  copy(shared_->senses, state.senses);
}

void Brains::give(std::size_t robot) const {
  if (!shared_ || backend_) return;
  const auto copy = [&](const std::vector<float>& from, const SharedArray<float>& to) {
    std::ranges::copy(from, to.data.get() + robot * to.columns);
  };
  const BrainState& state = of_[robot]->state;
  copy(state.weights, shared_->weights);
  copy(state.neurons, shared_->neurons);
  copy(state.senses, shared_->senses);
}

void Brains::fetch(bool weights) const {
  weights =
      weights && weights_are_newer_ &&
      (shared_ || std::ranges::any_of(of_, [](const auto& brain) { return brain && !brain->plan->learnings.empty(); }));
  if (!std::exchange(backend_is_newer_, false) && !weights) return;
  if (weights) weights_are_newer_ = false;
  const PackedBrains now = backend_->read_brains(weights);
  std::size_t neuron = 0, sense = 0, weight = 0, index = 0;
  const auto take = [](std::vector<float>& to, const std::vector<float>& from, std::size_t& at) {
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(at), to.size(), to.begin());
    at += to.size();
  };
  for (const auto& brain : of_) {
    if (!brain) continue;
    take(brain->state.neurons, now.neurons, neuron);
    take(brain->state.senses, now.senses, sense);
    if (weights) take(brain->state.weights, now.weights, weight);
    brain->state.thoughts = now.thoughts[index++];
  }
}

Brains::OfRobot* Brains::to_change(std::size_t robot, bool weights) {
  fetch(weights);
  if (of_[robot]) take(robot);
  changed_for_backend_ = true;
  return of_[robot].get();
}

PackedBrains Brains::packed() const {
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  PackedBrains all;
  for (std::size_t i = 0; i < of_.size(); ++i) {
    if (!of_[i]) continue;
    const OfRobot& brain = *of_[i];
    all.neurons.insert(all.neurons.end(), brain.state.neurons.begin(), brain.state.neurons.end());
    all.senses.insert(all.senses.end(), brain.state.senses.begin(), brain.state.senses.end());
    if (weights_for_backend_)
      all.weights.insert(all.weights.end(), brain.state.weights.begin(), brain.state.weights.end());
    all.thoughts.push_back(brain.state.thoughts);
    all.clamps.resize(all.neurons.size(), none);
    set_clamped(std::span(all.clamps).last(brain.state.neurons.size()), brain.clamps);
    all.targets.push_back(targets_[i].value_or(Vec3{none, none, none}));
    all.noise_seeds.push_back(brain.noise_seed);
  }
  return all;
}

bool Brains::think_in_backend(Backend& backend) {
  if (!by_backend_) {
    std::vector<const BrainPlan*> plans;
    for (const auto& brain : of_) plans.push_back(brain ? brain->plan.get() : nullptr);
    by_backend_ = backend.set_brains(plans);
    if (*by_backend_) backend_ = &backend;
    changed_for_backend_ = weights_for_backend_ = true;
  }
  if (!*by_backend_) return false;
  if (std::exchange(changed_for_backend_, false)) backend.write_brains(packed());
  weights_for_backend_ = false;
  return true;
}

void Brains::reset(std::size_t robot) {
  if (!of_[robot]) return;
  OfRobot& brain = *to_change(robot);
  std::vector<float> weights = std::move(brain.state.weights);
  brain.state = state_at_start(*brain.plan);
  brain.state.weights = std::move(weights);
  set_clamped(brain.state.neurons, brain.clamps);
  give(robot);
  changed_ = true;
}

std::int64_t Brains::steps_until_thought(const Clock& clock) const {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  const BrainPlan* last = nullptr;
  for (const auto& brain : of_) {
    if (!brain || brain->plan.get() == last) continue;
    last = brain->plan.get();
    least = std::min(least, steps_to_thought(last->period, clock));
  }
  return least;
}

bool Brains::need_state(const Clock& clock) const {
  return std::ranges::any_of(of_, [&](const auto& brain) {
    return brain && brain->plan->uses_state && steps_since_thought(brain->plan->period, clock) == 0;
  });
}

void Brains::sample(OfRobot& brain, const Clock& clock, const SensedBody& body, const SensedWorld& world,
                    Vec3 target) const {
  const BrainPlan& plan = *brain.plan;
  const std::size_t count = plan.senses.size();
  if (plan.samples > 1)
    std::shift_right(brain.state.senses.begin(), brain.state.senses.end(), static_cast<std::ptrdiff_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    const BrainPlan::Sense& sense = plan.senses[i];
    float value = 0;
    if (sense.kind == SensorKind::clock)
      value = clock_sense(sense, clock);
    else if (sense.kind == SensorKind::neuron || sense.kind == SensorKind::neighbors)
      value = sense.neuron == BrainPlan::none ? 0 : brain.state.neurons[sense.neuron];
    else
      value = static_cast<float>(body_sense(sense, body.places[sense.place], body.body, world, target));
    value *= sense.gain;
    if (sense.noise > 0)
      value = multiply_add(sense.noise, normal_number(plan.seed + brain.noise_seed, brain.state.thoughts, i), value);
    brain.state.senses[i] = value;
  }
}

void Brains::think(const Clock& clock, std::span<const std::shared_ptr<const Robot>> robots,
                   std::span<const std::size_t> mass_offsets, std::span<const Vec3> positions,
                   std::span<const Vec3> velocities, const Environment& environment) {
  const SensedWorld world = SensedWorld::of(environment);
  parallel_for(0, of_.size(), [&](std::size_t i) {
    if (!of_[i] || steps_since_thought(of_[i]->plan->period, clock) != 0) return;
    take(i);
    OfRobot& brain = *of_[i];
    const BrainPlan& plan = *brain.plan;
    const auto own = [&](std::span<const Vec3> all) {
      return all.empty() ? all : all.subspan(mass_offsets[i], mass_offsets[i + 1] - mass_offsets[i]);
    };
    sample(brain, clock, measure_body(*robots[i], plan, own(positions), own(velocities), world.ground), world,
           targets_[i].value_or(world.target));
    std::vector<float> z(plan.senses.size() + plan.neurons.size());
    for (std::size_t k = 0; k < plan.senses.size(); ++k)
      z[k] = brain.state.senses[plan.senses[k].delay * plan.senses.size() + k];
    std::ranges::copy(brain.state.neurons, z.begin() + static_cast<std::ptrdiff_t>(plan.senses.size()));
    update_neurons(plan, z, brain.state.weights, brain.clamps);
    std::copy(z.begin() + static_cast<std::ptrdiff_t>(plan.senses.size()), z.end(), brain.state.neurons.begin());
    ++brain.state.thoughts;
    give(i);
  });
  changed_ = true;
}

std::vector<DriveSetting> Brains::take_drives() {
  std::vector<DriveSetting> all;
  if (!std::exchange(changed_, false)) return all;
  fetch(false);
  for (std::size_t i = 0; i < of_.size(); ++i) {
    if (!of_[i]) continue;
    for (const BrainPlan::Output& output : of_[i]->plan->outputs)
      all.push_back({i, output.actuator, drive_of(of_[i]->state.neurons[output.neuron])});
  }
  return all;
}

BrainState Brains::state(std::size_t robot) const {
  if (!of_[robot]) return {};
  fetch(true);
  take(robot);
  return of_[robot]->state;
}

void Brains::read(std::span<float> senses, std::span<float> neurons) const {
  fetch(false);
  std::size_t sense = 0, neuron = 0;
  for (const auto& brain : of_) {
    if (!brain) continue;
    sense += brain->plan->senses.size();
    neuron += brain->plan->neurons.size();
  }
  require(senses.size(), sense, "senses");
  require(neurons.size(), neuron, "neurons");
  const auto copy = [](const std::vector<float>& from, std::size_t count, std::span<float>& to) {
    std::copy_n(from.begin(), count, to.begin());
    to = to.subspan(count);
  };
  for (std::size_t i = 0; i < of_.size(); ++i) {
    if (!of_[i]) continue;
    take(i);
    copy(of_[i]->state.senses, of_[i]->plan->senses.size(), senses);
    copy(of_[i]->state.neurons, of_[i]->plan->neurons.size(), neurons);
  }
}

void Brains::require_state(std::size_t robot, const BrainState& state) const {
  const BrainState wanted = of_[robot] ? state_at_start(*of_[robot]->plan) : BrainState{};
  require(state.neurons.size(), wanted.neurons.size(), "neurons");
  require(state.senses.size(), wanted.senses.size(), "sampled senses");
  require(state.weights.size(), wanted.weights.size(), "weights");
}

void Brains::set_state(std::size_t robot, const BrainState& state) {
  require_state(robot, state);
  if (!of_[robot]) return;
  to_change(robot, true)->state = state;
  give(robot);
  weights_for_backend_ = changed_ = true;
}

void Brains::set_weights(std::size_t robot, std::span<const float> weights) {
  require(weights.size(), of_[robot] ? of_[robot]->state.weights.size() : 0, "weights");
  if (!of_[robot]) return;
  std::ranges::copy(weights, to_change(robot, true)->state.weights.begin());
  give(robot);
  weights_for_backend_ = true;
}

void Brains::clamp(std::size_t robot, std::size_t neuron, std::optional<float> value) {
  const std::size_t count = of_[robot] ? of_[robot]->plan->neurons.size() : 0;
  if (neuron >= count)
    throw std::out_of_range("neuron " + std::to_string(neuron) + ", the brain has " + std::to_string(count));
  OfRobot& brain = *to_change(robot);
  std::erase_if(brain.clamps, [&](const auto& known) { return known.first == neuron; });
  if (!value) return;
  brain.clamps.emplace_back(static_cast<std::uint32_t>(neuron), *value);
  brain.state.neurons[neuron] = *value;
  give(robot);
  changed_ = true;
}

void Brains::set_target(std::size_t robot, std::optional<Vec3> target) {
  to_change(robot);
  targets_[robot] = target;
}

void Brains::set_noise_seed(std::size_t robot, std::uint64_t seed) {
  if (of_[robot]) to_change(robot)->noise_seed = seed;
}

}  // namespace mercury
