// SPDX-License-Identifier: Apache-2.0
// Probes: masses and springs of robots whose figures are plotted over time.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/live/picking.h"
#include "app/live/scene_mouse.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panel.h"
#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "app/window/viewport/marks.h"

namespace mercury::window {
namespace {

constexpr std::size_t most_probes = 10;     // the number of category colors
constexpr std::size_t most_samples = 4000;  // of a probe; when it is full, every second one goes

struct ProbeQuantity {
  const char* name;
  const char* unit;
  const char* help;
  bool of_spring = false;
};
constexpr std::array quantities{
    ProbeQuantity{"speed", "m/s", "of the mass"},
    ProbeQuantity{"height", "m", "of the mass, its z"},
    ProbeQuantity{"acceleration", "m/s\xc2\xb2", "of the mass, the mean between two points"},
    ProbeQuantity{"strain", "%", "of the spring: how much longer than at rest it is", true},
    ProbeQuantity{"force", "N", "of the spring; positive: it pulls", true},
    ProbeQuantity{"activation", "%", "of the spring: by how much its muscle shortens it", true}};

// A mass, and the spring that was clicked with it.
class Probe {
 public:
  explicit Probe(const Hit& hit) : hit_(hit) {}

  const Hit& hit() const { return hit_; }
  const std::vector<double>& times() const { return times_; }
  const std::vector<double>& values(std::size_t quantity) const { return values_[quantity]; }
  // Takes a sample of the present. Samples of later moments that were gone back from are forgotten.
  void sample(const LiveScene& scene);

 private:
  void thin();

  Hit hit_;
  std::vector<double> times_;
  std::array<std::vector<double>, quantities.size()> values_;
  std::uint64_t resets_ = 0;
  Vec3 velocity_;  // at the last sample [m/s]
};

void Probe::sample(const LiveScene& scene) {
  const Snapshot& snapshot = scene.snapshot();
  if (snapshot.timeline.viewing && !snapshot.timeline.recording) return;
  const auto index = snapshot.robots->index_of(hit_.robot);
  const HitDetails now = scene.mouse().describe(hit_);  // keeps velocities in snapshots
  if (!index || hit_.mass >= snapshot.robots->robots[*index].robot->masses.size()) return;
  const auto velocities = snapshot.velocities_of(*index);
  while (!times_.empty() && times_.back() > snapshot.time) {
    times_.pop_back();
    for (auto& values : values_) values.pop_back();
  }
  if (velocities.empty() || (!times_.empty() && times_.back() == snapshot.time)) return;
  const Vec3 velocity = velocities[hit_.mass];
  const bool follows = !times_.empty() && snapshot.resets == resets_;
  const double acceleration =
      follows ? static_cast<double>(length(velocity - velocity_)) / (snapshot.time - times_.back()) : NAN;
  resets_ = snapshot.resets;
  velocity_ = velocity;
  times_.push_back(snapshot.time);
  const auto of_spring = [&](float HitDetails::OfSpring::*figure, double factor) {
    return now.spring ? factor * static_cast<double>(*now.spring.*figure) : NAN;
  };
  const double figures[] = {static_cast<double>(length(velocity)),
                            static_cast<double>(now.mass.position.z),
                            acceleration,
                            of_spring(&HitDetails::OfSpring::strain, 100),
                            of_spring(&HitDetails::OfSpring::force, 1),
                            of_spring(&HitDetails::OfSpring::activation, 100)};
  for (std::size_t i = 0; i < quantities.size(); ++i) values_[i].push_back(figures[i]);
  if (times_.size() > most_samples) thin();
}

void Probe::thin() {
  const auto halve = [](std::vector<double>& list) {
    for (std::size_t i = 0; 2 * i < list.size(); ++i) list[i] = list[2 * i];
    list.resize((list.size() + 1) / 2);
  };
  halve(times_);
  for (auto& values : values_) halve(values);
}

std::string name_of_probe(const LiveScene& scene, const Hit& hit) {
  std::string name = fmt::format("{}: mass {}", name_of_robot(scene, hit.robot), hit.mass);
  if (hit.spring) name += fmt::format(", spring {}", *hit.spring);
  return name;
}

}  // namespace

class ProbesPanel : public Panel {
 public:
  void draw(PanelContext& context) override;
  // Takes samples while the panel is closed, too.
  void work(PanelContext& context) override;

 private:
  void take_over(PanelContext& context);
  void draw_list(PanelContext& context);
  void draw_plots(PanelContext& context);

