// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/thumbnails.h"

#include <cstdint>
#include <map>
#include <vector>

#include "app/scene/appearance.h"
#include "app/scene/group_layout.h"
#include "mercury/generator.h"
#include "render/renderer.h"

namespace mercury::window {

struct Thumbnails::Parts {
  render::Context& gl_context;
  std::unique_ptr<render::Renderer> renderer;  // created with the first picture
  std::map<std::string, render::KeptFrame> pictures;
};

Thumbnails::Thumbnails(render::Context& gl_context) : parts_(new Parts{gl_context, nullptr, {}}) {}
Thumbnails::~Thumbnails() = default;

void Thumbnails::clear() { parts_->pictures.clear(); }

ImTextureID Thumbnails::find(const std::string& name) const {
  const auto found = parts_->pictures.find(name);
  return found == parts_->pictures.end() ? ImTextureID()
                                         : (ImTextureID) static_cast<std::intptr_t>(found->second.name());
}

void Thumbnails::draw(const std::string& name, const Robot& robot, render::Theme theme) {
  if (!parts_->renderer)
    parts_->renderer = std::make_unique<render::Renderer>(
        parts_->gl_context,
        render::RendererOptions{.width = 2 * width, .height = 2 * height, .quality = render::Quality::low});
  const BodyShape shape(robot, 0);
  const render::Body body = shape.body();
  parts_->renderer->set_bodies(std::span(&body, 1));
  std::vector<render::RenderMaterial> materials;
  for (const render::Color color : material_colors(materials_of(robot), robot.materials.empty()))
    materials.push_back({.color = color});
  const Generator* generator = generator_of(robot);
  const render::Placement placement{.smooth = generator && generator->smooth};
  render::Scene scene{.placements = std::span(&placement, 1),
                      .materials = materials,
                      .surroundings = render::Surroundings::none,
                      .theme = theme};
  render::Orbit orbit{.azimuth = -1.0f, .elevation = 0.5f};
  const render::Bounds bounds = rest_bounds(robot);
  orbit.frame(std::span(&bounds, 1), static_cast<float>(width) / height, 1.1f);
  parts_->renderer->draw(scene, orbit.camera());
  parts_->pictures.insert_or_assign(name, render::KeptFrame(*parts_->renderer, width, height));
}

}  // namespace mercury::window
