// SPDX-License-Identifier: Apache-2.0
// mercury check: whether the results of robots hold, at dt, dt/2 and dt/4, each with several jitters.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/output_files.h"
#include "app/base/progress.h"
#include "app/base/standard_streams.h"
#include "app/base/version.h"
#include "app/commands/description.h"
#include "app/commands/run_evaluation.h"
#include "app/options/command.h"
#include "app/options/option_values.h"
#include "app/options/output_options.h"
#include "app/options/parameter_options.h"
#include "app/options/robot_options.h"
#include "app/options/simulation_options.h"
#include "app/recording/configuration_json.h"
#include "evolution/run_folder/champion_checks.h"
#include "mercury/confirmation.h"
#include "mercury/cuda_devices.h"
#include "mercury/error.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

constexpr std::size_t longest_label = 60;

struct CheckOptions {
  RobotOptions robots;
  SimulationOptions simulation;
  TrialSettings trials = check_settings();
  OutputOptions output;
  std::string objective = "distance", csv;
  bool json = false;
  std::optional<Command> typed;  // the command line
};

struct CheckReport {
  std::vector<EnvironmentGroup> groups;  // one unless the robots are made for several environments
  TrialSettings trials;
  std::string objective, device;
  std::vector<RobotIdentity> identities;
  std::vector<Confirmation> robots;

  // Its solver, time step and device are those of all groups.
  const Configuration& configuration() const { return groups.front().configuration; }
  std::vector<std::string> environments() const {  // one per robot
    std::vector<std::string> names(robots.size());
    for (const auto& [configuration, members] : groups)
      for (const std::size_t robot : members) names[robot] = name_of(configuration.environment);
    return names;
  }

  std::size_t count(Verdict verdict) const {
    return static_cast<std::size_t>(std::ranges::count(robots, verdict, &Confirmation::verdict));
  }
};

// "dt", "dt_2", "dt_4"
std::string suffix_of(std::size_t step) { return step == 0 ? "dt" : fmt::format("dt_{}", 1 << step); }

std::string figures(const CheckedStep& step) {
  if (step.fate != Fate::sound) return std::string(name_of(step.fate));
  return fmt::format("{:.4f} ({:.4f} to {:.4f})", step.score.median, step.score.lower_quartile,
                     step.score.upper_quartile);
}

std::string table_of(const CheckReport& report) {
  const Configuration& configuration = report.configuration();
  const std::vector<std::string> environments = report.environments();
  std::vector<std::string> labels;
  std::size_t width = 5, environment_width = 0;  // of several environments, each robot's is shown
  for (std::size_t i = 0; i < report.robots.size(); ++i) {
    labels.push_back(printable(report.identities[i].name, longest_label));
    width = std::max(width, labels.back().size());
    if (report.groups.size() > 1) environment_width = std::max(environment_width, environments[i].size() + 2);
  }
  std::vector<std::string_view> names;
  for (const EnvironmentGroup& group : report.groups) names.push_back(name_of(group.configuration.environment));
  std::string text = fmt::format(
      "{}, {}, {} solver; {} of {} trials of {:g} s at each time step: {}\n\n{:>5}  {:<{}}{:<{}}", report.device,
      fmt::join(names, " and "), name_of(configuration.solver), report.objective, report.trials.trials,
      report.trials.seconds, report.trials.mean ? "mean (less and plus its standard error)" : "median (quartiles)",
      "index", "robot", width, environment_width > 0 ? "  in" : "", environment_width);
  for (std::size_t k = 0; k < checked_steps; ++k)
    text += fmt::format("  {:>30}", fmt::format("dt {:g} s", configuration.dt / static_cast<double>(1 << k)));
  text += "  verdict\n";
  for (std::size_t i = 0; i < report.robots.size(); ++i) {
    const Confirmation& robot = report.robots[i];
    text += fmt::format("{:>5}  {:<{}}{:<{}}", report.identities[i].index, labels[i], width,
                        environment_width > 0 ? "  " + environments[i] : "", environment_width);
    for (const CheckedStep& step : robot.steps) text += fmt::format("  {:>30}", figures(step));
    text += fmt::format("  {}{}{}\n", name_of(robot.verdict), robot.reason.empty() ? "" : ": ", robot.reason);
  }
  return text + fmt::format("\n{} of {} confirmed\n", report.count(Verdict::confirmed), report.robots.size());
}

