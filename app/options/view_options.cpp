// SPDX-License-Identifier: Apache-2.0
#include "app/options/view_options.h"

#include <fmt/format.h>

#include "app/options/option_values.h"

namespace mercury {
namespace {

std::pair<float, float> range_from(const std::string& option, const std::string& text) {
  const auto numbers = numbers_from(option, text, 2, "two numbers, as in -10,10");
  return {numbers[0], numbers[1]};
}

std::string text_from(const std::string&, const std::string& text) { return text; }

}  // namespace

void ViewOptions::add_to(const Command& command) {
  const auto add = [](const Option& option) { option.in_group("View"); };
  std::vector<std::string> colors;
  for (const ColorQuantity& quantity : color_quantities()) colors.emplace_back(quantity.key);
  add(add_choice(command, "--color", words_.color, std::move(colors),
                 fmt::format("Color by (default {})", words_.color))
          .on_first_screen());
  add(add_value(command, "--scale", words_.scale, "Ends of the colors' scale (default: fits)", "LOW,HIGH", range_from));
  std::vector<std::string> maps;
  for (int i = 0; i < render::colormap_count; ++i) maps.emplace_back(render::name_of(static_cast<render::Colormap>(i)));
  add(add_choice(command, "--colormap", words_.colormap, std::move(maps), "Colors of values (default: by quantity)"));
  add(command.add_flag("--log-scale", words_.log_scale, "Spread the colors by ratios of values"));
  add(add_value(command, "--show", words_.show,
                "Exactly what is shown, of skin,springs,masses, arrows drag,lift,velocity,gravity,contact,force, and "
                "path,labels,captions,legend,clock,scale (default skin,clock)",
                "LIST", text_from)
          .offering(shown_words()));
  add(add_number(command, "--arrow-length", words_.arrow_length, "Above 1: longer arrows (default 1)", "X"));
  add(add_number(command, "--arrow-density", words_.arrow_density, "Share of the arrows that is drawn (default 1)",
                 "X"));
  add(add_number(command, "--arrow-threshold", words_.arrow_threshold,
                 "Leave out arrows below this share of the longest (default 0)", "X"));
  add(add_text(command, "--caption", words_.caption, "Text in the upper left corner; further lines are smaller",
               "TEXT"));
  add(add_choice(command, "--theme", words_.theme, {"dark", "light"}, "Colors of the surroundings (default dark)"));
  add(command.add_flag("--plain", words_.plain, "A plain backdrop rather than water or land"));
  add(add_text(command, "--background", words_.background,
               "Of a still: robots, their shadows and text alone, over white, black, #rrggbb or transparent", "COLOR"));
  add(command.add_flag("--scale-bar", words_.scale_bar, "Also a bar of a round length"));
  add(command.add_flag("--smooth", words_.smooth, "Round skins also of many robots"));
  add(command.add_flag("--faceted", words_.faceted, "Edged skins, which show each voxel, also of few robots"));
  add(command.add_flag("--no-footprints", no_footprints_, "On land, without footprints in the sand"));
  add(add_value(command, "--cut", words_.cut, "Cut each robot open beyond a plane, as in y:30%", "AXIS[:PLACE]",
                text_from));
  add(add_value(command, "--layout", words_.layout,
                "Robots in a grid; in a grid in which each stays in its cell; or in lanes side by side (default "
                "grid, in the window cells)",
                "grid|cells|race", text_from)
          .offering({"grid", "cells", "race"}));
  add(add_value(command, "--grid", words_.grid, "Columns and rows (default: what fills the picture)", "CxR",
                grid_from));
  add(add_text(command, "--camera", words_.camera,
               "group keeps all in view, follow goes along, or the path of a camera file (default group)",
               "group|follow[:ROBOT]|turntable|top|still|FILE.json"));
  add(add_value(command, "--bookmarks", words_.bookmarks,
                "Cameras of the window's keys F5 to F8, as a JSON list of camera files' members", "JSON", text_from));
  add(add_value(command, "--compare", words_.compare,
                "A second side with the same robots under other settings, as in solver=xpbd or "
                "environment=land,dt=0.0005",
                "NAME=VALUE,...", text_from));
  add(command.add_flag("--follow", follow_, "The same as --camera follow"));
  add(add_number(command, "--azimuth", words_.azimuth, "Where the eye is, around the robots from +x (default -75)",
                 "DEGREES"));
  add(add_number(command, "--elevation", words_.elevation, "Height of the eye above the horizon (default 20, land 35)",
                 "DEGREES"));
  add(add_number(command, "--zoom", words_.zoom, "Above 1: closer (default 1)", "X"));
}

ViewSettings ViewOptions::settings(Layout usual) const {
  ViewWords words = words_;
  words.footprints = !no_footprints_;
  if (follow_ && !words.camera.empty()) throw InputError("--follow", "not together with --camera; give one of them");
  if (follow_) words.camera = "follow";
  return view_settings(words, usual);
}

}  // namespace mercury
