// SPDX-License-Identifier: Apache-2.0
// Commands on the evolution that the window has open.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "app/window/panels/panel.h"

namespace mercury::window {

// The dialog "Evolve these robots": asks for the settings of a new run, and starts it in the background from the
// selected robots.
void ask_evolve(PanelContext& context);

// Opens what was dropped or chosen: a run (its folder, or the run.toml in it), and robots.
void open_paths(PanelContext& context, const std::vector<std::filesystem::path>& paths);

// Opens a run: its best robots and its configuration replace the scene.
void open_run(PanelContext& context, const std::filesystem::path& folder);
// Opens the run of the command line. The scene has its configuration already.
void open_first_run(PanelContext& context, const std::filesystem::path& folder);
// Asks for the folder of a run and opens it.
void choose_run(PanelContext& context);

// Puts the robot of an individual of the run into the scene, or selects it if it is there.
void add_individual(PanelContext& context, std::uint64_t id);

// Asks for the settings of a new run and starts it from the selected robots.
void evolve_selected(PanelContext& context);

}  // namespace mercury::window
