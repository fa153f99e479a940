// SPDX-License-Identifier: Apache-2.0
#include "app/options/parameter_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <initializer_list>

namespace mercury {
namespace {

bool is_one_of(std::initializer_list<std::string_view> names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

bool is_of_evolution(std::string_view name) { return is_one_of({"delay", "noise", "damage", "mean", "racing"}, name); }
// --seconds is an option of the simulation. The other two have none: they say what runs of earlier versions did.
bool is_of_every_measurement(std::string_view name) {
  return !is_of_evolution(name) && !is_one_of({"seconds", "median", "noise_per_trial"}, name);
}

}  // namespace

std::string text_of(double value) { return fmt::format("{}", value); }
std::string text_of(float value) { return fmt::format("{}", value); }
std::string text_of(int value) { return fmt::format("{}", value); }
std::string text_of(std::uint64_t value) { return fmt::format("{}", value); }
std::string text_of(Vec3 value) { return fmt::format("{},{},{}", value.x, value.y, value.z); }
std::string text_of(bool value) { return value ? "on" : "off"; }

std::string form_of(std::string_view unit, bool whole) {
  std::string form(!unit.empty() ? unit : whole ? "N" : "X");
  for (char& letter : form) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return form;
}

void add_trial_options(const Command& command, TrialSettings& trials) {
  add_parameters(command, trials, trials_group, is_of_every_measurement);
}

void add_mean_option(const Command& command, TrialSettings& trials) {
  add_parameters(command, trials, trials_group, [](std::string_view name) { return name == "mean"; });
}

void complete_trials(const Command& command, TrialSettings& trials) {
  if (!command.is_given("--jitter")) trials.jitter = trials.trials > 1 ? usual_jitter : 0;
}

TrialSettings trials_over(const TrialSettings& of_run, const Command& command, const TrialSettings& given) {
  TrialSettings trials = of_run;
  for_each_parameter(trials, [&](const auto& parameter, auto& value) {
    if (command.is_given(option_of(parameter.name))) value = given.*parameter.member;
  });
  trials.seconds = of_run.seconds;
  trials.racing = false;
  return trials;
}

void add_evolution_trial_options(const Command& command, TrialSettings& trials) {
  add_parameters(command, trials, trials_group, is_of_evolution);
}

}  // namespace mercury
