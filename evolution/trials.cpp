// SPDX-License-Identifier: Apache-2.0
#include "mercury/trials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <mutex>
#include <utility>

#include "evolution/trial_robot.h"
#include "mercury/error.h"
#include "mercury/generator.h"
#include "mercury/observables.h"
#include "mercury/quantity.h"
#include "mercury/random.h"
#include "mercury/real_body.h"
#include "robots/portable_math.h"

namespace mercury {
namespace {

// Robots are taken from their source for their first trial that is asked for, and kept until their last.
class TrialSource {
 public:
  TrialSource(RobotSource robots, const TrialSettings& settings, std::uint64_t seed)
      : robots_(std::move(robots)), settings_(settings), seed_(seed) {}

  std::shared_ptr<const Robot> robot_of(std::size_t index) {
    const auto trials = static_cast<std::size_t>(settings_.trials);
    const std::shared_ptr<const Robot> robot = taken(index / trials);
    if (!robot || trials_are_alike(settings_)) return robot;
    return std::make_shared<const Robot>(trial_robot(*robot, settings_, seed_, static_cast<int>(index % trials)));
  }

 private:
  struct Taken {
    std::mutex mutex;
    bool is_there = false;
    std::shared_ptr<const Robot> robot;
    std::exception_ptr error;
    int uses = 0;  // guarded by the mutex of all
  };

  std::shared_ptr<const Robot> taken(std::size_t index) {
    const std::shared_ptr<Taken> taken = entry(index);
    const std::lock_guard lock(taken->mutex);
    if (!taken->is_there) {
      try {
        taken->robot = robots_(index);
      } catch (const InputError&) {
        taken->error = std::current_exception();
      }
      taken->is_there = true;
    }
    if (taken->error) std::rethrow_exception(taken->error);
    return taken->robot;
  }

  std::shared_ptr<Taken> entry(std::size_t index) {
    const std::lock_guard lock(mutex_);
    const auto found = taken_.try_emplace(index, std::make_shared<Taken>()).first;
    std::shared_ptr<Taken> entry = found->second;
    if (++entry->uses == settings_.trials) taken_.erase(found);
    return entry;
  }

