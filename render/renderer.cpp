// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "render/bindings.h"
#include "render/renderer_parts.h"

namespace mercury::render {

Texture make_colormaps() {
  std::vector<float> texels;
  for (int map = 0; map < colormap_count; ++map)
    for (int i = 0; i < colormap_entries; ++i) {
      const auto linear = linear_of(color_at(Colormap(map), float(i) / float(colormap_entries - 1)));
      texels.insert(texels.end(), linear.begin(), linear.end());
    }
  Texture texture = make_texture(GL_RGB16F, colormap_entries, colormap_count);
  glTextureSubImage2D(texture.get(), 0, 0, 0, colormap_entries, colormap_count, GL_RGB, GL_FLOAT, texels.data());
  return texture;
}

Renderer::Renderer(const Context& context, const RendererOptions& options) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.software = context.is_software();
  p.text_size = options.text_size;
  set_quality(options.quality);
  resize(options.width, options.height);
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::resize(int width, int height) {
  Parts& p = *parts_;
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (width < 1 || height < 1 || width > largest || height > largest)
    throw ContextError("a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                       " pixels cannot be drawn here, at most " + std::to_string(largest) + " a side");
  if (width == p.width && height == p.height) return;
  p.targets = make_targets(width, height, p.settings.samples);
  p.passes->resize(width, height);
  p.section.resize(width, height);
  p.outline.resize(width, height);
  p.width = width;
  p.height = height;
}

void Renderer::set_quality(Quality quality) {
  Parts& p = *parts_;
  if (quality == Quality::automatic) quality = p.software ? Quality::low : Quality::high;
  if (quality == p.quality) return;
  p.quality = quality;
  p.settings = settings_of(quality);
  p.passes.emplace(p.settings);
  p.passes->skin.attach(p.bodies);
  if (p.width > 0) resize(std::exchange(p.width, 0), p.height);
}

int Renderer::width() const { return parts_->width; }
int Renderer::height() const { return parts_->height; }
Quality Renderer::quality() const { return parts_->quality; }

void Renderer::set_bodies(std::span<const Body> bodies) {
  std::vector<std::shared_ptr<const PreparedBody>> prepared;
  for (const Body& body : bodies) prepared.push_back(prepare_body(body, prepared.size()));
  set_bodies(assemble(prepared));
}

void Renderer::set_bodies(std::shared_ptr<const BodyData> bodies) {
  parts_->bodies.set(std::move(bodies));
  parts_->passes->skin.attach(parts_->bodies);
  parts_->outline.attach(parts_->bodies);
}

std::size_t Renderer::body_count() const { return parts_->bodies.body_count(); }
std::size_t Renderer::mass_count() const { return parts_->bodies.mass_count(); }
std::size_t Renderer::face_count() const { return parts_->bodies.face_count(); }
std::size_t Renderer::spring_count() const { return parts_->bodies.spring_count(); }
std::span<const std::uint32_t> Renderer::mass_offsets() const { return parts_->bodies.mass_offsets(); }
unsigned Renderer::position_buffer() const { return parts_->bodies.positions.get(); }

std::vector<Bounds> Renderer::body_bounds() {
  parts_->bodies.positions.bind_storage(binding::positions);
  parts_->bounds.measure(parts_->bodies);
  parts_->bounds.start_reading();
  return parts_->bounds.read();
}

const std::vector<PassTime>& Renderer::times() const { return parts_->timer.times(); }

unsigned Renderer::picture() const { return parts_->targets.picture.get(); }

void Renderer::present(unsigned framebuffer, int x, int y, int width, int height) const {
  const GLenum filter = width == parts_->width && height == parts_->height ? GL_NEAREST : GL_LINEAR;
  glBlitNamedFramebuffer(parts_->targets.finished.get(), framebuffer, 0, 0, parts_->width, parts_->height, x, y,
                         x + width, y + height, GL_COLOR_BUFFER_BIT, filter);
}

KeptFrame::KeptFrame(const Renderer& renderer, int width, int height) {
  Texture texture = make_texture(GL_RGBA8, width, height);
  const Framebuffer target = make_framebuffer({texture.get()});
  renderer.present(target.get(), 0, 0, width, height);
  name_ = texture.release();
}

KeptFrame::~KeptFrame() {
  if (name_) glDeleteTextures(1, &name_);
}

}  // namespace mercury::render
