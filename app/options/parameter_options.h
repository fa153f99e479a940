// SPDX-License-Identifier: Apache-2.0
// The options of a struct that describes its parameters (mercury/parameters.h), and those of every command that
// measures robots.
#pragma once

#include <string>
#include <type_traits>

#include "app/options/command.h"
#include "app/options/option_values.h"
#include "mercury/parameters.h"
#include "mercury/trials.h"

namespace mercury {

// The text of a value as help gives defaults: "0.1", "1,0,0", "on".
std::string text_of(double value);
std::string text_of(float value);
std::string text_of(int value);
std::string text_of(std::uint64_t value);
std::string text_of(Vec3 value);
std::string text_of(bool value);

// How help shows a value: "KG/M3", or "X" for a number without unit, "N" for a whole one.
std::string form_of(std::string_view unit, bool whole = false);

// Adds an option for each parameter that `is_wanted(name)` accepts. It writes into the member of `values`, which must
// outlive the command; the default is what that has now.
template <class Struct, class Wanted>
void add_parameters(const Command& command, Struct& values, const char* group, Wanted is_wanted) {
  for_each_parameter(values, [&]<class Value>(const auto& parameter, Value& value) {
    if (!is_wanted(parameter.name)) return;
    const std::string help(parameter.help), note(parameter.default_note);
    if constexpr (std::is_same_v<Value, bool>) {
      // If it is on by default, the option switches it off.
      const std::string name = switch_of(parameter.name, value);
      const bool is_on = value;
      command
          .add_flag(
              name, [&value, is_on] { value = !is_on; }, is_on ? "Do not: " + help : help)
          .in_group(group);
    } else {
      const std::string usual = note.empty() ? "default " + text_of(value) : note;
      const std::string form =
          parameter.form.empty() ? form_of(parameter.unit, std::is_integral_v<Value>) : std::string(parameter.form);
      add_number(command, option_of(parameter.name), value, help + " (" + usual + ")", form).in_group(group);
    }
  });
}
template <class Struct>
void add_parameters(const Command& command, Struct& values, const char* group) {
  add_parameters(command, values, group, [](std::string_view) { return true; });
}

// The group of options that says how robots are tried.
inline constexpr const char* trials_group = "Trials";
// How often robots are tried, from when on, and what counts. They mean the same everywhere.
void add_trial_options(const Command& command, TrialSettings& trials);
// --mean, for commands whose trials have a score; add_evolution_trial_options() has it.
void add_mean_option(const Command& command, TrialSettings& trials);
// Sets what the options leave to others: without --jitter, several trials have the usual one, and one trial none.
void complete_trials(const Command& command, TrialSettings& trials);
// The trials of a run over which the command line has its say: what it leaves out is as there. No robot is stopped by
// racing. The time is that of the run, see SimulationOptions::seconds().
TrialSettings trials_over(const TrialSettings& of_run, const Command& command, const TrialSettings& given);
// The other parameters of trials, which only evolution has.
void add_evolution_trial_options(const Command& command, TrialSettings& trials);

}  // namespace mercury
