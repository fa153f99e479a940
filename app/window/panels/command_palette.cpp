// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/command_palette.h"
#define GLFW_INCLUDE_NONE

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "app/live/measurements.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "app/options/trial_start.h"
#include "app/scene/color_quantity.h"
#include "app/window/panels/commands.h"
#include "app/window/toolkit/key_bindings.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

// A switch of the view.
struct Switch {
  const char* name;
  bool& (*of)(ViewSettings& view);
};
constexpr Switch switches[] = {
    {"skin", [](ViewSettings& view) -> bool& { return view.shown.skin; }},
    {"springs", [](ViewSettings& view) -> bool& { return view.shown.springs; }},
    {"masses", [](ViewSettings& view) -> bool& { return view.shown.masses; }},
    {"rounded skin of many robots", [](ViewSettings& view) -> bool& { return view.smooth; }},
    {"faceted skin", [](ViewSettings& view) -> bool& { return view.faceted; }},
    {"footprints", [](ViewSettings& view) -> bool& { return view.footprints; }},
    {"path", [](ViewSettings& view) -> bool& { return view.shown.path; }},
    {"names", [](ViewSettings& view) -> bool& { return view.shown.labels; }},
    {"legend", [](ViewSettings& view) -> bool& { return view.shown.legend; }},
    {"clock", [](ViewSettings& view) -> bool& { return view.shown.clock; }},
    {"scale bar", [](ViewSettings& view) -> bool& { return view.shown.scale_bar; }},
    {"drag arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.drag; }},
    {"lift arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.lift; }},
    {"velocity arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.velocity; }},
    {"gravity arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.gravity; }},
    {"contact arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.contact; }},
    {"force arrows", [](ViewSettings& view) -> bool& { return view.shown.arrows.force; }},
    {"logarithmic color scale", [](ViewSettings& view) -> bool& { return view.log_scale; }},
    {"color scale of all robots", [](ViewSettings& view) -> bool& { return view.scale_all; }},
};

// A value of a list of the view.
struct Choice {
  const char* name;
  const char* words;  // that find it as well
  void (*choose)(ViewSettings& view);
  bool (*chosen)(const ViewSettings& view);
};
template <Layout layout>
constexpr Choice layout_choice(const char* name, const char* words) {
  return {name, words, [](ViewSettings& view) { set_layout(view, layout); },
          [](const ViewSettings& view) { return view.layout == layout; }};
}
template <render::Theme theme>
constexpr Choice theme_choice(const char* name) {
  return {name, "appearance background", [](ViewSettings& view) { view.theme = theme; },
          [](const ViewSettings& view) { return view.theme == theme; }};
}
template <int axis>
constexpr Choice cut_choice(const char* name) {
  return {name, "section inside open",
          [](ViewSettings& view) {
            if (!view.cut) view.cut = render::Cut{.below = true};
            view.cut->axis = axis;
          },
          [](const ViewSettings& view) { return view.cut && view.cut->axis == axis; }};
}
constexpr Choice choices[] = {
    layout_choice<Layout::cells>("layout cells: robots stay", "arrange"),
    layout_choice<Layout::grid>("layout grid: robots travel", "arrange"),
    layout_choice<Layout::race>("layout race: one lane each", "arrange track"),
    theme_choice<render::Theme::dark>("theme dark"),
    theme_choice<render::Theme::light>("theme light"),
    cut_choice<0>("cut the robots open across x"),
    cut_choice<1>("cut the robots open across y"),
    cut_choice<2>("cut the robots open across z"),
    {"no cut", "section close", [](ViewSettings& view) { view.cut.reset(); },
     [](const ViewSettings& view) { return !view.cut; }},
};

// As one edit that can be undone.
void change_configuration(PanelContext& context, const std::function<void(Configuration&)>& change) {
  Configuration configuration = context.scene.document().configuration;
  change(configuration);
  context.scene.end_edit();
  context.scene.parameters().set_configuration(configuration);
  context.scene.end_edit();
}

void add_switches(PanelContext& context, std::vector<PaletteEntry>& entries) {
  ViewSettings view = context.scene.view();
  for (const Switch& one : switches)
    entries.push_back({fmt::format("show {}", one.name), "View", one.of(view) ? "on" : "off", [&context, &one] {
                         change_view(context, [&](ViewSettings& now) { one.of(now) = !one.of(now); });
                       }});
  for (const Choice& choice : choices)
    entries.push_back({choice.name, "View", choice.chosen(view) ? "on" : "",
                       [&context, &choice] { change_view(context, choice.choose); }, choice.words});
  for (const ColorQuantity& quantity : color_quantities())
    if (quantity.exists_in(context.scene.document().configuration.environment))
      entries.push_back(
          {fmt::format("color by {}", quantity.name), "View", view.color == &quantity ? "on" : "",
           [&context, &quantity] { change_view(context, [&](ViewSettings& now) { color_by(now, quantity); }); }});
  for (int i = 0; i < render::colormap_count; ++i) {
    const auto map = static_cast<render::Colormap>(i);
    entries.push_back({fmt::format("color map {}", render::name_of(map)), "View", view.colormap == map ? "on" : "",
                       [&context, map] { change_view(context, [&](ViewSettings& now) { now.colormap = map; }); },
                       "colormap palette"});
  }
  for (const render::Quality quality :
       {render::Quality::automatic, render::Quality::low, render::Quality::medium, render::Quality::high})
    entries.push_back({fmt::format("quality {}", render::name_of(quality)), "View",
                       context.preferences.quality == quality ? "on" : "",
                       [&context, quality] { context.preferences.quality = quality; }, "drawing graphics"});
}

void add_camera(PanelContext& context, std::vector<PaletteEntry>& entries) {
  OrbitController& camera = context.camera;
  const auto add_mode = [&](CameraMode mode, const char* name, const char* words) {
    entries.push_back(
        {name, "Camera", camera.mode() == mode ? "on" : "", [&camera, mode] { camera.set_mode(mode); }, words});
  };
  add_mode(CameraMode::still, "camera free: the mouse moves it", "still orbit");
  add_mode(CameraMode::group, "camera group: keeps all robots in view", "fit");
  add_mode(CameraMode::follow, "camera follow: the selected robot, or the group", "track");
  add_mode(CameraMode::turntable, "camera circle: around the group", "turntable spin rotate");
  add_mode(CameraMode::top, "camera top: looks straight down", "above");
  entries.push_back({"zoom in", "Camera", "", [&camera] { camera.zoom(0.7f); }, "closer nearer magnify"});
  entries.push_back({"zoom out", "Camera", "", [&camera] { camera.zoom(1 / 0.7f); }, "farther smaller"});
}

// The finite numbers of a text, with blanks or commas between them; none if it holds anything else.
std::optional<std::vector<double>> numbers_of(std::string text) {
  std::ranges::replace(text, ',', ' ');
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (char* end = nullptr;; at = end) {
    const double number = std::strtod(at, &end);
    if (end == at) break;
    if (!std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
  }
  const bool rest = std::string_view(at).find_first_not_of(' ') != std::string_view::npos;
  return rest ? std::nullopt : std::optional(numbers);
}

// Asks for as many numbers as there are `now` and sets them. Every configuration that validate() refuses is reported.
void ask_numbers(PanelContext& context, const std::string& name, const std::vector<double>& now,
                 const std::string& unit, const std::function<void(const std::vector<double>&)>& set) {
  std::string text;
  for (const double value : now) text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ", value);
  const std::string what = now.size() == 3 ? "x, y and z" : "Value";
  context.dialogs.ask_text(
      name, unit.empty() ? what + ":" : fmt::format("{} in {}:", what, unit), text, "Set",
      [&context, set, count = now.size()](const std::string& answer) {
        const std::optional<std::vector<double>> numbers = numbers_of(answer);
        if (!numbers || numbers->size() != count) {
          context.toasts.show(Tone::warning, count == 3 ? fmt::format("\"{}\": give three numbers, as 0, 0, -2", answer)
                                                        : fmt::format("\"{}\" is no number", answer));
          return;
        }
        context.scene.end_edit();
        set(*numbers);
        context.scene.end_edit();
      });
}

void ask_number(PanelContext& context, const std::string& name, double now, const std::string& unit,
                const std::function<void(double)>& set) {
  ask_numbers(context, name, {now}, unit, [set](const std::vector<double>& values) { set(values.front()); });
}

void add_number(PanelContext& context, std::vector<PaletteEntry>& entries, const std::string& name, double now,
                const std::string& unit, std::function<void(Configuration&, double)> set) {
  entries.push_back({name, "Tune", fmt::format("{:.4g}{}{}", now, unit.empty() ? "" : " ", unit),
                     [&context, name, now, unit, set = std::move(set)] {
                       ask_number(context, name, now, unit, [&context, set](double value) {
                         Configuration configuration = context.scene.document().configuration;
                         set(configuration, value);
                         context.scene.parameters().set_configuration(configuration);
                       });
                     }});
}

// A number of the view, within limits.
void add_view_number(PanelContext& context, std::vector<PaletteEntry>& entries, const std::string& name, double now,
                     const std::string& unit, std::pair<double, double> limits, std::function<void(double)> set) {
  const bool automatic = name.ends_with("automatic)") && now == 0;
  entries.push_back({name, "View",
                     automatic ? "automatic" : fmt::format("{:.4g}{}{}", now, unit.empty() ? "" : " ", unit),
                     [&context, name, now, unit, limits, set = std::move(set)] {
                       ask_number(context, name, now, unit, [&context, name, limits, set](double value) {
                         if (value >= limits.first && value <= limits.second) return set(value);
                         context.toasts.show(Tone::warning, fmt::format("{}: {:g} is not accepted; give {:g} to {:g}",
                                                                        name, value, limits.first, limits.second));
                       });
                     }});
}

void add_view_numbers(PanelContext& context, std::vector<PaletteEntry>& entries) {
  const ViewSettings& view = context.scene.view();
  add_view_number(context, entries, "columns of the grid (0 = automatic)",
                  view.grid ? static_cast<double>(view.grid->columns) : 0, "", {0, 1000}, [&context](double value) {
                    const auto columns = static_cast<int>(value),
                               robots = static_cast<int>(context.scene.robots().entries().size());
                    change_view(context, [&](ViewSettings& now) {
                      now.grid = columns > 0
                                     ? std::optional(Grid{columns, std::max(1, (robots + columns - 1) / columns)})
                                     : std::nullopt;
                    });
                  });
  constexpr double degrees = 57.29578;
  add_view_number(context, entries, "field of view", degrees * static_cast<double>(context.camera.field_of_view),
                  "degrees", {5, 90},
                  [&context](double value) { context.camera.field_of_view = static_cast<float>(value / degrees); });
  add_view_number(context, entries, "length of arrows", static_cast<double>(view.shown.arrows.length), "", {0.01, 100},
                  [&context](double value) {
                    change_view(context,
                                [&](ViewSettings& now) { now.shown.arrows.length = static_cast<float>(value); });
                  });
  add_view_number(context, entries, "speed", context.scene.time().speed(), "times real time", {1e-3, 1e3},
                  [&context](double value) { context.scene.time().set_speed(value); });
}

// Where robots made for water are torn apart, the safe variants come first.
void add_environments(PanelContext& context, std::vector<PaletteEntry>& entries) {
  const Configuration& configuration = context.scene.document().configuration;
  const std::vector<EnvironmentOffer> offers = environment_offers(configuration, has_water_robots(context.scene));
  for (const EnvironmentOffer& offer : offers) {
    const bool is_now = !offer.adjust && name_of(configuration.environment) == offer.environment;
    const bool has_safe = !offer.adjust && std::ranges::any_of(offers, [&](const EnvironmentOffer& other) {
      return other.adjust && other.environment == offer.environment;
    });
    entries.push_back({fmt::format("environment {}{}", offer.name,
                                   has_safe ? ", solver and step kept: tears robots made for water" : ""),
                       "Tune", is_now ? "on" : "",
                       [&context, offer] {
                         change_configuration(context, [&](Configuration& changed) {
                           changed.environment = environment_named(offer.environment);
                           if (offer.adjust) offer.adjust(changed);
                         });
                       },
                       has_water(environment_named(offer.environment)) ? "world sea water swim underwater"
                                                                       : "world ground floor walk crawl"});
  }
}

// Where robots begin.
void add_start(PanelContext& context, std::vector<PaletteEntry>& entries) {
  const TrialStart start = context.scene.document().start;
  const auto change = [&context](const std::function<void(TrialStart&)>& set) {
    TrialStart changed = context.scene.document().start;
    set(changed);
    context.scene.parameters().set_start(changed);
  };
  constexpr std::string_view words = "start brain trial";
  for_each_parameter(start.trials, [&]<class Value>(const auto& parameter, const Value& value) {
    if (!is_of_start(parameter.name)) return;
    const std::string name = "robots begin: " + label_of(parameter.name);
    const auto member = parameter.member;
    if constexpr (std::is_same_v<Value, bool>) {
      entries.push_back(
          {name, "Tune", value ? "on" : "off",
           [change, member] { change([&](TrialStart& now) { now.trials.*member = !(now.trials.*member); }); },
           std::string(words)});
    } else if constexpr (std::is_same_v<Value, double>) {
      const std::string unit = unit_text(parameter.unit);
      entries.push_back({name, "Tune", fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit),
                         [&context, change, member, name, value, unit] {
                           ask_number(context, name, value, unit, [change, member](double number) {
                             change([&](TrialStart& now) { now.trials.*member = number; });
                           });
                         },
                         std::string(words)});
    }
  });
  const auto seed = static_cast<double>(start.seed);
  entries.push_back({"robots begin: seed", "Tune", fmt::format("{:.0f}", seed),
                     [&context, change, seed] {
                       ask_number(context, "robots begin: seed", seed, "", [&context, change](double number) {
                         if (number < 0 || number > 1e9 || number != std::floor(number))
                           return context.toasts.show(Tone::warning,
                                                      "robots begin: seed: give a whole number, 0 to 1e9");
                         change([&](TrialStart& now) { now.seed = static_cast<std::uint64_t>(number); });
                       });
                     },
                     std::string(words)});
}

void add_parameters(PanelContext& context, std::vector<PaletteEntry>& entries) {
  const Configuration& configuration = context.scene.document().configuration;
  add_number(context, entries, "time step", 1000 * configuration.dt, "ms",
             [](Configuration& changed, double value) { changed.dt = value / 1000; });
  add_number(context, entries, "damping", configuration.damping, "1/s",
             [](Configuration& changed, double value) { changed.damping = value; });
  for (const Solver solver : {Solver::force, Solver::xpbd})
    entries.push_back({fmt::format("solver {}", name_of(solver)), "Tune", configuration.solver == solver ? "on" : "",
                       [&context, solver] {
                         change_configuration(context, [&](Configuration& changed) { changed.solver = solver; });
                       }});
  add_environments(context, entries);
  for_each_parameter(configuration.environment, [&]<class Value>(const auto& parameter, const Value& value) {
    const std::string label = label_of(parameter.name), unit = unit_text(parameter.unit);
    if constexpr (std::is_same_v<Value, bool>) {
      entries.push_back({label, "Tune", value ? "on" : "off", [&context, name = std::string(parameter.name)] {
                           change_configuration(context, [&](Configuration& changed) {
                             for_each_parameter(changed.environment,
                                                [&]<class Other>(const auto& other, Other& target) {
                                                  if constexpr (std::is_same_v<Other, bool>)
                                                    if (other.name == name) target = !target;
                                                });
                           });
                         }});
    }
    if constexpr (std::is_same_v<Value, float>) {
      add_number(context, entries, label, static_cast<double>(value), unit,
                 [name = std::string(parameter.name)](Configuration& changed, double number) {
                   for_each_parameter(changed.environment, [&]<class Other>(const auto& other, Other& target) {
                     if constexpr (std::is_same_v<Other, float>)
                       if (other.name == name) target = static_cast<float>(number);
                   });
                 });
    }
    if constexpr (std::is_same_v<Value, Vec3>) {
      const std::vector<double> now{value.x, value.y, value.z};
      entries.push_back(
          {label, "Tune",
           fmt::format("{:.4g}, {:.4g}, {:.4g}{}{}", now[0], now[1], now[2], unit.empty() ? "" : " ", unit),
           [&context, label, now, unit, name = std::string(parameter.name)] {
             ask_numbers(context, label, now, unit, [&context, name](const std::vector<double>& numbers) {
               Configuration changed = context.scene.document().configuration;
               for_each_parameter(changed.environment, [&]<class Other>(const auto& other, Other& target) {
                 if constexpr (std::is_same_v<Other, Vec3>)
                   if (other.name == name)
                     target = {static_cast<float>(numbers[0]), static_cast<float>(numbers[1]),
                               static_cast<float>(numbers[2])};
               });
               context.scene.parameters().set_configuration(changed);
             });
           }});
    }
  });
}

}  // namespace

void CommandPalette::open(std::function<std::vector<PaletteEntry>()> list) {
  entries_ = list();
  query_.clear();
  open_ = just_opened_ = true;
  accepted_ = false;
  moved_ = 0;
  search();
}

// First what has the words of the query in its name, then what has them at all. If nothing has them, what has their
// letters: beside words, letters find little but noise.
void CommandPalette::search() {
  constexpr int word = 100'000;  // more than letters can score
  std::vector<std::pair<int, std::size_t>> scores;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const PaletteEntry& entry = entries_[i];
    const std::string whole = fmt::format("{} {} {}", entry.group, entry.name, entry.words);
    const int words = words_match(query_, entry.name) ? 2 : words_match(query_, whole) ? 1 : 0;
    const auto score = fuzzy_match(query_, words == 1 ? whole : entry.name);
    if (score) scores.emplace_back(-(words * word + *score), i);
  }
  if (std::ranges::any_of(scores, [](const auto& score) { return score.first < -word / 2; }))
    std::erase_if(scores, [](const auto& score) { return score.first >= -word / 2; });
  std::ranges::stable_sort(scores, {}, &std::pair<int, std::size_t>::first);
  found_.clear();
  for (const auto& [score, index] : scores) found_.push_back(index);
  mark_ = 0;
}

void CommandPalette::press(const KeyPress& press) {
  if (is_enter(press)) accepted_ = true;
  if (press.character != 0) return;
  if (press.key == GLFW_KEY_DOWN) ++moved_;
  if (press.key == GLFW_KEY_UP) --moved_;
  if (press.key == GLFW_KEY_PAGE_DOWN) moved_ += 8;
  if (press.key == GLFW_KEY_PAGE_UP) moved_ -= 8;
}

void CommandPalette::draw(PanelContext& context) {
  if (!open_) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetFontSize(), top = 0.12f * screen.y;
  ImGui::SetNextWindowPos({screen.x / 2, top}, ImGuiCond_Always, {0.5f, 0});
  const float lines =
      static_cast<float>(std::max<std::size_t>(1, found_.size())) * ImGui::GetTextLineHeightWithSpacing();
  const float height = ImGui::GetFrameHeightWithSpacing() + lines + 2 * ImGui::GetStyle().WindowPadding.y;
  ImGui::SetNextWindowSize({std::min(0.94f * screen.x, 36 * text), std::min({0.8f * screen.y, 26 * text, height})});
  ImGui::SetNextWindowBgAlpha(1);
  ImGui::SetNextWindowFocus();
  ImGui::Begin("##palette", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav);
  context.log.item(
      "panel.Palette", ImGui::GetWindowPos(),
      {ImGui::GetWindowPos().x + ImGui::GetWindowWidth(), ImGui::GetWindowPos().y + ImGui::GetWindowHeight()});
  ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const std::string before = query_;
  // Not in the first frame: the field has yet to receive what was typed before Enter.
  const bool accepted = std::exchange(accepted_, false) && !just_opened_;
  text_field("##query", query_, "a command, a robot or a setting");
  context.log.item("palette.query");
  if (query_ != before || std::exchange(just_opened_, false)) search();
  const int last = static_cast<int>(found_.size()) - 1;
  mark_ = std::clamp(mark_ + moved_, 0, std::max(0, last));
  std::optional<std::size_t> chosen;
  if (accepted && last >= 0) chosen = found_[static_cast<std::size_t>(mark_)];
  if (const auto clicked = draw_entries(context)) chosen = clicked;
  moved_ = 0;
  const bool left = ImGui::IsMouseClicked(0) && !ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows);
  ImGui::End();
  if (left) open_ = false;
  if (!chosen) return;
  open_ = false;
  context.log.write("palette", {{"name", entries_[*chosen].name}});
  const std::function<void()> act = entries_[*chosen].act;  // a copy, since it may open the palette again
  act();
}

std::optional<std::size_t> CommandPalette::draw_entries(PanelContext& context) {
  std::optional<std::size_t> clicked;
  if (ImGui::BeginChild("found", {0, 0})) {
    if (found_.empty()) note("nothing has this name");
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(found_.size()), ImGui::GetTextLineHeightWithSpacing());
    if (moved_ != 0) {
      const float line = ImGui::GetTextLineHeightWithSpacing(), top = static_cast<float>(mark_) * line;
      if (top < ImGui::GetScrollY()) ImGui::SetScrollY(top);
      if (top + line > ImGui::GetScrollY() + ImGui::GetWindowHeight())
        ImGui::SetScrollY(top + line - ImGui::GetWindowHeight());
    }
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const std::size_t index = found_[static_cast<std::size_t>(i)];
        const PaletteEntry& entry = entries_[index];
        const std::string right =
            entry.detail.empty() ? entry.group : fmt::format("{}   {}", entry.detail, entry.group);
        const float width = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x,
                    place = width - ImGui::CalcTextSize(right.c_str()).x;
        ImGui::PushID(i);
        if (ImGui::Selectable("##entry", i == mark_)) clicked = index;
        ImGui::PopID();
        if (i < 10) context.log.item(fmt::format("palette.{}", i));
        ImGui::SameLine(ImGui::GetStyle().ItemSpacing.x);
        ImGui::TextUnformatted(shortened(entry.name, place - 2 * ImGui::GetFontSize()).c_str());
        ImGui::SameLine(place);
        ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
        ImGui::TextUnformatted(right.c_str());
        ImGui::PopStyleColor();
      }
  }
  ImGui::EndChild();
  return clicked;
}

