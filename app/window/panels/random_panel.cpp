// SPDX-License-Identifier: Apache-2.0
#include "app/window/panels/random_panel.h"

#include <algorithm>

#include "app/window/toolkit/widgets.h"

namespace mercury::window {
namespace {

bool whole_number(const char* name, const char* explanation, int& value, int low, int high, PanelContext& context,
                  const char* item) {
  ImGui::PushID(name);
  row(name, explanation);
  const bool changed = ImGui::InputInt("##value", &value, 1, 10);
  context.log.item(item);
  ImGui::PopID();
  value = std::clamp(value, low, high);
  return changed;
}

}  // namespace

void RandomPanel::draw(PanelContext& context) {
  heading("Random robots");
  int kind = static_cast<int>(generation.kind);
  if (combo("kind", "voxel: patches of muscle, tissue and bone. Network: grown by a neural network", kind,
            {"voxel", "network"}))
    generation.kind = static_cast<Generation::Kind>(kind);
  context.log.item("generate.kind");
  auto count = static_cast<int>(generation.count), seed = static_cast<int>(generation.seed);
  whole_number("count", "how many robots", count, 1, 4096, context, "generate.count");
  whole_number("seed", "the same seed gives the same robots", seed, 0, 1'000'000'000, context, "generate.seed");
  generation.count = static_cast<std::size_t>(count);
  generation.seed = static_cast<std::uint64_t>(seed);
  if (generation.kind == Generation::Kind::voxel)
    draw_voxel_options(context);
  else
    draw_network_options(context);
  ImGui::Checkbox("Replace", &replace_);
  context.log.item("generate.replace");
  tooltip("the new robots take the place of those in the scene; otherwise they come beside them");
  ImGui::SameLine();
  if (ImGui::Button("Generate", {-1, 0})) generate(context);
  context.log.item("generate");
  tooltip("and count the seed up (key N)");
}

void RandomPanel::draw_voxel_options(PanelContext& context) {
  RandomVoxelOptions& voxel = generation.voxel;
  row("smallest", "voxels along x, y and z");
  ImGui::InputInt3("##smallest", voxel.smallest.data());
  row("largest", "voxels along x, y and z");
  ImGui::InputInt3("##largest", voxel.largest.data());
  for (std::size_t i = 0; i < 3; ++i) {
    voxel.smallest[i] = std::clamp(voxel.smallest[i], 1, 24);
    voxel.largest[i] = std::clamp(voxel.largest[i], voxel.smallest[i], 24);
  }
  auto air = static_cast<float>(100 * voxel.air);
  if (slider("air", "share of the voxels that are empty", air, 30, {0, 90, "%.0f %%"}))
    voxel.air = std::clamp(static_cast<double>(air) / 100, 0.0, 0.95);
  context.log.item("generate.air");
  int mirror = static_cast<int>(voxel.mirror);
  if (combo("symmetry", "halves that face each other along this axis", mirror, {"none", "x", "y", "z"}))
    voxel.mirror = static_cast<Mirror>(mirror);
  context.log.item("generate.symmetry");
}

void RandomPanel::draw_network_options(PanelContext& context) {
  auto points = static_cast<int>(generation.network.points);
  whole_number("points", "that the body is grown from", points, 64, 8192, context, "generate.points");
  generation.network.points = static_cast<std::size_t>(points);
  auto mirrored = static_cast<float>(100 * generation.network.mirrored);
  if (slider("symmetry", "share of robots with alike halves", mirrored, 50, {0, 100, "%.0f %%"}))
    generation.network.mirrored = std::clamp(static_cast<double>(mirrored) / 100, 0.0, 1.0);
}

void RandomPanel::generate(PanelContext& context) {
  context.scene.generate(generation, replace_);
  ++generation.seed;
}

float RandomPanel::height() const {
  const float rows = generation.kind == Generation::Kind::voxel ? 8 : 6;
  return rows * ImGui::GetFrameHeightWithSpacing() + 2.2f * ImGui::GetFontSize();
}

}  // namespace mercury::window
