// SPDX-License-Identifier: Apache-2.0
// What the window keeps for its next start: preferences, keys, and the settings of the session.
#pragma once

#include <filesystem>

#include "app/window/panels/panel.h"
#include "app/window/viewer.h"

namespace mercury::window {

// The preferences of the last start; options take precedence. `folder`: of settings; empty = none are kept.
Preferences kept_preferences(const ViewerOptions& options, const std::filesystem::path& folder);

// Brings back the session's settings where the command line gives none, and reads keys.txt into `keys`.
void load_session(PanelContext& context, KeyMap& keys, const ViewerOptions& options,
                  const std::filesystem::path& folder);
void save_session(PanelContext& context, const std::filesystem::path& folder);

}  // namespace mercury::window
