// SPDX-License-Identifier: Apache-2.0
#include "app/commands/run_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "app/commands/description.h"
#include "app/options/option_values.h"
#include "mercury/error.h"
#include "mercury/number_text.h"
#include "mercury/quantity.h"

namespace mercury {
namespace {

constexpr std::size_t usual_ancestors = 12, usual_best = 12;
constexpr const char* group = "Evolution";

// "size [m3]"; underscores of the name become spaces.
std::string title_of(const std::string& quantity) {
  std::string title = quantity;
  std::ranges::replace(title, '_', ' ');
  const auto found = find_quantity(quantity);
  const std::string_view unit = found ? quantities()[*found].unit : "";
  return unit.empty() ? title : fmt::format("{} [{}]", title, unit);
}

BoardAxis axis_of(const MapAxis& axis) {
  constexpr int most_ticks = 11;
  BoardAxis shown{.title = title_of(axis.quantity)};
  const int every = 1 + axis.cells / most_ticks;
  const double width = (axis.highest - axis.lowest) / axis.cells;
  for (int i = 0; i <= axis.cells; ++i)
    shown.ticks.push_back(i % every != 0 ? ""
                                         : render::tick_text(static_cast<float>(axis.lowest + i * width),
                                                             static_cast<float>(every * width)));
  return shown;
}

render::Legend legend_of(const RunSettings& settings, std::span<const std::optional<float>> values) {
  const std::string& objective = settings.evolution.objectives.front();
  const auto quantity = find_quantity(objective);
  render::Scale scale{.low = 1e30f, .high = -1e30f, .map = render::Colormap::viridis};
  for (const std::optional<float>& value : values) {
    if (!value) continue;
    scale.low = std::min(scale.low, *value);
    scale.high = std::max(scale.high, *value);
  }
  if (!(scale.low < scale.high)) scale = {.low = scale.low - 0.5f, .high = scale.low + 0.5f, .map = scale.map};
  return {.title = quantity ? objective : "score",
          .unit = std::string(quantity ? quantities()[*quantity].unit : ""),
          .scale = scale};
}

// The map of elites of a run as a table.
struct RunBoard {
  std::vector<std::uint64_t> robots;  // one per filled cell, in the order of board->cell_of
  std::shared_ptr<const Board> board;
  std::vector<std::string> notes;
};

// The map by its first two axes; each cell shows its best robot. Throws InputError for a run without a map.
RunBoard board_of(const RunHistory& run) {
  const RunSettings& settings = run.settings();
  const std::vector<MapAxis>& axes = settings.evolution.algorithm.axes;
  if (!algorithm_of(settings.evolution.algorithm).has_map)
    throw InputError(run.folder().string(),
                     fmt::format("has no map, since its algorithm is {}; --map takes runs of map-elites or cma-me",
                                 settings.evolution.algorithm.name));
  const auto drawn = std::span(axes).first(std::min<std::size_t>(2, axes.size()));
  const auto columns = static_cast<std::size_t>(axes[0].cells),
             rows = static_cast<std::size_t>(drawn.size() > 1 ? axes[1].cells : 1);
  auto board = std::make_shared<Board>();
  board->grid = {static_cast<int>(columns), static_cast<int>(rows)};
  board->values.resize(columns * rows);
  board->across = axis_of(axes[0]);
  if (drawn.size() > 1) board->upward = axis_of(axes[1]);
  RunBoard map;
  std::map<std::size_t, std::uint64_t> best;  // by cell
  for (const std::uint64_t id : run.living()) {
    const Individual& individual = run.individuals()[static_cast<std::size_t>(id)];
    const Assessment& assessment = individual.assessment;
    if (assessment.values.empty() || !(individual.score() > worst_score)) continue;
    const std::size_t cell = map_cell(drawn, assessment.values);
    const std::size_t place =
        (rows - 1 - cell / columns) * columns + cell % columns;  // the highest row is the upper one
    const auto score = static_cast<float>(individual.score());
    if (board->values[place] && *board->values[place] >= score) continue;
    board->values[place] = score;
    best[place] = id;
  }
  for (const auto& [cell, id] : best) {
    board->cell_of.push_back(cell);
    map.robots.push_back(id);
  }
  if (map.robots.empty()) throw InputError(run.folder().string(), "has no robot with a score in its map");
  board->legend = legend_of(settings, board->values);
  if (axes.size() > 2)
    map.notes.push_back(
        fmt::format("the map has {} axes; drawn by the first two, with the best robot of each cell", axes.size()));
  map.board = std::move(board);
  return map;
}

const Individual& individual(const RunHistory& run, std::uint64_t id) {
  return run.individuals()[static_cast<std::size_t>(id)];
}

// "best" or an id.
std::uint64_t id_from(const std::string& option, const std::string& text, const RunHistory& run) {
  if (text == "best") return run.living().front();
  const auto id = parse_number<std::uint64_t>(text);
  if (!id) throw InputError(option, fmt::format("\"{}\" is not accepted; give best, or the number of a robot", text));
  if (*id >= run.individuals().size())
    throw InputError(option, fmt::format("the run has no robot {}; give best, or a number from 0 to {}", text,
                                         run.individuals().size() - 1));
  return *id;
}

// The ancestors of a line that raised the score above that of all before them, at most `most` of them: those that
// raised it most, and always the first and the last of the line.
std::vector<std::uint64_t> steps_of(const RunHistory& run, std::vector<std::uint64_t> line, std::size_t most) {
  if (line.size() <= most) return line;
  std::vector<std::pair<double, std::size_t>> rises;  // and the place in the line
  double highest = individual(run, line.front()).score();
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const double score = individual(run, line[i]).score();
    if (!(score > highest)) continue;
    rises.emplace_back(score - highest, i);
    highest = score;
  }
  std::ranges::stable_sort(rises, std::greater{}, &std::pair<double, std::size_t>::first);
  rises.resize(std::min(rises.size(), most - std::min<std::size_t>(most, 2)));
  std::vector<std::size_t> places{0, line.size() - 1};
  for (const auto& rise : rises) places.push_back(rise.second);
  std::ranges::sort(places);
  std::vector<std::uint64_t> steps;
  for (const std::size_t place : places) steps.push_back(line[place]);
  return steps;
}

void add(RunFilm& film, Clip& clip, const RunHistory& run, std::uint64_t id, std::string caption) {
  film.ids.push_back(id);
  clip.robots.push_back(std::make_shared<const Robot>(run.grow(id)));
  clip.captions.push_back(std::move(caption));
}

// Zooms so that the clips show their robots at one scale, the largest with room to move.
void show_at_one_scale(std::vector<Clip>& clips) {
  constexpr float room = 0.7f;
  std::vector<float> radii;
  for (const Clip& clip : clips) radii.push_back(rest_bounds(*clip.robots.front()).radius());
  const float largest = *std::ranges::max_element(radii);
  for (std::size_t i = 0; i < clips.size() && largest > 0; ++i) clips[i].zoom = room * radii[i] / largest;
}

RunFilm film_of_champions(const RunHistory& run, std::size_t most) {
  RunFilm film;
  Clip& clip = film.clips.emplace_back();
  clip.title = fmt::format("{}\nthe best of generation {}", name_of_run(run), run.generations().back().number);
  for (const std::uint64_t id : run.living().first(std::min(most, run.living().size())))
    add(film, clip, run, id, fmt::format("{}\nrobot {}", score_text(run.settings(), individual(run, id)), id));
  return film;
}

RunFilm film_of_generations(const RunHistory& run, const std::string& list) {
  RunFilm film;
  Clip& clip = film.clips.emplace_back();
  for (const std::string_view text : split(list, ',')) {
    const int last = run.generations().back().number;
    const int number = text == "last" ? last : number_from<int>("--generation", text);
    if (number < 0 || number > last)
      throw InputError("--generation",
                       fmt::format("the run has no generation {}; give numbers from 0 to {}, or last", text, last));
    const std::uint64_t id = run.champion(number);
    add(film, clip, run, id,
        fmt::format("generation {}\n{}\nrobot {}", number, score_text(run.settings(), individual(run, id)), id));
  }
  return film;
}

RunFilm film_of_lineage(const RunHistory& run, std::uint64_t id, std::size_t most, bool at_once) {
  const std::vector<std::uint64_t> line = run.line_of(id), steps = steps_of(run, line, most);
  RunFilm film;
  if (at_once) film.clips.push_back({.title = fmt::format("{}\nthe ancestors of robot {}", name_of_run(run), id)});
  for (const std::uint64_t step : steps) {
    const Individual& ancestor = individual(run, step);
    const std::string score = score_text(run.settings(), ancestor);
    if (at_once) {
      add(film, film.clips.front(), run, step,
          fmt::format("generation {}\n{}\nrobot {}", ancestor.generation, score, step));
      continue;
    }
    Clip& clip = film.clips.emplace_back();
    add(film, clip, run, step, "");
    clip.title = fmt::format("generation {}\n{}\nrobot {}", ancestor.generation, score, step);
  }
  if (!at_once) show_at_one_scale(film.clips);
  film.notes.push_back(
      fmt::format("robot {} is the last of {} in its line; {}", id, line.size(),
                  steps.size() == line.size()
                      ? "all are shown"
                      : fmt::format("{} in whose step the score rose are shown (--ancestors)", steps.size())));
  return film;
}

RunFilm film_of_map(const RunHistory& run) {
  const RunBoard map = board_of(run);
  Clip clip;
  for (const std::uint64_t id : map.robots) clip.robots.push_back(std::make_shared<const Robot>(run.grow(id)));
  clip.title =
      fmt::format("{}\ngeneration {}: {} of {}, the best {}", name_of_run(run), run.generations().back().number,
                  map.robots.size(), count_text(static_cast<std::int64_t>(map.board->values.size()), "cell", "cells"),
                  score_text(run.settings(), individual(run, run.living().front())));
  return {.clips = {std::move(clip)}, .board = map.board, .notes = map.notes, .ids = map.robots};
}

}  // namespace