  std::vector<Probe> probes_;
  std::array<bool, quantities.size()> shown_{true, false, false, true, true, false};
  TimePlots plots_;
};

void ProbesPanel::work(PanelContext& context) {
  take_over(context);
  std::erase_if(probes_, [&](const Probe& probe) { return !context.scene.document().find(probe.hit().robot); });
  for (Probe& probe : probes_) probe.sample(context.scene);
}

// What was asked for in the card of the mass that was clicked.
void ProbesPanel::take_over(PanelContext& context) {
  if (!context.new_probe) return;
  const Hit hit = *std::exchange(context.new_probe, std::nullopt);
  const auto same = [&](const Probe& probe) {
    return probe.hit().robot == hit.robot && probe.hit().mass == hit.mass && probe.hit().spring == hit.spring;
  };
  if (std::ranges::any_of(probes_, same)) return;
  if (probes_.size() == most_probes) probes_.erase(probes_.begin());
  probes_.emplace_back(hit);
  context.log.write("probe", {{"mass", hit.mass}, {"count", probes_.size()}});
}

void ProbesPanel::draw(PanelContext& context) {
  if (probes_.empty()) {
    note("Click a robot, then \"Plot over time\" in the card of its mass and spring.");
    return;
  }
  draw_list(context);
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    if (i != 0) {
      ImGui::SameLine();
      if (ImGui::GetContentRegionAvail().x < ImGui::CalcTextSize(quantities[i].name).x + 1.5f * ImGui::GetFontSize())
        ImGui::NewLine();
    }
    if (toggle_button(quantities[i].name, shown_[i])) shown_[i] = !shown_[i];
    context.log.item(fmt::format("probe.{}", quantities[i].name));
    tooltip(quantities[i].help);
  }
  draw_plots(context);
}

// The legend of the plots, with a button per probe that removes it.
void ProbesPanel::draw_list(PanelContext& context) {
  const float text = ImGui::GetFontSize(), side = ImGui::GetFrameHeight();
  std::optional<std::size_t> removed;
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float middle = corner.y + side / 2;
    ImGui::GetWindowDrawList()->AddRectFilled({corner.x, middle - 0.3f * text},
                                              {corner.x + 0.6f * text, middle + 0.3f * text},
                                              packed(render::category_color(static_cast<int>(i))));
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + text);
    ImGui::AlignTextToFramePadding();
    const float room = ImGui::GetContentRegionAvail().x - side - ImGui::GetStyle().ItemSpacing.x;
    ImGui::TextUnformatted(shortened(name_of_probe(context.scene, probes_[i].hit()), room).c_str());
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - side);
    if (ImGui::Button("\xc3\x97", {side, side})) removed = i;
    context.log.item(fmt::format("probe.{}.remove", i));
    tooltip("remove this probe");
    ImGui::PopID();
  }
  if (!removed) return;
  probes_.erase(probes_.begin() + static_cast<std::ptrdiff_t>(*removed));
  context.log.write("probe", {{"mass", nullptr}, {"count", probes_.size()}});
}

void ProbesPanel::draw_plots(PanelContext& context) {
  plots_.begin(context);
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    if (!shown_[q]) continue;
    std::vector<PlotLine> lines;
    for (std::size_t i = 0; i < probes_.size(); ++i)
      if (probes_[i].hit().spring || !quantities[q].of_spring)
        lines.push_back({name_of_probe(context.scene, probes_[i].hit()), render::category_color(static_cast<int>(i)),
                         probes_[i].times(), probes_[i].values(q)});
    plot(quantities[q].name,
         {.title = fmt::format("{} of the {}", quantities[q].name, quantities[q].of_spring ? "spring" : "mass"),
          .unit = quantities[q].unit,
          .height = 9 * ImGui::GetFontSize()},
         lines, &plots_.view);
    context.log.item(fmt::format("probe.plot.{}", quantities[q].name));
  }
  plots_.end(context);
}

float pinned_card_height() {
  return figures_height() + ImGui::GetFrameHeight() + 3 * ImGui::GetStyle().ItemSpacing.y + 2;
}

void draw_pinned_card(PanelContext& context) {
  ImGui::Separator();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  write_figures(context.scene, *context.pinned);
  ImGui::SetCursorScreenPos({low.x, low.y + figures_height() + ImGui::GetStyle().ItemSpacing.y});
  const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  if (ImGui::Button("Plot over time", {half, 0})) context.new_probe = context.pinned;
  context.log.item("pinned.plot");
  tooltip("plots of this mass and spring in the Probes panel");
  ImGui::SameLine();
  const bool closed = ImGui::Button("Close", {half, 0});
  context.log.item("pinned.close");
  context.log.item("panel.Pinned", low, ImGui::GetItemRectMax());
  if (closed) context.pinned.reset();
}

std::unique_ptr<Panel> make_probes_panel(PanelContext&) { return std::make_unique<ProbesPanel>(); }

}  // namespace mercury::window
