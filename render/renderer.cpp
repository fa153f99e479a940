// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "render/passes/bindings.h"
#include "render/passes/scene_buffers.h"
#include "render/renderer_parts.h"

namespace mercury::render {
namespace {

// Whether the ray through a corner of the picture reaches the horizon, or nearly.
bool shows_horizon(const Camera& camera, int width, int height) {
  bool high = false;
  for (const int x : {0, width})
    for (const int y : {0, height}) high = high || camera.ray(float(x), float(y), width, height).direction.z > -0.06f;
  return high;
}

// Properties of the scene that shaders are compiled for.
std::string surroundings_variant(const Scene& scene, const FrameBlock& block) {
  return define("AROUND", int(scene.surroundings)) + define("OCTAVES", block.octave.z > 0 ? 2 : 1) +
         (scene.catch_shadows ? "#define CATCH_SHADOWS\n" : "");
}

template <typename Property>
bool any_placement(const Scene& scene, Property property) {
  return std::any_of(scene.placements.begin(), scene.placements.end(), property);
}

// Whether cut bodies show their solid inside. When springs or masses are drawn, bodies stay hollow so that those are
// visible.
bool draws_inside(const Scene& scene) {
  return scene.cut && scene.show.skin && !scene.show.springs && !scene.show.masses;
}

std::string skin_variant(const Scene& scene) {
  const bool rounded = any_placement(scene, [](const Placement& p) { return p.smooth; });
  const bool marked = any_placement(scene, [](const Placement& p) { return p.faulty; });
  return std::string(rounded ? "#define ROUNDED\n" : "") + (marked ? "#define MARKED\n" : "");
}

Overlay overlay_of(const Scene& scene, const Camera& camera, std::span<const Bounds> bodies, const Style& style,
                   int width, int height, float text_size) {
  Overlay overlay(width, height, text_size, style);
  overlay.texts(scene.texts, camera);
  overlay.labels(scene.labels, bodies, camera);
  if (scene.legend) overlay.legend(*scene.legend);
  if (!scene.clock.empty()) overlay.clock(scene.clock);
  if (!scene.caption.empty()) overlay.caption(scene.caption);
  if (scene.scale_bar) overlay.length(camera);
  return overlay;
}

}  // namespace

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

void Renderer::mix_positions(const PositionSource& a, const PositionSource& b, float share) {
  const auto bind = [&](unsigned at, const PositionSource& source) {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, at, source.buffer, GLintptr(source.offset),
                      GLsizeiptr(12 * mass_count()));
  };
  if (mass_count() == 0) return;
  parts_->bodies.positions.bind_storage(binding::positions);
  bind(binding::first_free, a);
  bind(binding::first_free + 1, b);
  parts_->mix.mix(3 * mass_count(), share);
}

std::vector<Bounds> Renderer::body_bounds() {
  parts_->bodies.positions.bind_storage(binding::positions);
  parts_->bounds.measure(parts_->bodies);
  parts_->bounds.start_reading();
  return parts_->bounds.read();
}

const std::vector<PassTime>& Renderer::times() const { return parts_->timer.times(); }

const Overlay& Renderer::overlay() const { return *parts_->text; }

unsigned Renderer::picture() const { return parts_->targets.picture.get(); }

void Renderer::present(unsigned framebuffer, int x, int y, int width, int height) const {
  const GLenum filter = width == parts_->width && height == parts_->height ? GL_NEAREST : GL_LINEAR;
  glBlitNamedFramebuffer(parts_->targets.finished.get(), framebuffer, 0, 0, parts_->width, parts_->height, x, y,
                         x + width, y + height, GL_COLOR_BUFFER_BIT, filter);
}