  const RobotSource robots_;
  const TrialSettings settings_;
  const std::uint64_t seed_;
  std::mutex mutex_;
  std::map<std::size_t, std::shared_ptr<Taken>> taken_;
};

// The first trial has the noise of a robot outside of trials.
std::uint64_t noise_seed_of(std::uint64_t seed, std::size_t trial) {
  constexpr std::uint64_t of_noise = 0x6e6f697365000u;
  return trial == 0 ? 0 : seed_of(seed_of(seed, trial), of_noise);
}

float shortest_rest_length(const Robot& robot) {
  if (robot.springs.empty()) return 0;
  return std::ranges::min(robot.springs, {}, &Spring::rest_length).rest_length;
}

bool may_be_tiny(const Robot& robot) {
  const Generator* generator = generator_of(robot);
  return generator && generator->may_be_tiny;
}
bool has_real_body(const Robot& robot) { return real_material_of(robot).has_value(); }

bool is_of_folding(const Limit& limit) { return quantities()[find_quantity(limit.quantity).value()].of_folding; }

constexpr Limit limits_table[] = {
    {.quantity = "strain", .value = &TrialSettings::strain_limit},
    {.quantity = "strained_share", .value = &TrialSettings::strained_limit, .applies = has_real_body},
    {.quantity = "inverted", .value = &TrialSettings::inverted_limit, .applies = has_real_body},
    {.quantity = "overlap", .value = &TrialSettings::overlap_limit},
    {.quantity = "masses",
     .value = &TrialSettings::least_masses,
     .is_least = true,
     .fate = Fate::too_small,
     .applies = may_be_tiny},
};

// Calls found(limit, by how much it was exceeded as a share of it) for each limit that a trial broke.
template <class Found>
void for_each_broken_limit(const Evaluation& evaluation, const EvaluationRequest& request,
                           const TrialSettings& settings, const Found& found) {
  const Trial trial{.robot = *evaluation.robot, .evaluation = evaluation, .configuration = request.configuration};
  for (const Limit& limit : limits_table) {
    const double accepted = settings.*limit.value;
    if (is_of_folding(limit) && accepted == 1) continue;
    const double value = quantities()[find_quantity(limit.quantity).value()].value(trial);
    if (limit.is_least ? value >= accepted : value <= accepted) continue;
    if (limit.applies && !limit.applies(trial.robot)) continue;
    const double beyond = std::abs(value - accepted) / (accepted > 0 ? accepted : 1);
    found(limit, std::isnan(beyond) ? std::numeric_limits<double>::infinity() : beyond);
  }
}

// What trials measure of a robot's folding: what a limit asks about.
std::function<MeasuredFolding(const Robot&)> measured_folding(const TrialSettings& settings) {
  if (settings.folding) return measure_all_folding;
  std::vector<const Limit*> asked;
  for (const Limit& limit : limits_table)
    if (is_of_folding(limit) && settings.*limit.value < 1) asked.push_back(&limit);
  if (asked.empty()) return nullptr;
  return [asked](const Robot& robot) {
    MeasuredFolding measured = MeasuredFolding::none;
    for (const Limit* limit : asked)
      if (!limit->applies || limit->applies(robot))
        measured = std::max(measured, limit->quantity == "inverted" ? MeasuredFolding::inverted : MeasuredFolding::all);
    return measured;
  };
}

}  // namespace

MeasuredFolding measure_all_folding(const Robot&) { return MeasuredFolding::all; }

EvaluationRequest trial_request(const TrialSettings& settings, const Configuration& configuration, std::uint64_t seed) {
  const auto steps_in = [&](double seconds) { return std::int64_t{std::llround(seconds / configuration.dt)}; };
  const std::int64_t settling = steps_in(settings.settle);
  EvaluationRequest request{.configuration = configuration,
                            .settling = settling,
                            .steps = steps_in(settings.seconds) - settling,
                            .sample_every = std::max<std::int64_t>(1, steps_in(trial_sample_period)),
                            .folding = measured_folding(settings),
                            .upright = settings.upright,
                            .hashes = true};
  const auto trials = static_cast<std::size_t>(settings.trials);
  if (begins_elsewhere(settings))
    request.start = [=, environment = configuration.environment](std::size_t index, const Robot& robot,
                                                                 std::span<Vec3> positions) {
      begin_trial(robot, settings, environment, seed, index % trials, positions);
    };
  if (settings.noise_per_trial && trials > 1)
    request.noise_seed = [=](std::size_t index) { return noise_seed_of(seed, index % trials); };
  return request;
}

RobotSource trial_source(RobotSource robots, const TrialSettings& settings, std::uint64_t seed) {
  if (settings.trials == 1 && trials_are_alike(settings)) return robots;
  const auto source = std::make_shared<TrialSource>(std::move(robots), settings, seed);
  return [source](std::size_t index) { return source->robot_of(index); };
}

void add_jitter(const Robot& robot, const TrialSettings& settings, std::uint64_t seed, std::size_t trial,
                std::span<Vec3> positions) {
  constexpr std::uint64_t of_jitter = 0x6a69747465720000u;  // other numbers than those of trial_robot()
  Random random(seed_of(seed_of(seed, trial), of_jitter));
  const double deviation = settings.jitter * static_cast<double>(shortest_rest_length(robot));
  std::vector<bool> is_fixed(positions.size());
  for (const std::uint16_t point : robot.fixed) is_fixed[point] = true;
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (float Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const double displacement = deviation * random.normal();
      if (!is_fixed[i]) positions[i].*axis = static_cast<float>(static_cast<double>(positions[i].*axis) + displacement);
    }
}

bool begins_elsewhere(const TrialSettings& settings) {
  return settings.jitter > 0 || settings.target_radius > 0 || settings.turned;
}

void begin_trial(const Robot& robot, const TrialSettings& settings, const Environment& environment, std::uint64_t seed,
                 std::size_t trial, std::span<Vec3> positions) {
  constexpr std::uint64_t of_turn = 0x7475726e0000u, of_place = 0x706c616365000u;
  const auto move = [&](const auto& moved) {
    for (Vec3& position : positions) {
      const std::array<double, 3> at =
          moved(static_cast<double>(position.x), static_cast<double>(position.y), static_cast<double>(position.z));
      position = {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])};
    }
  };
  std::array<double, 3> center = mean_over_masses(robot, positions);
  if (settings.turned) {
    const auto [sine, cosine] = wave(Random(seed_of(seed_of(seed, trial), of_turn)).uniform());
    move([&, s = sine, c = cosine](double x, double y, double z) -> std::array<double, 3> {
      const double dx = x - center[0], dy = y - center[1];
      return {center[0] + c * dx - s * dy, center[1] + s * dx + c * dy, z};
    });
  }
  if (settings.target_radius > 0) {
    Random random(seed_of(seed_of(seed, trial), of_place));
    const auto [sine, cosine] = wave(random.uniform());
    const double radius = settings.target_radius * (1 - settings.target_spread * random.uniform());
    const double up = settings.target_sphere ? random.uniform(-1, 1) : 0, along = std::sqrt(1 - up * up);
    const Vec3 target = environment.target;
    const std::array<double, 3> by{static_cast<double>(target.x) + radius * along * cosine - center[0],
                                   static_cast<double>(target.y) + radius * along * sine - center[1],
                                   static_cast<double>(target.z) + radius * up - center[2]};
    move([&](double x, double y, double z) -> std::array<double, 3> { return {x + by[0], y + by[1], z + by[2]}; });
  }
  if (settings.jitter > 0) add_jitter(robot, settings, seed, trial, positions);
}

std::span<const Limit> limits() { return limits_table; }

Fate fate_of(const Evaluation& evaluation, const EvaluationRequest& request, const TrialSettings& settings) {
  if (!evaluation.failure.empty()) return Fate::failed;
  if (evaluation.end.exploded) return Fate::exploded;
  Fate fate = evaluation.steps < request.steps ? Fate::stopped : Fate::sound;
  for_each_broken_limit(evaluation, request, settings, [&](const Limit& limit, double) {
    if (fate == Fate::stopped || fate == Fate::sound) fate = limit.fate;
  });
  return fate;
}

double violation_of(const Evaluation& evaluation, const EvaluationRequest& request, const TrialSettings& settings) {
  if (!evaluation.failure.empty() || evaluation.end.exploded) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for_each_broken_limit(evaluation, request, settings, [&](const Limit&, double beyond) { sum += beyond; });
  return sum;
}

}  // namespace mercury
