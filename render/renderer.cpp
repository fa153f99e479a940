// SPDX-License-Identifier: Apache-2.0
#include "render/renderer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

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

bool has_ground_cover(const Scene& scene) {
  return scene.ground_cover && scene.surroundings != Surroundings::none && scene.ground_cover->height > 0;
}

std::string skin_variant(const Scene& scene, bool fine) {
  const bool rounded = fine || any_placement(scene, [](const Placement& p) { return p.smooth; });
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
  p.fine.reset();
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
  parts_->body_data = bodies;
  parts_->fine.reset();
  parts_->bodies.set(std::move(bodies));
  parts_->passes->skin.attach(parts_->bodies);
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
void Renderer::Parts::prepare(const Scene& scene, const Camera& camera, const Style& style, float noise) {
  if (scene.show.springs || scene.cut) bodies.write_springs();
  scene_buffers.upload(scene, bodies, is_fine);
  scene_buffers.bind(bodies);
  bounds.measure(bodies);
  if (scene.cut) cut.find(bodies, *scene.cut);
  if (!scene.labels.empty()) bounds.start_reading();
  FrameBlock block = frame_block(scene, camera, style, width, height, noise);
  block.lens.w = 1.7f * bodies.typical_spring();
  frame.write(&block, sizeof block);
  fit.fit(frame.last(), bounds.boxes(), bodies.body_count(), settings.shadow_side, settings.ground_side);
  frame.bind_uniform(0);
  variant = surroundings_variant(scene, block);
  if (has_ground_cover(scene)) ground_cover.place(scene, camera, bounds, bodies.body_count());
  if (is_fine) {
    fine->follow(bodies);
    scene_buffers.bind(fine->bodies());
    if (!scene.mass_values.empty()) fine->bind_values();
  }
  skin().deform(drawn_bodies(), is_fine || any_placement(scene, [](const Placement& p) { return p.smooth; }),
                scene.cut.has_value());
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
    if (scene.show.skin) skin().draw_shadow();
    passes->lattice.draw_shadow(bodies, scene);
  });
  timer.mark("shadow map");
  passes->light.draw_maps(scene.surroundings == Surroundings::water,
                          scene.surroundings != Surroundings::none || scene.catch_shadows);
  timer.mark("light on the floor");
  if (draws_inside(scene))
    section.find([&] {
      draw_sides(scene,
                 [&](const std::string& side) { skin().draw_depth(side == cut_variant ? backs_variant : side); });
    });
  passes->front.draw([&] { draw_sides(scene, [&](const char* side) { skin().draw_depth(side); }); });
  timer.mark("nearest surfaces");
  glDisable(GL_CULL_FACE);
  passes->occlusion.draw(passes->front.depths(), 6 * bodies.typical_spring());
  timer.mark("occlusion");
  passes->front.find_light(variant);
  timer.mark("light on skins");
}

void Renderer::Parts::draw_solid(const Scene& scene, const Camera& camera, const Style& style) {
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
  draw_sides(scene, [&](const char* side) {
    skin().draw(color_by, scene.scale, variant + skin_variant(scene, is_fine) + side);
  });
  glDisable(GL_CULL_FACE);
  timer.mark("skins");
  passes->lattice.draw(bodies, scene);
  passes->annotation.draw_arrows(scene.arrows);
  timer.mark("springs and masses");
  if (has_ground_cover(scene)) ground_cover.draw(scene, style, variant);
  glDepthFunc(GL_GEQUAL);
  const std::string on_ground = variant + passes->prints.variant();
  const std::string& floor = scene.patches.empty() ? on_ground : variant;
  if (scene.surroundings != Surroundings::none && shows_horizon(camera, width, height)) {
    // Two parts, since renderers on the CPU compute both sides of a branch.
    glEnable(GL_CLIP_DISTANCE0);
    passes->backdrop.draw(variant + "#define HORIZON\n#define FAR_PART\n");
    passes->backdrop.draw(floor + "#define NEAR_PART\n");
    glDisable(GL_CLIP_DISTANCE0);
  } else {
    passes->backdrop.draw(floor);
  }
  if (scene.surroundings == Surroundings::land) patches.draw(scene.patches, on_ground);
  if (has_ground_cover(scene)) ground_cover.draw_shades(scene);
  timer.mark("surroundings");
}