KeptFrame::KeptFrame(const Renderer& renderer, int width, int height) {
  const int levels = std::bit_width(static_cast<unsigned>(std::max(width, height)));
  Texture texture = make_texture(GL_RGBA8, width, height, 0, levels);
  const Framebuffer target = make_framebuffer({texture.get()});
  renderer.present(target.get(), 0, 0, width, height);
  glGenerateTextureMipmap(texture.get());
  glTextureParameteri(texture.get(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  name_ = texture.release();
}

KeptFrame::~KeptFrame() {
  if (name_) glDeleteTextures(1, &name_);
}

// Uploads the scene, and computes what depends on positions: boxes, the frame's block, normals, lists of faces.
void Renderer::Parts::prepare(const Scene& scene, const Camera& camera, const Style& style) {
  if (scene.show.springs || scene.cut) bodies.write_springs();
  scene_buffers.upload(scene, bodies);
  scene_buffers.bind(bodies);
  bounds.measure(bodies);
  if (scene.cut) cut.find(bodies, *scene.cut);
  if (!scene.labels.empty()) bounds.start_reading();
  const FrameBlock block = frame_block(scene, camera, style, width, height);
  frame.write(&block, sizeof block);
  fit.fit(frame.last(), bounds.boxes(), bodies.body_count(), settings.shadow_side, settings.ground_side);
  frame.bind_uniform(0);
  variant = surroundings_variant(scene, block);
  passes->skin.deform(bodies, any_placement(scene, [](const Placement& p) { return p.smooth; }), scene.cut.has_value());
}

// Calls draw_skins(variant) for each visible side of the skins: the fronts, and where a cut shows solid insides, the
// backs.
template <typename Draw>
void Renderer::Parts::draw_sides(const Scene& scene, Draw draw_skins) {
  if (!scene.show.skin) return;
  const bool inside = draws_inside(scene);
  // Skins are closed, so backs are visible only through a cut.
  scene.cut && !inside ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
  draw_skins("");
  if (!inside) return;
  glCullFace(GL_FRONT);
  draw_skins(cut_variant);
  glCullFace(GL_BACK);
}

void Renderer::Parts::draw_light(const Scene& scene) {
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  scene.cut ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
  passes->light.draw_shadows([&] {
    if (scene.show.skin) passes->skin.draw_shadow();
    passes->lattice.draw_shadow(bodies, scene);
  });
  timer.mark("shadow map");
  passes->light.draw_maps(scene.surroundings == Surroundings::water,
                          scene.surroundings != Surroundings::none || scene.catch_shadows);
  timer.mark("light on the floor");
  if (draws_inside(scene))
    section.find([&] {
      draw_sides(scene,
                 [&](const std::string& side) { passes->skin.draw_depth(side == cut_variant ? backs_variant : side); });
    });
  passes->front.draw([&] { draw_sides(scene, [&](const char* side) { passes->skin.draw_depth(side); }); });
  timer.mark("nearest surfaces");
  glDisable(GL_CULL_FACE);
  passes->occlusion.draw(passes->front.depths(), 6 * bodies.typical_spring());
  timer.mark("occlusion");
  passes->front.find_light(variant);
  timer.mark("light on skins");
}

void Renderer::Parts::draw_solid(const Scene& scene, const Camera& camera) {
  glBindTextureUnit(binding::colormap, colormaps.get());
  if (draws_inside(scene)) section.draw(bodies, scene);
  glBindFramebuffer(GL_FRAMEBUFFER, targets.drawing.get());
  glViewport(0, 0, width, height);
  const float farthest = 0;
  glClearNamedFramebufferfv(targets.drawing.get(), GL_DEPTH, 0, &farthest);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  const auto color_by = !scene.face_values.empty()   ? SkinPass::ColorBy::face_values
                        : !scene.mass_values.empty() ? SkinPass::ColorBy::mass_values
                                                     : SkinPass::ColorBy::materials;
  draw_sides(scene,
             [&](const char* side) { passes->skin.draw(color_by, scene.scale, variant + skin_variant(scene) + side); });
  glDisable(GL_CULL_FACE);
  timer.mark("skins");
  passes->lattice.draw(bodies, scene);
  passes->annotation.draw_arrows(scene.arrows);
  timer.mark("springs and masses");
  glDepthFunc(GL_GEQUAL);
  passes->backdrop.draw(variant + (shows_horizon(camera, width, height) ? "#define HORIZON\n" : ""));
  if (scene.surroundings == Surroundings::land) patches.draw(scene.patches, variant);
  timer.mark("surroundings");
}

void Renderer::draw(const Scene& scene, const Camera& camera) {
  Parts& p = *parts_;
  const bool values = !scene.face_values.empty() || !scene.mass_values.empty() || !scene.spring_values.empty();
  Style style = style_of(scene.surroundings, scene.theme, values);
  if (scene.flat_backdrop) {
    const float light = *scene.flat_backdrop;
    style.backdrop_high = style.backdrop_low = {light, light, light};
    style.fog = {0, 0, 0};
    style.vignette = style.glow = 0;
  }
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);  // others may draw in this context, too
  p.pace.begin();
  p.timer.begin();
  p.prepare(scene, camera, style);
  p.timer.mark("positions");
  p.draw_light(scene);
  p.draw_solid(scene, camera);
  glDepthFunc(GL_GREATER);
  p.passes->annotation.draw_tiles(scene.tiles);
  p.passes->annotation.draw_paths(scene.paths, 0.0035f * float(p.height));
  if (scene.surroundings == Surroundings::water)
    p.passes->annotation.draw_particles(scene, camera, p.settings.particles);
  p.ghosts.draw(scene.ghosts);
  p.passes->finish.draw(p.targets.light.get(), p.targets.bytes.get(), scene.tiles.empty() ? style.vignette : 0);
  p.outline.draw(p.bodies, scene, p.passes->lattice, p.bounds.boxes(), p.targets);
  // The boxes were measured long ago, and the GPU still has the picture to draw: nobody waits.
  const std::vector<Bounds> boxes =
      scene.labels.empty() ? std::vector<Bounds>() : placed(p.bounds.read(), scene.placements);
  p.text = overlay_of(scene, camera, boxes, style, p.width, p.height, p.text_size);
  if (!scene.text_aside) p.overlay.draw(*p.text, p.targets.finished.get(), p.width, p.height, p.colormaps.get());
  p.timer.mark("finish");
  p.timer.end();
  p.pace.end();
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDepthFunc(GL_LESS);
}

}  // namespace mercury::render
