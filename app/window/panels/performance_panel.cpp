// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/performance_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

constexpr std::size_t kept = 240;  // frames

void figure(const char* name, const std::string& value, const char* explanation) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(name);
  tooltip(explanation);
  ImGui::TableNextColumn();
  right_aligned(value);
}

std::string milliseconds(double seconds) { return fmt::format("{:.2f} ms", 1000 * seconds); }

bool begin_figures(const char* id) {
  return ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg);
}

}  // namespace

void PerformancePanel::note(const FrameTimes& cost) {
  costs_.push_back(cost);
  if (costs_.size() > kept) costs_.pop_front();
}

void PerformancePanel::draw(const Snapshot& snapshot, const Viewport& picture, const std::string& device,
                            const std::string& card) {
  heading("Physics");
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(device.c_str());
  ImGui::PopTextWrapPos();
  if (begin_figures("physics")) {
    figure("springs evaluated", short_number(snapshot.springs_per_second) + "/s",
           "while it steps; the paper's measure of speed");
    figure("a step of all robots", milliseconds(snapshot.step_seconds), "wall time of one time step");
    figure("reading results", milliseconds(snapshot.gathering_seconds),
           "reading positions, and what is coloured by, by the thread that simulates");
    figure("springs", short_number(static_cast<double>(snapshot.robots->springs)), "of all robots");
    figure("masses", short_number(static_cast<double>(snapshot.positions.size())), "of all robots");
    ImGui::EndTable();
  }
  heading("A frame of the window");
  FrameTimes mean;
  for (const FrameTimes& cost : costs_) {
    const double share = 1.0 / static_cast<double>(costs_.size());
    mean.whole += share * cost.whole;
    mean.scene += share * cost.scene;
    mean.picture += share * cost.picture;
    mean.panels += share * cost.panels;
    mean.thumbnails += share * cost.thumbnails;
  }
  if (begin_figures("frame")) {
    figure("frames", fmt::format("{:.0f}/s", mean.whole > 0 ? 1 / mean.whole : 0), "mean over the last 240");
    figure("scene", milliseconds(mean.scene), "following the physics, what to draw");
    figure("picture", milliseconds(mean.picture), "drawing the robots, waiting for the card included");
    figure("panels", milliseconds(mean.panels), "the panels themselves");
    figure("thumbnails", milliseconds(mean.thumbnails), "of the browser");
    figure("picture's size",
           fmt::format("{} x {} ({:.0f} %)", picture.renderer().width(), picture.renderer().height(),
                       100 * picture.share()),
           "smaller than the window while it moves, where drawing is slow");
    ImGui::EndTable();
  }
  std::vector<double> number, whole, drawn;
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    number.push_back(static_cast<double>(i) - static_cast<double>(costs_.size()));
    whole.push_back(1000 * costs_[i].whole);
    drawn.push_back(1000 * costs_[i].picture);
  }
  const PlotLine lines[] = {{"frame", render::category_color(0), number, whole},
                            {"picture", render::category_color(1), number, drawn}};
  plot("costs",
       {.title = "frame and picture",
        .unit = "ms",
        .x_title = "frame, 0 = now",
        .x_unit = "",
        .height = 8 * ImGui::GetFontSize()},
       lines);
  plot_legend(lines);
  if (!picture.renderer().times().empty() && ImGui::CollapsingHeader("Parts of the picture")) {
    if (begin_figures("passes")) {
      for (const render::PassTime& pass : picture.renderer().times())
        figure(std::string(pass.name).c_str(), fmt::format("{:.2f} ms", pass.milliseconds), nullptr);
      ImGui::EndTable();
    }
  }
  window::note(card.c_str());
}

}  // namespace mercury::window