namespace {

// Other words for what a panel shows.
std::string_view words_of_panel(std::string_view title) {
  constexpr std::pair<std::string_view, std::string_view> words[] = {
      {"Robots", "generate random mutate list"},
      {"Tree", "list outline hierarchy"},
      {"Browser", "samples library open examples"},
      {"Ranking", "best winner champion score"},
      {"Evolution", "evolve optimize train history"},
      {"Compare", "split side ghosts"},
      {"View", "settings display shadows look"},
      {"Tune", "settings parameters physics water land"},
      {"Measure", "graph chart diagram speed distance energy"},
      {"Probes", "graph chart"},
      {"Actuators", "drive control"},
      {"Brain", "neural network controller"},
      {"Video", "film movie photo picture record"},
      {"Messages", "errors warnings log exploded"},
      {"Stats", "statistics performance fps frame rate"}};
  const auto found = std::ranges::find(words, title, &std::pair<std::string_view, std::string_view>::first);
  return found == std::end(words) ? "" : found->second;
}

}  // namespace

std::vector<PaletteEntry> settings_for_palette(PanelContext& context, const std::function<void(const char*)>& show) {
  std::vector<PaletteEntry> entries;
  for (const PanelEntry& panel : panel_table())
    entries.push_back({fmt::format("panel {}", panel.title), "Panels", "", [show, title = panel.title] { show(title); },
                       fmt::format("{} {}", panel.tooltip, words_of_panel(panel.title))});
  add_switches(context, entries);
  add_camera(context, entries);
  add_view_numbers(context, entries);
  add_parameters(context, entries);
  add_start(context, entries);
  for (const RobotEntry& robot : context.scene.robots().entries())
    entries.push_back({robot.name, "Robots", fmt::format("{} springs", robot.springs), [&context, id = robot.id] {
                         context.scene.selection().select(id);
                         frame_robots(context, {id});
                       }});
  return entries;
}

}  // namespace mercury::window