void RunFilmOptions::add_to(const Command& command) {
  const auto add = [](const Option& option) { option.in_group(group); };
  add(add_text(command, "--lineage", lineage_,
               "The ancestors of a robot of a run in order, of its best or of one with that number", "best|ROBOT"));
  add(add_number(
      command, "--ancestors", ancestors_,
      fmt::format("Of --lineage: at most that many, in whose step the score rose most (default {})", usual_ancestors),
      "N"));
  add(add_text(command, "--generation", generations_, "The best of these generations of a run, in a row", "N,N,..."));
  add(command.add_flag("--map", map_, "The map of elites of a run as a table, with a robot per cell"));
  add(add_number(command, "--best", best_,
                 fmt::format("How many of the living robots of a run, the best first (default {})", usual_best), "N"));
}

std::string RunFilmOptions::given() const {
  return !lineage_.empty()       ? "--lineage"
         : !generations_.empty() ? "--generation"
         : map_                  ? "--map"
         : ancestors_            ? "--ancestors"
         : best_                 ? "--best"
                                 : "";
}

void RunFilmOptions::validate() const {
  std::vector<std::string> kinds;
  if (!lineage_.empty()) kinds.push_back("--lineage");
  if (!generations_.empty()) kinds.push_back("--generation");
  if (map_) kinds.push_back("--map");
  if (best_) kinds.push_back("--best");
  if (kinds.size() > 1) throw InputError(kinds[1], fmt::format("not together with {}; give one of them", kinds[0]));
  if (ancestors_ && lineage_.empty()) throw InputError("--ancestors", "works with --lineage only");
  if (ancestors_ && *ancestors_ < 2)
    throw InputError("--ancestors",
                     fmt::format("{} is not accepted; give 2 or more, for the first and the last", *ancestors_));
  if (best_ && *best_ < 1) throw InputError("--best", "0 is not accepted; give 1 or more");
}

