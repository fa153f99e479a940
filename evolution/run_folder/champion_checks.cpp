// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/champion_checks.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <string>

#include "evolution/run_folder/derived_files.h"
#include "mercury/csv.h"
#include "mercury/error.h"
#include "mercury/number_text.h"
#include "mercury/random.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

constexpr std::size_t head_fields = 4, step_fields = 6;

template <class Number>
bool parse(const std::string& text, Number& number) {
  const auto parsed = parse_number<Number>(text);
  number = parsed.value_or(number);
  return parsed.has_value();
}

// Nothing if the line is none of checks.csv.
std::optional<std::pair<std::uint64_t, Confirmation>> check_of(const std::string& line) {
  const std::vector<std::string> fields = csv_fields(line);
  if (fields.size() != head_fields + checked_steps * step_fields) return std::nullopt;
  std::uint64_t id = 0;
  const std::optional<Verdict> verdict = verdict_named(fields[2]);
  if (!parse(fields[0], id) || !verdict) return std::nullopt;
  Confirmation check{.robot = "", .verdict = *verdict, .reason = fields[3], .steps = {}};
  for (std::size_t k = 0; k < checked_steps; ++k) {
    const std::string* field = &fields[head_fields + k * step_fields];
    CheckedStep& step = check.steps[k];
    const std::optional<Fate> fate = fate_named(field[1]);
    if (!fate || !parse(field[0], step.dt)) return std::nullopt;
    step.fate = *fate;
    if (*fate != Fate::sound) continue;
    if (!parse(field[2], step.score.median) || !parse(field[3], step.score.lower_quartile) ||
        !parse(field[4], step.score.upper_quartile) || !parse(field[5], step.steady_share))
      return std::nullopt;
  }
  return std::pair(id, std::move(check));
}

}  // namespace

std::vector<std::pair<std::uint64_t, int>> champions_of(const RunHistory& run) {
  std::vector<std::pair<std::uint64_t, int>> champions;
  std::set<std::uint64_t> known;
  for (const GenerationSummary& generation : run.generations())
    if (generation.living > 0 && known.insert(generation.best).second)
      champions.emplace_back(generation.best, generation.number);
  return champions;
}

Checks read_checks(const std::filesystem::path& run) {
  Checks checks;
  const std::filesystem::path path = run / checks_name;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return checks;
  const std::string text = read_whole_file(path);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (auto check = check_of(text.substr(begin, end - begin))) checks.insert(*std::move(check));
    begin = end + 1;
  }
  return checks;
}

void write_checks(const RunHistory& run, const Checks& checks) {
  CsvLines csv;
  for (const char* name : {"id", "generation", "verdict", "reason"}) csv.cell(name);
  for (const char* suffix : {"_dt", "_dt_2", "_dt_4"}) {
    csv.cell("step" + std::string(suffix));
    for (const char* name : {"fate", "median", "lower_quartile", "upper_quartile", "steady"})
      csv.cell(name + std::string(suffix));
  }
  csv.end_line();
  for (const auto& [id, generation] : champions_of(run)) {
    const auto found = checks.find(id);
    if (found == checks.end()) continue;
    const Confirmation& check = found->second;
    csv.cell(id).cell(generation).cell(name_of(check.verdict)).cell(check.reason);
    for (const CheckedStep& step : check.steps) {
      csv.cell(step.dt).cell(name_of(step.fate));
      for (const double value :
           {step.score.median, step.score.lower_quartile, step.score.upper_quartile, step.steady_share})
        csv.cell(step.fate == Fate::sound ? shortest_text(value) : std::string());
    }
    csv.end_line();
  }
  write_whole_file(run.folder() / checks_name, csv.text());
}

TrialSettings check_settings_of(const EvolutionSettings& settings) {
  TrialSettings trials = settings.trials;
  const TrialSettings usual = check_settings();
  trials.trials = std::max(trials.trials, usual.trials);
  trials.jitter = std::max(trials.jitter, usual.jitter);
  trials.delay = 0;
  trials.noise = 0;
  trials.damage = 0;
  trials.racing = false;
  trials.median = true;
  trials.noise_per_trial = true;
  return trials;
}

std::uint64_t check_seed_of(const EvolutionSettings& settings) {
  constexpr std::uint64_t of_checks = 0x636865636b730000u;
  return seed_of(settings.seed, of_checks);
}

ChampionChecks::ChampionChecks(const RunFolder& run, int threads)
    : run_(run), configuration_(run.history().settings().evolution.configuration),
      trials_(check_settings_of(run.history().settings().evolution)),
      objective_(run.history().settings().evolution.objectives.front()),
      seed_(check_seed_of(run.history().settings().evolution)), checks_(read_checks(run.history().folder())) {
  configuration_.device = {.kind = DeviceKind::cpu, .threads = threads};
  worker_ = std::thread([this] { work(); });
}

ChampionChecks::~ChampionChecks() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  worker_.join();
}

void ChampionChecks::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
    if (stopping_) return;
    const std::vector<Waiting> batch = std::exchange(waiting_, {});
    lock.unlock();
    std::optional<std::vector<Confirmation>> found;
    try {
      found = check_robots([&](std::size_t i) { return i < batch.size() ? batch[i].robot : nullptr; }, batch.size(),
                           configuration_, trials_, objective_, seed_,
                           [&](std::size_t, std::size_t) {
                             const std::lock_guard guard(mutex_);
                             return !stopping_;
                           });
    } catch (const std::exception& error) {  // such as too little memory: the next start of the program tries again
      found = std::vector<Confirmation>(batch.size());
      for (Confirmation& one : *found) one.reason = error.what();
    }
    lock.lock();
    if (!found) return;
    for (std::size_t i = 0; i < batch.size(); ++i) results_[batch[i].id] = std::move((*found)[i]);
    left_ -= batch.size();
    changed_.notify_all();
  }
}

void ChampionChecks::update() {
  const RunHistory& history = run_.history();
  const std::span<const GenerationSummary> generations = history.generations();
  for (; generations_ < generations.size(); ++generations_) {
    const GenerationSummary& generation = generations[generations_];
    const std::uint64_t id = generation.best;
    if (generation.living == 0 || checks_.contains(id) || !known_.emplace(id, true).second) continue;
    Waiting champion{.id = id, .robot = nullptr};
    Confirmation failed;
    try {
      champion.robot = std::make_shared<const Robot>(history.grow(id));
    } catch (const InputError& error) {
      failed.reason = error.what();
    }
    const std::lock_guard lock(mutex_);
    if (champion.robot) {
      waiting_.push_back(std::move(champion));
      ++left_;
    } else {
      results_[id] = std::move(failed);
    }
  }
  changed_.notify_all();
  take_results();
}

void ChampionChecks::take_results() {
  Checks results;
  {
    const std::lock_guard lock(mutex_);
    results.swap(results_);
  }
  if (results.empty()) return;
  checks_.merge(std::move(results));
  write_checks(run_.history(), checks_);
  write_champions(run_.history());
}

bool ChampionChecks::finish(const std::function<bool(std::size_t left)>& watch) {
  update();
  std::unique_lock lock(mutex_);
  bool goes_on = true;
  while (left_ > 0 && goes_on) {
    const std::size_t left = left_;
    lock.unlock();
    goes_on = watch(left);
    lock.lock();
    if (goes_on) changed_.wait_for(lock, std::chrono::milliseconds(100));
  }
  const bool done = left_ == 0;
  lock.unlock();
  take_results();
  return done;
}

}  // namespace mercury
