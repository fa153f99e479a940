// SPDX-License-Identifier: Apache-2.0
#include "app/options/view_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <numbers>

#include "app/options/option_values.h"

namespace mercury {
namespace {

Grid grid_from(const std::string& option, const std::string& text) {
  const auto sizes = sizes_from(option, text, 2, "COLUMNSxROWS");
  return {sizes[0], sizes[1]};
}

std::pair<float, float> range_from(const std::string& option, const std::string& text) {
  const auto numbers = numbers_from(option, text, 2, "two numbers, as in -10,10");
  if (!(numbers[0] < numbers[1]) || !std::isfinite(numbers[0]) || !std::isfinite(numbers[1]))
    throw InputError(option, fmt::format("\"{}\" is not accepted; give the lower end first", text));
  return {numbers[0], numbers[1]};
}

render::CutPlane cut_from(const std::string& option, const std::string& text) {
  static const std::map<std::string, Eigen::Vector3f> axes{{"x", {1, 0, 0}},   {"y", {0, 1, 0}},   {"z", {0, 0, 1}},
                                                           {"-x", {-1, 0, 0}}, {"-y", {0, -1, 0}}, {"-z", {0, 0, -1}}};
  const std::size_t colon = text.find(':');
  const auto axis = axes.find(text.substr(0, colon));
  if (axis == axes.end())
    throw InputError(option,
                     fmt::format("\"{}\" is not accepted; give x, y, z, -x, -y or -z, and a place as in y:0.2", text));
  const float place = colon == std::string::npos ? 0 : number_from<float>(option, text.substr(colon + 1));
  return {.normal = axis->second, .offset = axis->second.sum() * place};
}

float radians(float degrees) { return degrees * std::numbers::pi_v<float> / 180; }

}  // namespace

Shown shown_from(const std::string& text) {
  Shown shown{.skin = false, .clock = false};
  const std::vector<std::pair<std::string_view, bool*>> items{{"skin", &shown.skin},
                                                              {"springs", &shown.springs},
                                                              {"masses", &shown.masses},
                                                              {"drag", &shown.arrows.drag},
                                                              {"lift", &shown.arrows.lift},
                                                              {"velocity", &shown.arrows.velocity},
                                                              {"gravity", &shown.arrows.gravity},
                                                              {"contact", &shown.arrows.contact},
                                                              {"path", &shown.path},
                                                              {"labels", &shown.labels},
                                                              {"captions", &shown.captions},
                                                              {"legend", &shown.legend},
                                                              {"clock", &shown.clock},
                                                              {"scale", &shown.scale_bar}};
  for (const std::string_view word : split(text, ',')) {
    bool known = false;
    for (const auto& [name, member] : items)
      if (name == word) *member = known = true;
    if (known) continue;
    std::vector<std::string_view> names;
    for (const auto& item : items) names.push_back(item.first);
    throw InputError("--show", fmt::format("\"{}\" is not accepted; give some of {}", word, fmt::join(names, ",")));
  }
  return shown;
}

void ViewOptions::add_to(CLI::App& command) {
  const auto add = [](CLI::Option* option) { option->group("View"); };
  std::vector<std::string> colors;
  for (const ColorQuantity& quantity : color_quantities()) colors.emplace_back(quantity.key);
  add(add_choice(command, "--color", color_, std::move(colors), fmt::format("Colour by (default {})", color_)));
  add(add_value(command, "--scale", scale_, "Ends of the colours' scale (default: fits)", "LOW,HIGH", range_from));
  add(add_value(command, "--show", shown_,
                "Exactly what is shown, of skin,springs,masses, arrows drag,lift,velocity,gravity,contact, and "
                "path,labels,captions,legend,clock,scale (default skin,clock)",
                "LIST", [](const std::string&, const std::string& text) {
                  shown_from(text);
                  return text;
                }));
  add(add_text(command, "--caption", caption_, "Text in the upper left corner; further lines are smaller", "TEXT"));
  add(add_choice(command, "--theme", theme_, {"dark", "light"}, "Colours of the surroundings (default dark)"));
  add(command.add_flag("--smooth", smooth_, "Round skins rather than edged ones"));
  add(add_value(command, "--cut", cut_, "Cut away what lies beyond a plane, as in y:0.2", "AXIS[:M]", cut_from));
  add(add_choice(command, "--layout", layout_, {"grid", "race"}, "Robots in a grid, or in lanes side by side"));
  add(add_value(command, "--grid", grid_, "Columns and rows (default: what fills the picture)", "CxR", grid_from));
  add(add_text(
      command, "--camera", camera_,
      "group keeps all in view, follow[:ROBOT] goes along, turntable, top, still, or a camera file (default group)",
      "CAMERA"));
  add(command.add_flag("--follow", follow_, "The same as --camera follow"));
  add(add_number(command, "--azimuth", azimuth_, "Where the eye is, around the robots from +x (default -75)",
                 "DEGREES"));
  add(add_number(command, "--elevation", elevation_, "Height of the eye above the horizon (default 20, land 35)",
                 "DEGREES"));
  add(add_number(command, "--zoom", zoom_, "Above 1: closer (default 1)", "X"));
}

ViewSettings ViewOptions::settings() const {
  ViewSettings settings{
      .color = &color_quantity(color_), .scale = scale_, .smooth = smooth_, .cut = cut_, .grid = grid_};
  settings.caption = caption_;
  settings.theme = theme_ == "light" ? render::Theme::light : render::Theme::dark;
  settings.layout = layout_ == "race" ? Layout::race : Layout::grid;
  if (follow_ && !camera_.empty()) throw InputError("--follow", "not together with --camera; give one of them");
  if (!camera_.empty()) settings.camera = camera_named(camera_);
  if (follow_) settings.camera.mode = CameraMode::follow;
  if (settings.layout == Layout::race) {
    if (grid_) throw InputError("--grid", "not together with --layout race, which has one lane a robot");
    settings.shown.labels = settings.shown.path = true;
    // Lanes run along x, to the right, seen from high and far so that they look alike.
    if (!settings.camera.azimuth) settings.camera.azimuth = radians(-90);
    if (!settings.camera.elevation) settings.camera.elevation = radians(50);
    settings.camera.field_of_view = std::min(settings.camera.field_of_view, radians(20));
  }
  if (azimuth_) settings.camera.azimuth = radians(*azimuth_);
  if (elevation_) settings.camera.elevation = radians(*elevation_);
  if (azimuth_ && !std::isfinite(*azimuth_)) throw InputError("--azimuth", "give a finite number of degrees");
  if (elevation_ && !(std::abs(*elevation_) <= 90)) throw InputError("--elevation", "give -90 to 90 degrees");
  if (zoom_) {
    require_positive("--zoom", *zoom_, "");
    settings.camera.zoom = *zoom_;
  }
  settings.shown.legend = settings.color->has_values();
  if (shown_) settings.shown = shown_from(*shown_);
  return settings;
}

}  // namespace mercury
