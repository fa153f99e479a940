// SPDX-License-Identifier: Apache-2.0
// The options for what pictures show, and how.
#pragma once

#include "app/options/command.h"
#include "app/scene/camera_plan.h"
#include "app/scene/view_words.h"

namespace mercury {

class ViewOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(const Command& command);

  // The settings that the options describe. Throws InputError or ParameterError for an option that cannot be used.
  // `usual`: the layout without --layout.
  ViewSettings settings(Layout usual = Layout::grid) const;
  // The camera file that is read; empty = none.
  std::string camera_file() const { return is_camera_file(words_.camera) ? words_.camera : std::string(); }
  bool chooses_what_is_shown() const { return words_.show.has_value(); }

 private:
  ViewWords words_;
  bool follow_ = false, no_footprints_ = false;
};

}  // namespace mercury
