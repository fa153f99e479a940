// SPDX-License-Identifier: Apache-2.0
// The options for what pictures show, and how.
#pragma once

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

#include "app/scene/view_settings.h"

namespace mercury {

class ViewOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(CLI::App& command);

  // The settings that the options describe. Throws InputError that names an option that cannot be used.
  ViewSettings settings() const;
  bool chooses_what_is_shown() const { return shown_.has_value(); }

 private:
  std::string color_{material_color().key}, theme_ = "dark", layout_ = "grid", camera_, caption_;
  std::optional<std::pair<float, float>> scale_;
  std::optional<std::string> shown_;
  std::optional<render::CutPlane> cut_;
  std::optional<Grid> grid_;
  std::optional<float> azimuth_, elevation_, zoom_;
  bool smooth_ = false, follow_ = false;
};

// "skin,labels,clock": shows exactly these. Throws InputError("--show: ...") that lists the possible words.
Shown shown_from(const std::string& text);

}  // namespace mercury
