// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/viewport_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "app/window/toolkit/theme.h"
#include "render/overlay.h"

namespace mercury::window {
namespace {

ImU32 text_color() { return ImGui::GetColorU32(ImGuiCol_Text); }

void backing(ImVec2 low, ImVec2 high) {
  ImGui::GetBackgroundDrawList()->AddRectFilled(low, high, palette().on_picture, 0.35f * ImGui::GetFontSize());
}

// A line of text with a background; `at` is its upper left corner.
void line(ImVec2 at, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float margin = 0.4f * ImGui::GetFontSize();
  backing({at.x - margin, at.y - 0.6f * margin}, {at.x + size.x + margin, at.y + size.y + 0.6f * margin});
  ImGui::GetBackgroundDrawList()->AddText(at, text_color(), text.c_str());
}

struct TextBox {
  ImVec2 low, high;
  const std::string* text;
};

struct LabelAnchor {
  ImVec2 at;    // top centre of the robot, in the window
  float depth;  // distance from the camera
  const std::string* text;
};

// The labels of visible robots, near ones first.
std::vector<LabelAnchor> anchors_of(const render::Scene& scene, std::span<const render::Bounds> bounds,
                                    const ViewportArea& area, const render::Camera& camera) {
  std::vector<LabelAnchor> anchors;
  for (const render::Label& label : scene.labels) {
    if (label.body >= bounds.size() || bounds[label.body].empty()) continue;
    Eigen::Vector3f top = bounds[label.body].center();
    top.z() = bounds[label.body].high.z();
    const Eigen::Vector3f p = camera.project(top, static_cast<int>(area.width()), static_cast<int>(area.height()));
    if (p.z() > camera.near) anchors.push_back({{area.low.x + p.x(), area.low.y + p.y()}, p.z(), &label.text});
  }
  std::sort(anchors.begin(), anchors.end(),
            [](const LabelAnchor& a, const LabelAnchor& b) { return a.depth < b.depth; });
  return anchors;
}

// Above the robot, and inside the picture if the robot is.
TextBox box_above(const LabelAnchor& label, const ViewportArea& area, float margin) {
  const ImVec2 size = ImGui::CalcTextSize(label.text->c_str());
  TextBox box{{label.at.x - size.x / 2, label.at.y - size.y - margin},
              {label.at.x + size.x / 2, label.at.y - margin},
              label.text};
  if (label.at.y > area.low.y) box.low.y = std::max(box.low.y, area.low.y + margin);
  if (label.at.x > area.low.x && label.at.x < area.high.x)
    box.low.x =
        std::clamp(box.low.x, area.low.x + margin, std::max(area.low.x + margin, area.high.x - size.x - margin));
  box.high = {box.low.x + size.x, box.low.y + size.y};
  return box;
}

// A label that would cover a nearer one moves above it if there is room. Otherwise it stays, and is drawn behind it.
void draw_labels(const render::Scene& scene, std::span<const render::Bounds> bounds, const ViewportArea& area,
                 const render::Camera& camera) {
  const float text = ImGui::GetFontSize(), margin = 0.5f * text;
  std::vector<TextBox> boxes;
  for (const LabelAnchor& label : anchors_of(scene, bounds, area, camera)) {
    TextBox box = box_above(label, area, margin);
    const float height = box.high.y - box.low.y, wanted = box.low.y;
    for (int attempts = 0; attempts < 4; ++attempts) {
      const auto covered = std::find_if(boxes.begin(), boxes.end(), [&](const TextBox& other) {
        return box.low.x < other.high.x + margin && other.low.x < box.high.x + margin &&
               box.low.y < other.high.y + margin && other.low.y < box.high.y + margin;
      });
      if (covered == boxes.end()) break;
      box.low.y = covered->low.y - height - margin;
      box.high.y = covered->low.y - margin;
    }
    if (box.low.y < area.low.y || wanted - box.low.y > 5 * text) box.low.y = wanted;
    box.high.y = box.low.y + height;
    boxes.push_back(box);
  }
  for (auto box = boxes.rbegin(); box != boxes.rend(); ++box) line(box->low, *box->text);
}

// The scale bar: a round length, to scale at the distance of the camera's target.
void draw_scale_bar(const ViewportArea& area, const render::Camera& camera) {
  const float depth = (camera.target - camera.eye).norm();
  const float pixels_per_metre = area.height() / (2 * depth * std::tan(camera.field_of_view / 2));
  const float metres = render::round_length(0.22f * area.width() / pixels_per_metre),
              across = metres * pixels_per_metre;
  const float text = ImGui::GetFontSize();
  const std::string name = metres < 0.01f ? fmt::format("{:g} mm", 1000 * metres)
                           : metres < 1   ? fmt::format("{:g} cm", 100 * metres)
                                          : fmt::format("{:g} m", metres);
  const ImVec2 end{area.high.x - 1.4f * text, area.high.y - 1.2f * text};
  backing({end.x - across - 0.5f * text, end.y - 1.7f * text}, {end.x + 0.5f * text, end.y + 0.5f * text});
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled({end.x - across, end.y - 0.12f * text}, {end.x, end.y + 0.12f * text}, text_color());
  list.AddText({end.x - across / 2 - ImGui::CalcTextSize(name.c_str()).x / 2, end.y - 1.4f * text}, text_color(),
               name.c_str());
}

}  // namespace

render::Scene without_text(const render::Scene& scene) {
  render::Scene bare = scene;
  bare.labels = {};
  bare.legend.reset();
  bare.clock.clear();
  bare.caption.clear();
  bare.scale_bar = false;
  return bare;
}

void draw_viewport_text(const render::Scene& scene, std::span<const render::Bounds> bounds, const ViewportArea& area,
                        const render::Camera& camera, bool clock) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(area.low, area.high);
  const float text = ImGui::GetFontSize();
  draw_labels(scene, bounds, area, camera);
  if (!scene.caption.empty()) line({area.low.x + text, area.low.y + text}, scene.caption);
  if (clock && !scene.clock.empty()) line({area.low.x + text, area.high.y - 2 * text}, scene.clock);
  if (scene.scale_bar) draw_scale_bar(area, camera);
  list.PopClipRect();
}

}  // namespace mercury::window
