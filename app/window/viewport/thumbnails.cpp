// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/thumbnails.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "app/scene/appearance.h"
#include "app/scene/group_layout.h"
#include "app/window/toolkit/widgets.h"
#include "mercury/generator.h"
#include "mercury/stopwatch.h"

namespace mercury::window {

struct Thumbnails::Parts {
  struct Thumbnail {
    std::optional<render::KeptFrame> frame;  // none: its robot cannot be had
    std::uint64_t used = 0;                  // number of the last look for it
  };
  render::Context& gl_context;
  std::unique_ptr<render::Renderer> renderer;  // created with the first thumbnail
  std::map<std::string, Thumbnail> thumbnails;
  std::vector<std::pair<std::string, Source>> wanted;  // since the last work(), in the order of the screen
  std::uint64_t looks = 0;
  render::Theme theme = render::Theme::dark;

  render::KeptFrame draw(const Robot& robot);
  void drop_oldest();
};

Thumbnails::Thumbnails(render::Context& gl_context) : parts_(new Parts{.gl_context = gl_context}) {}
Thumbnails::~Thumbnails() = default;

bool Thumbnails::busy() const { return !parts_->wanted.empty(); }

ImTextureID Thumbnails::find(const std::string& name, const Source& robot) {
  const auto found = parts_->thumbnails.find(name);
  if (found == parts_->thumbnails.end()) {
    parts_->wanted.emplace_back(name, robot);
    return {};
  }
  found->second.used = ++parts_->looks;
  return found->second.frame ? (ImTextureID) static_cast<std::intptr_t>(found->second.frame->name()) : ImTextureID();
}

void Thumbnails::work(render::Theme theme, double seconds) {
  const double begin = wall_now();
  if (std::exchange(parts_->theme, theme) != theme) parts_->thumbnails.clear();
  for (const auto& [name, source] : std::exchange(parts_->wanted, {})) {
    if (parts_->thumbnails.contains(name)) continue;
    const std::shared_ptr<const Robot> robot = source();
    if (!robot) continue;
    Parts::Thumbnail& thumbnail = parts_->thumbnails[name];
    thumbnail.used = ++parts_->looks;
    if (!robot->masses.empty()) thumbnail.frame = parts_->draw(*robot);
    if (wall_now() - begin > seconds) break;
  }
  while (parts_->thumbnails.size() > most) parts_->drop_oldest();
}

void Thumbnails::Parts::drop_oldest() {
  thumbnails.erase(std::ranges::min_element(thumbnails, {}, [](const auto& entry) { return entry.second.used; }));
}

render::KeptFrame Thumbnails::Parts::draw(const Robot& robot) {
  if (!renderer)
    renderer = std::make_unique<render::Renderer>(
        gl_context, render::RendererOptions{.width = 2 * width, .height = 2 * height, .quality = render::Quality::low});
  const BodyShape shape(robot, 0);
  const render::Body body = shape.body();
  renderer->set_bodies(std::span(&body, 1));
  std::vector<render::RenderMaterial> materials;
  for (const render::Color color : material_colors(materials_of(robot), robot.materials.empty()))
    materials.push_back({.color = color});
  const Generator* generator = generator_of(robot);
  const render::Placement placement{.smooth = generator && generator->smooth};
  const render::Scene scene{.placements = std::span(&placement, 1),
                            .materials = materials,
                            .surroundings = render::Surroundings::none,
                            .theme = theme};
  render::Orbit orbit{.azimuth = -1.0f, .elevation = 0.5f};
  const render::Bounds bounds = rest_bounds(robot);
  orbit.frame(std::span(&bounds, 1), static_cast<float>(width) / height, 1.1f);
  renderer->draw(scene, orbit.camera());
  return render::KeptFrame(*renderer, width, height);
}

float thumbnail_row_height() { return std::round(2.1f * ImGui::GetFontSize()); }

bool thumbnail_row(const char* id, ImTextureID thumbnail, const std::string& text, bool selected,
                   ImGuiSelectableFlags flags) {
  const float height = thumbnail_row_height(), width = height * Thumbnails::width / Thumbnails::height;
  const float font = ImGui::GetFontSize(), room = ImGui::GetContentRegionAvail().x - width - 0.5f * font;
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::Selectable(id, selected, flags, {0, height});
  draw_thumbnail(thumbnail, {low.x, low.y + 1}, {low.x + width, low.y + height - 1});
  const auto lines = 1 + std::ranges::count(text, '\n');
  float y = low.y + (height - static_cast<float>(lines) * font) / 2;
  for (std::size_t begin = 0; begin <= text.size(); y += font) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    ImGui::GetWindowDrawList()->AddText({low.x + width + 0.5f * font, y}, ImGui::GetColorU32(ImGuiCol_Text),
                                        shortened(text.substr(begin, end - begin), room, true).c_str());
    begin = end + 1;
  }
  return clicked;
}

void thumbnail_row_cell(const std::string& text) {
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() + (thumbnail_row_height() - ImGui::GetFontSize()) / 2);
  right_aligned(text);
}

void draw_thumbnail(ImTextureID thumbnail, ImVec2 low, ImVec2 high, ImDrawFlags corners) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = std::min(ImGui::GetStyle().ChildRounding, 0.12f * (high.y - low.y));
  if (thumbnail)  // OpenGL textures start with the lowest row
    list.AddImageRounded(thumbnail, low, high, {0, 1}, {1, 0}, IM_COL32_WHITE, rounding, corners);
  else
    list.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg), rounding, corners);
}

}  // namespace mercury::window
