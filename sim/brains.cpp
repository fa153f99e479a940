// SPDX-License-Identifier: Apache-2.0
#include "sim/brains.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "sim/physics/activation.h"
#include "sim/senses.h"

namespace mercury {
namespace {

std::int64_t steps_per_thought(const BrainPlan& plan, double dt) {
  const double steps = static_cast<double>(plan.period) / dt;
  return steps < 1e15 ? std::max(std::int64_t{1}, static_cast<std::int64_t>(std::llround(steps)))
                      : std::int64_t{1} << 50;
}

std::int64_t steps_since_thought(const BrainPlan& plan, const Clock& clock) {
  return (clock.step - clock.base_step) % steps_per_thought(plan, clock.dt);
}

void set_clamped(std::span<float> neurons, const std::vector<std::pair<std::uint32_t, float>>& clamps) {
  for (const auto& [neuron, value] : clamps) neurons[neuron] = value;
}

void require(std::size_t given, std::size_t wanted, const char* what) {
  if (given != wanted)
    throw std::invalid_argument(std::to_string(given) + " " + what + ", the brain has " + std::to_string(wanted));
}

// y <- y + alpha (act(W z + b) - y), layer after layer, and what its weights learn.
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
      const float wanted = activation_of(neuron.activation, sum);
      changed[i] = neuron.alpha == 1 ? wanted : multiply_add(neuron.alpha, wanted - y, y);
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

void Brains::reset(std::size_t robot) {
  if (!of_[robot]) return;
  OfRobot& brain = *of_[robot];
  std::vector<float> weights = std::move(brain.state.weights);
  brain.state = state_at_start(*brain.plan);
  brain.state.weights = std::move(weights);
  set_clamped(brain.state.neurons, brain.clamps);
  changed_ = true;
}

std::int64_t Brains::steps_to_thought(const Clock& clock) const {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  const BrainPlan* last = nullptr;
  for (const auto& brain : of_) {
    if (!brain || brain->plan.get() == last) continue;
    last = brain->plan.get();
    const std::int64_t since = steps_since_thought(*last, clock);
    if (since == 0) return 0;
    least = std::min(least, steps_per_thought(*last, clock.dt) - since);
  }
  return least;
}

bool Brains::need_state(const Clock& clock) const {
  return std::ranges::any_of(of_, [&](const auto& brain) {
    return brain && brain->plan->uses_state && steps_since_thought(*brain->plan, clock) == 0;
  });
}

void Brains::sample(OfRobot& brain, const Clock& clock, const Robot& robot, std::span<const Vec3> positions,
                    std::span<const Vec3> velocities, const Environment& environment, Vec3 target) const {
  const BrainPlan& plan = *brain.plan;
  SensedBody body(robot, plan, positions, velocities, environment, target);
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
      value = static_cast<float>(body.measure(sense));
    value *= sense.gain;
    if (sense.noise > 0)
      value = multiply_add(sense.noise, normal_number(plan.seed + brain.noise_seed, brain.state.thoughts, i), value);
    brain.state.senses[i] = value;
  }
}

void Brains::think(const Clock& clock, std::span<const std::shared_ptr<const Robot>> robots,
                   std::span<const std::size_t> mass_offsets, std::span<const Vec3> positions,
                   std::span<const Vec3> velocities, const Environment& environment) {
  oneapi::tbb::parallel_for(std::size_t{0}, of_.size(), [&](std::size_t i) {
    if (!of_[i] || steps_since_thought(*of_[i]->plan, clock) != 0) return;
    OfRobot& brain = *of_[i];
    const BrainPlan& plan = *brain.plan;
    const auto own = [&](std::span<const Vec3> all) {
      return all.empty() ? all : all.subspan(mass_offsets[i], mass_offsets[i + 1] - mass_offsets[i]);
    };
    sample(brain, clock, *robots[i], own(positions), own(velocities), environment,
           targets_[i].value_or(environment.target));
    std::vector<float> z(plan.senses.size() + plan.neurons.size());
    for (std::size_t k = 0; k < plan.senses.size(); ++k)
      z[k] = brain.state.senses[plan.senses[k].delay * plan.senses.size() + k];
    std::ranges::copy(brain.state.neurons, z.begin() + static_cast<std::ptrdiff_t>(plan.senses.size()));
    update_neurons(plan, z, brain.state.weights, brain.clamps);
    std::copy(z.begin() + static_cast<std::ptrdiff_t>(plan.senses.size()), z.end(), brain.state.neurons.begin());
    ++brain.state.thoughts;
  });
  changed_ = true;
}

std::vector<DriveSetting> Brains::take_drives() {
  std::vector<DriveSetting> all;
  if (!std::exchange(changed_, false)) return all;
  for (std::size_t i = 0; i < of_.size(); ++i) {
    if (!of_[i]) continue;
    for (const BrainPlan::Output& output : of_[i]->plan->outputs) {
      const float y = of_[i]->state.neurons[output.neuron];
      all.push_back({i, output.actuator, std::isfinite(y) ? std::clamp(y, -1.0f, 1.0f) : 0.0f});
    }
  }
  return all;
}

BrainState Brains::state(std::size_t robot) const { return of_[robot] ? of_[robot]->state : BrainState{}; }

void Brains::require_state(std::size_t robot, const BrainState& state) const {
  const BrainState wanted = of_[robot] ? state_at_start(*of_[robot]->plan) : BrainState{};
  require(state.neurons.size(), wanted.neurons.size(), "neurons");
  require(state.senses.size(), wanted.senses.size(), "sampled senses");
  require(state.weights.size(), wanted.weights.size(), "weights");
}

void Brains::set_state(std::size_t robot, const BrainState& state) {
  require_state(robot, state);
  if (!of_[robot]) return;
  of_[robot]->state = state;
  changed_ = true;
}

void Brains::set_weights(std::size_t robot, std::span<const float> weights) {
  require(weights.size(), of_[robot] ? of_[robot]->state.weights.size() : 0, "weights");
  if (of_[robot]) std::ranges::copy(weights, of_[robot]->state.weights.begin());
}

void Brains::clamp(std::size_t robot, std::size_t neuron, std::optional<float> value) {
  const std::size_t count = of_[robot] ? of_[robot]->plan->neurons.size() : 0;
  if (neuron >= count)
    throw std::out_of_range("neuron " + std::to_string(neuron) + ", the brain has " + std::to_string(count));
  auto& clamps = of_[robot]->clamps;
  std::erase_if(clamps, [&](const auto& known) { return known.first == neuron; });
  if (!value) return;
  clamps.emplace_back(static_cast<std::uint32_t>(neuron), *value);
  of_[robot]->state.neurons[neuron] = *value;
  changed_ = true;
}

}  // namespace mercury
