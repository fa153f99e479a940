// SPDX-License-Identifier: Apache-2.0
#include "app/scene/view_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>

#include "mercury/error.h"
#include "mercury/number_text.h"

namespace mercury {
namespace {

constexpr int most_cells = 10000;     // of a grid in a row, or a column
constexpr float farthest_cut = 1e6f;  // from the middle of a robot, which explodes there [m]

float radians(float degrees) { return degrees * std::numbers::pi_v<float> / 180; }

render::Theme theme_named(const std::string& name) {
  if (name == "dark") return render::Theme::dark;
  if (name == "light") return render::Theme::light;
  throw ParameterError("theme", fmt::format("\"{}\" is not accepted; give dark, light", name));
}

Layout layout_named(const std::string& name) {
  for (const Layout layout : {Layout::grid, Layout::cells, Layout::race})
    if (name == name_of(layout)) return layout;
  throw ParameterError("layout", fmt::format("\"{}\" is not accepted; give grid, cells, race", name));
}

render::Colormap colormap_named(const std::string& name) {
  std::vector<std::string_view> names;
  for (int i = 0; i < render::colormap_count; ++i) {
    names.push_back(render::name_of(static_cast<render::Colormap>(i)));
    if (names.back() == name) return static_cast<render::Colormap>(i);
  }
  throw ParameterError("colormap", fmt::format("\"{}\" is not accepted; give {}", name, fmt::join(names, ", ")));
}

// "white", "#2a6f97"; "transparent" has no opacity.
render::Color background_from(const std::string& text) {
  if (text == "transparent") return {0, 0, 0, 0};
  if (text == "white") return {};
  if (text == "black") return {0, 0, 0, 255};
  const auto number =
      parse_number<std::uint32_t>(std::string_view(text).substr(std::min<std::size_t>(1, text.size())), 16);
  if (text.size() != 7 || text[0] != '#' || !number)
    throw ParameterError(
        "background",
        fmt::format("\"{}\" is not accepted; give white, black, transparent or a color as #2a6f97", text));
  return render::rgb(*number);
}

// "y", "-y:30%" or "y:0.2"
render::Cut cut_from(const std::string& text) {
  static constexpr std::string_view axes = "xyz";
  const auto refuse = [&] {
    throw ParameterError("cut", fmt::format("\"{}\" is not accepted; give x, y, z, -x, -y or -z, and a place: y:30% of "
                                            "each robot (0 to 100), or y:0.2 in meters from its middle",
                                            text));
  };
  const std::size_t colon = text.find(':');
  std::string_view axis = std::string_view(text).substr(0, colon);
  render::Cut cut{.below = axis.starts_with('-')};
  if (cut.below) axis.remove_prefix(1);
  if (axis.size() != 1 || axes.find(axis) == std::string_view::npos) refuse();
  cut.axis = static_cast<int>(axes.find(axis));
  if (colon == std::string::npos) return cut;
  std::string_view place = std::string_view(text).substr(colon + 1);
  const bool is_share = place.ends_with('%');
  if (is_share) place.remove_suffix(1);
  const auto value = parse_number<float>(place);
  if (!value || (is_share ? !(*value >= 0 && *value <= 100) : !(std::abs(*value) <= farthest_cut))) refuse();
  (is_share ? cut.percent : cut.shift) = *value;
  return cut;
}

struct ShownItem {
  std::string_view word;
  bool& (*of)(Shown& shown);
};
constexpr ShownItem shown_items[] = {
    {"skin", [](Shown& shown) -> bool& { return shown.skin; }},
    {"springs", [](Shown& shown) -> bool& { return shown.springs; }},
    {"masses", [](Shown& shown) -> bool& { return shown.masses; }},
    {"drag", [](Shown& shown) -> bool& { return shown.arrows.drag; }},
    {"lift", [](Shown& shown) -> bool& { return shown.arrows.lift; }},
    {"velocity", [](Shown& shown) -> bool& { return shown.arrows.velocity; }},
    {"gravity", [](Shown& shown) -> bool& { return shown.arrows.gravity; }},
    {"contact", [](Shown& shown) -> bool& { return shown.arrows.contact; }},
    {"force", [](Shown& shown) -> bool& { return shown.arrows.force; }},
    {"path", [](Shown& shown) -> bool& { return shown.path; }},
    {"labels", [](Shown& shown) -> bool& { return shown.labels; }},
    {"captions", [](Shown& shown) -> bool& { return shown.captions; }},
    {"legend", [](Shown& shown) -> bool& { return shown.legend; }},
    {"clock", [](Shown& shown) -> bool& { return shown.clock; }},
    {"scale", [](Shown& shown) -> bool& { return shown.scale_bar; }},
};

void validate(const ViewWords& words) {
  if (words.scale) {
    const auto [low, high] = *words.scale;
    if (!(low < high) || !std::isfinite(high - low))
      throw ParameterError(
          "scale", fmt::format("\"{:g},{:g}\" is not accepted; give two finite numbers, the lower first", low, high));
  }
  if (!(words.arrow_length >= 0.01f && words.arrow_length <= 100))
    throw ParameterError("arrow_length", fmt::format("{} is not accepted; give 0.01 to 100", words.arrow_length));
  if (!(words.arrow_density > 0 && words.arrow_density <= 1))
    throw ParameterError("arrow_density",
                         fmt::format("{} is not accepted; give a share above 0, up to 1", words.arrow_density));
  if (!(words.arrow_threshold >= 0 && words.arrow_threshold <= 1))
    throw ParameterError("arrow_threshold",
                         fmt::format("{} is not accepted; give a share from 0 to 1", words.arrow_threshold));
  if (words.grid && (std::min(words.grid->columns, words.grid->rows) < 1 ||
                     std::max(words.grid->columns, words.grid->rows) > most_cells))
    throw ParameterError("grid", fmt::format("{}x{} is not accepted; give 1 to {} columns and rows",
                                             words.grid->columns, words.grid->rows, most_cells));
  if (words.azimuth && !std::isfinite(*words.azimuth))
    throw ParameterError("azimuth", "give a finite number of degrees");
  if (words.elevation && !(std::abs(*words.elevation) <= 90))
    throw ParameterError("elevation", "give -90 to 90 degrees");
  if (words.zoom && !(*words.zoom >= 0.001f && *words.zoom <= 1000))
    throw ParameterError("zoom", fmt::format("{} is not accepted; give 0.001 to 1000", *words.zoom));
}

void set_race(ViewSettings& settings) {
  if (settings.grid) throw ParameterError("grid", "not together with layout race, which has one lane a robot");
  set_layout(settings, Layout::race);
  // Lanes run along x, to the right, seen from high and far so that they look alike.
  if (!settings.camera.azimuth) settings.camera.azimuth = radians(-90);
  if (!settings.camera.elevation) settings.camera.elevation = radians(50);
  settings.camera.field_of_view = std::min(settings.camera.field_of_view, radians(20));
}

}  // namespace

void set_layout(ViewSettings& view, Layout layout) {
  view.layout = layout;
  if (layout != Layout::grid) view.shown.path = true;
  if (layout == Layout::race) view.shown.labels = true;
}

std::vector<std::string> shown_words() {
  std::vector<std::string> words;
  for (const ShownItem& item : shown_items) words.emplace_back(item.word);
  return words;
}

std::string shown_text(Shown shown) {
  std::vector<std::string_view> words;
  for (const ShownItem& item : shown_items)
    if (item.of(shown)) words.push_back(item.word);
  return words.empty() ? "nothing" : fmt::format("{}", fmt::join(words, ","));
}

Shown shown_from(const std::string& text) {
  Shown shown{.skin = false, .clock = false};
  if (text == "nothing") return shown;
  for (std::size_t start = 0, end = 0; end != std::string::npos; start = end + 1) {
    end = text.find(',', start);
    const std::string_view word = std::string_view(text).substr(start, end - start);
    const auto* item = std::ranges::find(shown_items, word, &ShownItem::word);
    if (item == std::end(shown_items))
      throw ParameterError("show",
                           fmt::format("\"{}\" is not accepted; give some of {}", word, fmt::join(shown_words(), ",")));
    item->of(shown) = true;
  }
  return shown;
}

ViewSettings view_settings(const ViewWords& words, Layout usual) {
  validate(words);
  ViewSettings settings{
      .color = &color_quantity(words.color), .scale = words.scale, .smooth = words.smooth, .grid = words.grid};
  if (!words.colormap.empty()) settings.colormap = colormap_named(words.colormap);
  settings.log_scale = words.log_scale;
  settings.caption = words.caption;
  settings.theme = theme_named(words.theme);
  settings.plain = words.plain;
  settings.faceted = words.faceted;
  settings.footprints = words.footprints;
  if (!words.background.empty()) {
    settings.background = background_from(words.background);
    // Text is dark on bright backgrounds, and on those that nobody knows yet.
    const auto [r, g, b] = render::linear_of(*settings.background);
    if (settings.background->a == 0 || 0.2126f * r + 0.7152f * g + 0.0722f * b > 0.2f)
      settings.theme = render::Theme::light;
  }
  settings.layout = words.layout ? layout_named(*words.layout) : usual;
  if (words.cut) settings.cut = cut_from(*words.cut);
  if (!words.camera.empty()) settings.camera = camera_named(words.camera);
  if (settings.layout == Layout::race) set_race(settings);
  if (settings.layout == Layout::cells) set_layout(settings, Layout::cells);
  if (words.compare) settings.compare = SideDifference(*words.compare);
  if (words.bookmarks) settings.bookmarks = bookmarks_from(*words.bookmarks);
  if (words.azimuth) settings.camera.azimuth = radians(*words.azimuth);
  if (words.elevation) settings.camera.elevation = radians(*words.elevation);
  if (words.zoom) settings.camera.zoom = *words.zoom;
  settings.shown.legend = settings.color->has_values();
  if (words.show) settings.shown = shown_from(*words.show);
  settings.shown.scale_bar = settings.shown.scale_bar || words.scale_bar;
  settings.shown.arrows.length = words.arrow_length;
  settings.shown.arrows.density = words.arrow_density;
  settings.shown.arrows.threshold = words.arrow_threshold;
  return settings;
}

}  // namespace mercury