std::string csv_of(const CheckReport& report) {
  const std::vector<std::string> environments = report.environments();
  std::string text = "index,name,file,random,environment,verdict,reason,objective";
  for (std::size_t k = 0; k < checked_steps; ++k)
    for (const char* name : {"fate", "median", "lower_quartile", "upper_quartile", "steady"})
      text += fmt::format(",{}_{}", name, suffix_of(k));
  text += '\n';
  for (std::size_t i = 0; i < report.robots.size(); ++i) {
    const auto& [index, name, file, random] = report.identities[i];
    const Confirmation& robot = report.robots[i];
    text += fmt::format("{},{},{},{},{},{},{},{}", index, csv_field(name), csv_field(file), csv_field(random),
                        csv_field(environments[i]), name_of(robot.verdict), csv_field(robot.reason),
                        csv_field(report.objective));
    for (const CheckedStep& step : robot.steps) {
      const bool is_sound = step.fate == Fate::sound;
      text += fmt::format(",{},{},{},{},{}", name_of(step.fate), csv_number(step.score.median),
                          csv_number(step.score.lower_quartile), csv_number(step.score.upper_quartile),
                          is_sound ? csv_number(step.steady_share) : "");
    }
    text += '\n';
  }
  return text;
}

std::string json_of(const CheckReport& report) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double value) { return std::isfinite(value) ? Json(value) : Json(); };
  const auto text = [](const std::string& value) { return value.empty() ? Json() : Json(value); };
  const std::vector<std::string> environments = report.environments();
  Json configurations;  // by the names of their environments
  for (const EnvironmentGroup& group : report.groups)
    configurations[std::string(name_of(group.configuration.environment))] = mercury::json_of(group.configuration);
  const bool is_one = report.groups.size() == 1;
  Json json{{"program", program_version},
            {is_one ? "configuration" : "configurations",
             is_one ? mercury::json_of(report.configuration()) : std::move(configurations)},
            {"device", report.device},
            {"objective", report.objective},
            {"trials", report.trials.trials},
            {"jitter", report.trials.jitter},
            {"seconds", report.trials.seconds},
            {"settle", report.trials.settle},
            {"confirmed", report.count(Verdict::confirmed)},
            {"robots", Json::array()}};
  for (std::size_t i = 0; i < report.robots.size(); ++i) {
    const auto& [index, name, file, random] = report.identities[i];
    const Confirmation& robot = report.robots[i];
    Json steps = Json::array();
    for (const CheckedStep& step : robot.steps)
      steps.push_back({{"dt", step.dt},
                       {"fate", name_of(step.fate)},
                       {"median", number(step.score.median)},
                       {"lower_quartile", number(step.score.lower_quartile)},
                       {"upper_quartile", number(step.score.upper_quartile)},
                       {"steady", step.fate == Fate::sound ? Json(step.steady_share) : Json()}});
    json["robots"].push_back({{"index", index},
                              {"name", text(name)},
                              {"file", text(file)},
                              {"random", text(random)},
                              {"environment", environments[i]},
                              {"verdict", name_of(robot.verdict)},
                              {"reason", text(robot.reason)},
                              {"steps", std::move(steps)}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void warn_of_undefined(const CheckReport& report, const Objective& objective) {
  const auto is_undefined = [](const Confirmation& robot) {
    return std::ranges::find(robot.steps, Fate::undefined, &CheckedStep::fate) != robot.steps.end();
  };
  const auto count = std::ranges::count_if(report.robots, is_undefined);
  if (count > 0) warn(fmt::format("{} for {} of {} robots", objective.undefined_text(), count, report.robots.size()));
}

// Fills in the verdicts and the device. Throws Interrupted.
void check_groups(CheckReport& report, const RobotSequence& robots, const Objective& objective, std::uint64_t seed) {
  const std::size_t per_robot = static_cast<std::size_t>(report.trials.trials) * 7;  // 1 + 2 + 4 times as many steps
  Progress progress("checking", "trials", static_cast<std::int64_t>(robots.count * per_robot));
  report.robots.resize(robots.count);
  std::size_t before = 0;  // trials of earlier groups
  for (const auto& [configuration, members] : report.groups) {
    const auto watch = [&](std::size_t done, std::size_t) {
      progress.update(static_cast<std::int64_t>(before + done));
      return !interrupted();
    };
    const auto member = [&](std::size_t i) { return i < members.size() ? robots.source(members[i]) : nullptr; };
    auto checked =
        check_robots(member, members.size(), configuration, report.trials, objective, seed, watch, &report.device);
    if (!checked) throw Interrupted();
    for (std::size_t i = 0; i < members.size(); ++i) report.robots[members[i]] = std::move((*checked)[i]);
    before += members.size() * per_robot;
  }
}

int check(const CheckOptions& options) {
  OutputFiles outputs = options.output.files();
  for (const std::filesystem::path& file : options.robots.files()) outputs.add_input(file);
  if (!options.csv.empty()) outputs.add_stream("--csv", options.csv);
  outputs.check();
  if (!options.output.dry_run()) outputs.make_folders();
  if (options.json && is_standard_output(options.csv))
    throw InputError("--csv", options.csv + " and --json both mean standard output; give --csv a file");
  options.simulation.check(options.robots.physics());
  Objective objective(options.objective);
  CheckReport report{.trials = options.trials, .objective = options.objective};
  report.trials.seconds = options.simulation.seconds();
  validate(report.trials);
  const RobotSequence robots = options.robots.sequence();
  std::uint64_t seed = options.robots.seed_or_default();
  if (robots.run) {  // as `evolve` checks its champions
    const EvolutionSettings& run = robots.run->evolution;
    report.trials = trials_over(check_settings_of(run), *options.typed, options.trials);
    report.trials.seconds = options.simulation.seconds(report.trials.seconds);
    validate(report.trials);
    if (!options.typed->is_given("--objective")) objective = Objective(run.objectives.front());
    if (!options.typed->is_given("--seed")) seed = check_seed_of(run);
    report.objective = objective.formula();
  }
  if (robots.run) {
    report.groups = {{.configuration = options.simulation.configuration_over(robots.run->evolution.configuration),
                      .members = std::vector<std::size_t>(robots.count)}};
    std::iota(report.groups.front().members.begin(), report.groups.front().members.end(), std::size_t{0});
  } else {
    report.groups = options.simulation.groups(robots.environment_per_robot(), robots.physics);
  }
  if (objective.is_custom())
    throw InputError("--objective", objective.formula() + " is a function of a program; give a formula");
  std::vector<std::string> environment_texts;
  for (const EnvironmentGroup& group : report.groups) {
    if (const std::string why = why_meaningless(objective, group.configuration.environment); !why.empty())
      throw InputError("--objective", why);
    environment_texts.push_back(environment_text(group.configuration));
  }
  if (options.output.dry_run())
    return print_dry_run(
        "check", {{"robots", size_text(robots)},
                  {"simulate",
                   time_text(report.configuration(), std::llround(report.trials.seconds / report.configuration().dt)) +
                       fmt::format(", {} trials, also at dt/2 and dt/4", report.trials.trials)},
                  {"in", fmt::format("{}", fmt::join(environment_texts, "; others in "))},
                  {"on", device_text(report.configuration().device)},
                  {"write", options.csv}});
  const double steps_of_trial = 7 * report.trials.seconds / report.configuration().dt;  // 1 + 2 + 4 times as many
  prepare_cuda_for(static_cast<double>(robots.count) * report.trials.trials * steps_of_trial);
  check_groups(report, robots, objective, seed);
  for (std::size_t i = 0; i < report.robots.size(); ++i) {
    report.identities.push_back(identity_of(robots, i));
    if (!report.robots[i].robot.empty()) report.identities.back().name = report.robots[i].robot;
  }
  if (!is_standard_output(options.csv)) {
    const std::string text = options.json ? json_of(report) : table_of(report);
    std::fwrite(text.data(), 1, text.size(), stdout);
    flush_standard_output();
  }
  if (!options.csv.empty()) write_results(options.csv, csv_of(report));
  warn_of_undefined(report, objective);
  return report.count(Verdict::confirmed) == report.robots.size() ? 0 : 1;
}

}  // namespace

void add_check_command(const Command& program, const Choose& choose) {
  auto options = std::make_shared<CheckOptions>();
  const Command command =
      program.add_command("check", "Say whether results of robots hold, at smaller time steps and with jitter");
  options->robots.add_to(command);
  add_text(command, "--objective", options->objective, "Formula of quantities that is to hold (default distance)",
           "FORMULA")
      .offering(names_of_quantities());
  add_text(command, "--csv", options->csv,
           "Also write one line per robot to this file; - prints it instead of the table", "FILE")
      .on_first_screen();
  options->output.add_to(command);
  command.add_flag("--json", options->json, "Print JSON instead of a table").on_first_screen();
  add_trial_options(command, options->trials);
  add_mean_option(command, options->trials);
  options->simulation.add_to(command);
  command.set_footer(
      "Each robot is tried at dt, dt/2 and dt/4, with --trials jitters at each, and gets one verdict:\n"
      "  confirmed      the result holds\n"
      "  not sound      at dt, it explodes or breaks a limit\n"
      "  chaotic        the quartiles are more than 20 % of the median apart\n"
      "  depends on dt  it is not sound at a smaller step, or the median at dt/4 is another one, by more than 10 %\n"
      "  transient      the speed does not last\n"
      "Without --environment, each robot is tried in the one that it is made for.\n"
      "docs/evaluation.md defines them. The exit status is 0 if all robots are confirmed, else 1.\n\n"
      "Examples:\n"
      "  mercury check sample:eel\n"
      "  mercury check swim/best --seconds 20 --csv champions.csv\n"
      "  mercury check swim --robot 57         (an individual of the run swim, as evolve checks champions)\n"
      "  mercury check my-robots --objective \"cruise_speed\" --environment land");
  command.when_chosen([options, choose, command] {
    choose([options, command] {
      options->typed = command;
      return options->robots.status(check(*options));
    });
  });
}

}  // namespace mercury