RunFilm RunFilmOptions::film(const RunHistory& run, const Room& room) const {
  if (run.generations().empty() || run.living().empty())
    throw InputError(run.folder().string(), "has no generation yet; try again when the first one is done");
  if (lineage()) {
    const std::size_t most = ancestors_.value_or(room.most_clips > 0 ? room.most_clips : usual_ancestors);
    if (room.most_clips > 0 && most > room.most_clips)
      throw InputError("--ancestors", fmt::format("{} do not fit into a contact sheet of {}", most, room.most_clips));
    return film_of_lineage(run, id_from("--lineage", lineage_, run), most, room.at_once);
  }
  if (!generations_.empty()) return film_of_generations(run, generations_);
  if (map_) return film_of_map(run);
  return film_of_champions(run, best_.value_or(usual_best));
}

std::string number_text(double value) {
  if (!std::isfinite(value)) return std::isnan(value) ? "undefined" : value > 0 ? "infinite" : "none";
  const double size = std::abs(value);
  return size >= 1e6 || size < 999.5 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

std::string score_text(const RunSettings& settings, const Individual& individual) {
  const Assessment& assessment = individual.assessment;
  if (assessment.fate != Fate::sound && assessment.fate != Fate::stopped) return std::string(name_of(assessment.fate));
  std::string text;
  const std::vector<std::string>& formulas = settings.evolution.objectives;
  for (std::size_t i = 0; i < formulas.size() && i < assessment.scores.size(); ++i) {
    const auto quantity = find_quantity(formulas[i]);
    const std::string_view unit = quantity ? quantities()[*quantity].unit : "";
    if (i > 0) text += ", ";
    // A unit says enough about a single objective; formulas and bare numbers need a word.
    if (formulas.size() > 1 || unit.empty()) text += quantity ? formulas[i] + " " : formulas.size() > 1 ? "" : "score ";
    text += number_text(assessment.scores[i]);
    if (!unit.empty()) text += fmt::format(" {}", unit);
  }
  return text;
}

std::string name_of_run(const RunHistory& run) {
  const std::filesystem::path path = std::filesystem::absolute(run.folder()).lexically_normal();
  return (path.filename().empty() ? path.parent_path() : path).filename().string();
}

}  // namespace mercury
