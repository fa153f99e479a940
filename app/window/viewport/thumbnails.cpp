// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewport/thumbnails.h"

#include <vector>

#include "app/scene/appearance.h"
#include "app/scene/group_layout.h"
#include "mercury/generator.h"

namespace mercury::window {

ImTextureID Thumbnails::find(const std::string& name) const {
  const auto found = pictures_.find(name);
  return found == pictures_.end() ? ImTextureID() : (ImTextureID) static_cast<std::intptr_t>(found->second.get());
}

void Thumbnails::draw(const std::string& name, const Robot& robot, render::Theme theme) {
  if (!renderer_)
    renderer_ = std::make_unique<render::Renderer>(
        gl_context_,
        render::RendererOptions{.width = 2 * width, .height = 2 * height, .quality = render::Quality::low});
  const BodyShape shape(robot, 0);
  const render::Body body = shape.body();
  renderer_->set_bodies(std::span(&body, 1));
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
  renderer_->draw(scene, orbit.camera());
  // Not an sRGB texture, which would look darker when ImGui samples it.
  render::Texture texture = render::make_texture(GL_RGBA8, width, height);
  const render::Framebuffer target = render::make_framebuffer({texture.get()});
  renderer_->present(target.get(), 0, 0, width, height);
  pictures_.insert_or_assign(name, std::move(texture));
}

}  // namespace mercury::window
