// SPDX-License-Identifier: Apache-2.0
// The speed of the physics and of drawing.
#include <fmt/format.h>

#include <memory>
#include <vector>

#include "app/window/panels/panel.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {

class StatsPanel : public Panel {
 public:
  void draw(PanelContext& context) override;
};

namespace {

void figure(const char* name, const std::string& value, const char* help) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(name);
  tooltip(help);
  ImGui::TableNextColumn();
  right_aligned(value);
}

std::string milliseconds(double seconds) { return fmt::format("{:.2f} ms", 1000 * seconds); }

bool begin_figures(const char* id) {
  return ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg);
}

void draw_physics(PanelContext& context) {
  heading("Physics");
  const Snapshot& snapshot = context.scene.snapshot();
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(context.scene.device_name().c_str());
  ImGui::PopTextWrapPos();
  if (!begin_figures("physics")) return;
  figure("springs evaluated", short_number(snapshot.springs_per_second) + "/s", "while stepping");
  figure("one step of all robots", milliseconds(snapshot.step_seconds), "wall time of one time step");
  figure("reading results", milliseconds(snapshot.gathering_seconds),
         "time that the physics thread takes to read positions and color values");
  figure("springs", short_number(static_cast<double>(snapshot.robots->springs)), "of all robots");
  figure("masses", short_number(static_cast<double>(snapshot.positions.size())), "of all robots");
  ImGui::EndTable();
}

void draw_frame_times(PanelContext& context) {
  heading("Frame times");
  const FrameTimes mean = context.frame_history.mean();
  const Viewport& viewport = context.viewport;
  if (!begin_figures("frame")) return;
  figure("frames", fmt::format("{:.0f}/s", mean.whole > 0 ? 1 / mean.whole : 0), "mean of the last 240 frames");
  figure("scene", milliseconds(mean.scene), "taking over the newest state from the physics");
  figure("view", milliseconds(mean.drawn), "drawing the robots, including the wait for the GPU");
  figure("mouse", milliseconds(mean.mouse), "following it, and finding what it points at");
  figure("panels", milliseconds(mean.panels), "drawing the panels");
  figure("thumbnails", milliseconds(mean.thumbnails), "pictures of robots in panels");
  figure("display", milliseconds(mean.present), "bringing the frame to the display");
  figure("view size",
         fmt::format("{} \xc3\x97 {} ({:.0f} %)", viewport.renderer().width(), viewport.renderer().height(),
                     100 * viewport.share()),
         "reduced during motion if drawing is slow");
  ImGui::EndTable();
}

void draw_frame_plot(const FrameHistory& history) {
  std::vector<double> number, whole, drawn;
  for (const FrameTimes& times : history.frames()) {
    number.push_back(static_cast<double>(number.size()) - static_cast<double>(history.frames().size()));
    whole.push_back(1000 * times.whole);
    drawn.push_back(1000 * times.drawn);
  }
  const PlotLine lines[] = {{"frame", render::category_color(0), number, whole},
                            {"view", render::category_color(1), number, drawn}};
  plot("costs",
       {.title = "frame and view",
        .unit = "ms",
        .x_title = "frame, 0 = now",
        .x_unit = "",
        .height = 8 * ImGui::GetFontSize()},
       lines);
  plot_legend(lines);
}

}  // namespace

void StatsPanel::draw(PanelContext& context) {
  draw_physics(context);
  draw_frame_times(context);
  draw_frame_plot(context.frame_history);
  const auto& passes = context.viewport.renderer().times();
  if (!passes.empty() && ImGui::CollapsingHeader("Parts of the view") && begin_figures("passes")) {
    for (const render::PassTime& pass : passes)
      figure(std::string(pass.name).c_str(), fmt::format("{:.2f} ms", pass.milliseconds), nullptr);
    ImGui::EndTable();
  }
  note(context.window.gl_context().describe().c_str());
}

std::unique_ptr<Panel> make_stats_panel(PanelContext&) { return std::make_unique<StatsPanel>(); }

}  // namespace mercury::window
