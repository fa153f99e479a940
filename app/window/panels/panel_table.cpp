// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/panel.h"

namespace mercury::window {

// Each is in NAME_panel.cpp.
using MakePanel = std::unique_ptr<Panel>(PanelContext& context);
MakePanel make_robots_panel, make_tree_panel, make_browser_panel, make_ranking_panel, make_evolution_panel,
    make_compare_panel, make_view_panel, make_tune_panel, make_measure_panel, make_probes_panel, make_actuators_panel,
    make_brain_panel, make_video_panel, make_messages_panel, make_stats_panel;

namespace {

constexpr PanelEntry table[] = {
    {"Robots", "\uf1b3", "the robots of the scene", Side::left, make_robots_panel},
    {"Tree", "\uf03a", "the scene as a tree, with a search: robots, muscles, sensors, brains, attachments", Side::left,
     make_tree_panel},
    {"Browser", "\uf07c", "folders of robots, with pictures", Side::left, make_browser_panel},
    {"Ranking", "\uf091", "which robot went farthest", Side::left, make_ranking_panel},
    {"Evolution", "\uf0e8", "runs of an evolution: scores, champions, families", Side::left, make_evolution_panel},
    {"Compare", "\uf0db", "two views, and ghosts of robots as they were", Side::left, make_compare_panel},
    {"View", "\uf06e", "colors, arrows, camera, appearance", Side::right, make_view_panel},
    {"Tune", "\uf1de", "solver, environment, materials", Side::right, make_tune_panel},
    {"Measure", "\uf201", "plots over time", Side::right, make_measure_panel},
    {"Probes", "\uf05b", "masses and springs over time", Side::right, make_probes_panel},
    {"Actuators", "\uf256", "sliders that drive the muscles of a robot by hand", Side::right, make_actuators_panel},
    {"Brain", "\uf1e0", "senses, neurons and muscles of a robot that thinks", Side::right, make_brain_panel},
    {"Video", "\uf03d", "videos and screenshots", Side::right, make_video_panel},
    {"Messages", "\uf0f3", "everything that the window has reported", Side::right, make_messages_panel},
    {"Stats", "\uf0e4", "speed of the physics and of drawing", Side::right, make_stats_panel},
};

}  // namespace

void Panel::work(PanelContext&) {}

std::span<const PanelEntry> panel_table() { return table; }

}  // namespace mercury::window
