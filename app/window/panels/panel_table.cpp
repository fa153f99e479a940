// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/browser_panel.h"
#include "app/window/panels/compare_panel.h"
#include "app/window/panels/evolution_panel.h"
#include "app/window/panels/measure_panel.h"
#include "app/window/panels/messages_panel.h"
#include "app/window/panels/panel.h"
#include "app/window/panels/ranking_panel.h"
#include "app/window/panels/robots_panel.h"
#include "app/window/panels/stats_panel.h"
#include "app/window/panels/tune_panel.h"
#include "app/window/panels/video_panel.h"
#include "app/window/panels/view_panel.h"

namespace mercury::window {
namespace {

template <class Kind>
std::unique_ptr<Panel> make(PanelContext& context) {
  if constexpr (std::is_constructible_v<Kind, PanelContext&>)
    return std::make_unique<Kind>(context);
  else
    return std::make_unique<Kind>();
}

constexpr PanelEntry table[] = {
    {"Robots", "the robots of the scene", Side::left, make<RobotsPanel>},
    {"Browser", "folders of robots, with pictures", Side::left, make<BrowserPanel>},
    {"Ranking", "which robot went farthest", Side::left, make<RankingPanel>},
    {"Evolution", "runs of an evolution: scores, champions, families", Side::left, make<EvolutionPanel>},
    {"Compare", "two views, and ghosts of robots as they were", Side::left, make<ComparePanel>},
    {"View", "colors, arrows, camera, appearance", Side::right, make<ViewPanel>},
    {"Tune", "solver, environment, materials", Side::right, make<TunePanel>},
    {"Measure", "plots over time", Side::right, make<MeasurePanel>},
    {"Video", "videos and screenshots", Side::right, make<VideoPanel>},
    {"Messages", "everything that the window has reported", Side::right, make<MessagesPanel>},
    {"Stats", "speed of the physics and of drawing", Side::right, make<StatsPanel>},
};

}  // namespace

void Panel::work(PanelContext&, double) {}

std::span<const PanelEntry> panel_table() { return table; }

}  // namespace mercury::window
