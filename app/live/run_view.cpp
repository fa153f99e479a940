// SPDX-License-Identifier: Apache-2.0
#include "app/live/run_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "mercury/error.h"

namespace mercury {
namespace {

constexpr std::size_t most_best = 6;  // robots with which the scene starts

std::vector<Champion> champions_of(const RunHistory& history) {
  std::vector<Champion> champions;
  std::set<std::uint64_t> known;
  for (const GenerationSummary& generation : history.generations())
    if (generation.living > 0 && generation.best < history.individuals().size() && known.insert(generation.best).second)
      champions.push_back({generation.number, history.individuals()[generation.best]});
  return champions;
}

EliteMap map_of(const RunHistory& history) {
  const AlgorithmSettings& algorithm = history.settings().evolution.algorithm;
  const std::vector<MapAxis>& axes = algorithm.axes;
  if (!algorithm_of(algorithm).has_map) return {};
  EliteMap map;
  map.axes.assign(axes.begin(), axes.begin() + std::min<std::ptrdiff_t>(2, std::ssize(axes)));
  map.columns = static_cast<std::size_t>(axes[0].cells);
  map.rows = axes.size() > 1 ? static_cast<std::size_t>(axes[1].cells) : 1;
  map.cells.resize(map.columns * map.rows);
  for (const std::uint64_t id : history.living()) {
    const Individual& individual = history.individuals()[id];
    if (individual.assessment.values.empty()) continue;
    std::optional<Individual>& cell = map.cells[map_cell(axes, individual.assessment.values) % map.cells.size()];
    if (!cell || cell->score() < individual.score()) cell = individual;
  }
  return map;
}

// The best champions, filled up with the best of the living, without those that moved alike; the best first.
std::vector<std::uint64_t> best_of(const RunHistory& history, std::vector<Champion> champions) {
  std::ranges::stable_sort(champions, std::greater<>(),
                           [](const Champion& champion) { return champion.individual.score(); });
  std::vector<std::uint64_t> candidates;
  for (const Champion& champion : champions) candidates.push_back(champion.individual.id);
  candidates.insert(candidates.end(), history.living().begin(), history.living().end());
  std::vector<std::uint64_t> best;
  std::set<std::uint64_t> seen;
  for (const std::uint64_t id : candidates) {
    if (best.size() == most_best) break;
    const Individual& individual = history.individuals()[id];
    if (individual.score() > worst_score && seen.insert(individual.assessment.hash).second) best.push_back(id);
  }
  std::ranges::stable_sort(best, std::greater<>(), [&](std::uint64_t id) { return history.individuals()[id].score(); });
  return best;
}

}  // namespace

std::size_t EliteMap::filled() const {
  return static_cast<std::size_t>(std::ranges::count_if(cells, [](const auto& cell) { return cell.has_value(); }));
}

// Returns whether anything has changed. A run whose run.toml was written again is read from the start: perhaps it is
// another run.
bool RunReader::update() {
  if (!is_run_folder(folder_)) throw InputError(folder_.string(), "there is no run in this folder: it has no run.toml");
  const auto time = std::filesystem::last_write_time(folder_ / "run.toml");
  if (!failed_ && history_ && time == settings_time_) return history_->refresh();
  history_.emplace(folder_);
  settings_time_ = time;
  ++openings_;
  return true;
}

std::shared_ptr<const RunView> RunReader::read() {
  try {
    const bool changed = update();
    failed_ = false;
    if (!changed) return nullptr;
  } catch (...) {
    failed_ = true;
    throw;
  }
  auto view = std::make_shared<RunView>();
  view->folder = folder_;
  view->opening = openings_;
  view->settings = history_->settings().evolution;
  view->generations.assign(history_->generations().begin(), history_->generations().end());
  view->champions = champions_of(*history_);
  view->map = map_of(*history_);
  view->best = best_of(*history_, view->champions);
  return view;
}

const RunHistory& RunReader::history(std::uint64_t id) const {
  if (!history_ || id >= history_->individuals().size())
    throw InputError(folder_.string(), fmt::format("there is no individual {} in this run", id));
  return *history_;
}

Family RunReader::family(std::uint64_t id) const {
  const RunHistory& run = history(id);
  const std::span<const Individual> all = run.individuals();
  Family family{.died = run.died(id)};
  for (const std::uint64_t ancestor : run.line_of(id)) {
    FamilyMember member{.individual = all[ancestor]};
    if (member.individual.parents.size() > 1) member.other_parent = all[member.individual.parents[1]];
    family.line.push_back(std::move(member));
  }
  std::ranges::reverse(family.line);
  for (const Individual& individual : all)
    if (std::ranges::find(individual.parents, id) != individual.parents.end()) ++family.children;
  return family;
}

Robot RunReader::grow(std::uint64_t id) const { return history(id).grow(id); }

}  // namespace mercury
