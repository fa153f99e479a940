// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/individual_details.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/window/toolkit/plot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/quantity.h"

namespace mercury::window {
namespace {

// A name and its value, in a table of two or four columns.
void entry(const std::string& name, const std::string& value) {
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(name.c_str());
  ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(value.c_str());
}

std::string parents_of(const Individual& individual) {
  if (individual.parents.empty()) return "none";
  return fmt::format("{}", fmt::join(individual.parents, " and "));
}

}  // namespace

std::string score_text(double score) { return std::isfinite(score) ? short_number(score) : "-"; }

void ScoreRange::add(double score) {
  if (!std::isfinite(score)) return;
  low_ = std::min(low_, score);
  high_ = std::max(high_, score);
}

float ScoreRange::share(double score) const {
  if (!std::isfinite(score)) return 0;
  return high_ > low_ ? static_cast<float>(std::clamp((score - low_) / (high_ - low_), 0.0, 1.0)) : 1;
}

ImU32 ScoreRange::color(double score) const {
  if (!std::isfinite(score)) return palette().grid;
  return packed(render::color_at(render::Colormap::viridis, 0.15f + 0.85f * share(score)));
}

void show_individual(const Individual& individual, const EvolutionSettings& settings, const char* hint) {
  const Assessment& assessment = individual.assessment;
  const float text = ImGui::GetFontSize();
  // Beside the panel, so that it covers none of its rows.
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowSize().x + text;
  const float y = ImGui::GetIO().MousePos.y, share = std::clamp(y / ImGui::GetIO().DisplaySize.y, 0.0f, 1.0f);
  ImGui::SetNextWindowPos({right, y}, ImGuiCond_Always, {0, share});
  ImGui::BeginTooltip();
  ImGui::TextUnformatted(fmt::format("Robot {}", individual.id).c_str());
  if (ImGui::BeginTable("origin", 2, ImGuiTableFlags_SizingFixedFit)) {
    entry("born in generation", std::to_string(individual.generation));
    entry(individual.parents.size() > 1 ? "parents" : "parent", parents_of(individual));
    if (assessment.fate != Fate::sound) entry("trial", std::string(name_of(assessment.fate)));
    for (std::size_t i = 0; i < assessment.scores.size() && i < settings.objectives.size(); ++i)
      entry(settings.objectives[i], score_text(assessment.scores[i]));
    ImGui::EndTable();
  }
  if (!assessment.values.empty() && ImGui::BeginTable("quantities", 4, ImGuiTableFlags_SizingFixedFit)) {
    for (std::size_t i = 0; i < assessment.values.size() && i < quantities().size(); ++i) {
      const Quantity& quantity = quantities()[i];
      if (!counts(quantity, assessment.fate)) continue;
      const bool is_score = std::ranges::find(settings.objectives, quantity.name) != settings.objectives.end();
      if (!is_score)
        entry(std::string(quantity.name), fmt::format("{} {}", score_text(assessment.values[i]), quantity.unit));
    }
    ImGui::EndTable();
  }
  if (!assessment.problem.empty()) {
    ImGui::PushTextWrapPos(24 * text);
    ImGui::TextUnformatted(brief(assessment.problem, 2000).c_str());
    ImGui::PopTextWrapPos();
  }
  ImGui::PushStyleColor(ImGuiCol_Text, palette().faint);
  ImGui::TextUnformatted(hint);
  ImGui::PopStyleColor();
  ImGui::EndTooltip();
}

}  // namespace mercury::window