// The light that water or air scatters toward the eye.
void Renderer::Parts::draw_beams() const {
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_ONE, GL_ONE, GL_ZERO, GL_ONE);
  glBindTextureUnit(binding::source, passes->front.depths());
  passes->beams.draw(variant);
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
}

void Renderer::Parts::draw_light_of(const Scene& scene, const Camera& camera, const Style& style, float noise) {
  prepare(scene, camera, style, noise);
  timer.mark("positions");
  draw_light(scene);
  draw_solid(scene, camera, style);
  if (scene.against_light && scene.surroundings != Surroundings::none) draw_beams();
  glDepthFunc(GL_GREATER);
  passes->annotation.draw_tiles(scene.tiles);
  passes->annotation.draw_paths(scene.paths, 0.0035f * float(height));
  if (scene.surroundings == Surroundings::water) passes->annotation.draw_particles(scene, camera, settings.particles);
  ghosts.draw(scene.ghosts);
}

// Rounded bodies have a finer skin: subdivided twice, as once shows kinks. Where a picture takes its time, larger
// groups are subdivided once.
void Renderer::Parts::choose_skin(const Scene& scene, bool takes_time) {
  const std::size_t most_faces = takes_time || !software ? 200'000 : 60'000;
  const std::size_t most_once = takes_time ? 600'000 : 0;
  const bool all_smooth = std::ranges::all_of(scene.placements, [](const Placement& p) { return p.smooth; });
  const bool twice = 16 * bodies.face_count() <= most_faces;
  is_fine = (scene.rounded || (takes_time && all_smooth)) && !scene.cut && scene.show.skin && !scene.show.springs &&
            !scene.show.masses && body_data && !body_data->records.empty() &&
            (twice || 4 * bodies.face_count() <= most_once);
  if (!is_fine) return;
  const int times = twice ? 2 : 1;
  if (!fine || fine->times() != times)
    fine.emplace(subdivided(*body_data, times), times, Passes::skin_defines(settings));
}

void Renderer::Parts::draw_through_lens(const Scene& scene, const Camera& camera, const Style& style) {
  constexpr float left = 0.35f;  // of the key light's size in each picture
  const Vector3 to_key = style.to_key.normalized();
  const Vector3 across = to_key.cross(Vector3::unit(1)).normalized(), along = to_key.cross(across);
  const int samples = std::min(camera.lens.samples, settings.lens_samples);
  Camera through = camera;
  through.lens.samples = samples;
  for (int i = 0; i < samples; ++i) {
    if (i > 0) pace.begin();
    // Each picture has another point of the key light, which is a disc; together they have soft shadows.
    const Vector2 on_light = style.key_size * disc_sample((7 * i + 3) % samples, samples);
    Style lit = style;
    lit.to_key = to_key + on_light.x * across + on_light.y * along;
    lit.key_size = left * style.key_size;
    draw_light_of(scene, through.seen_through_lens(i, height), lit, std::fmod(0.618034f * float(i), 1.0f));
    passes->mean.add(targets.light.get(), i == 0);
    if (i + 1 < samples) pace.end();
  }
  passes->mean.draw(targets.drawing.get(), samples);
}

void Renderer::draw(const Scene& scene, const Camera& camera) {
  Parts& p = *parts_;
  const bool values = !scene.face_values.empty() || !scene.mass_values.empty() || !scene.spring_values.empty();
  Style style = style_of(scene.surroundings, scene.theme, values);
  if (scene.against_light) set_against_light(style, *scene.against_light, scene.surroundings);
  if (scene.flat_backdrop) {
    const float light = *scene.flat_backdrop;
    style.backdrop_high = style.backdrop_low = {light, light, light};
    style.fog = {0, 0, 0};
    style.vignette = style.glow = 0;
  }
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);  // others may draw in this context, too
  p.pace.begin();
  p.timer.begin();
  p.choose_skin(scene, camera.lens.samples > 1);
  p.passes->prints.draw(scene, camera, style);
  if (!p.passes->prints.variant().empty()) p.timer.mark("prints");
  camera.lens.samples > 1 ? p.draw_through_lens(scene, camera, style) : p.draw_light_of(scene, camera, style, 0);
  p.passes->finish.draw(p.targets.light.get(), p.targets.bytes.get(), scene.tiles.empty() ? style.vignette : 0);
  p.outline.draw(p.drawn_bodies(), scene, p.passes->lattice, p.bounds.boxes(), p.targets);
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
