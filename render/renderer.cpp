#include "render/renderer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "render/annotation_pass.h"
#include "render/bindings.h"
#include "render/bodies.h"
#include "render/bounds_pass.h"
#include "render/finish_pass.h"
#include "render/frame_block.h"
#include "render/lattice_pass.h"
#include "render/light_pass.h"
#include "render/occlusion_pass.h"
#include "render/overlay_pass.h"
#include "render/quality.h"
#include "render/skin_pass.h"
#include "render/targets.h"

namespace mercury::render {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

// As shaders/bodies.glsl has it.
struct PlacementRecord {
  float x, y, z;
  std::uint32_t flags;
};

std::uint32_t flags_of(const Placement& place) {
  return (place.hidden ? 1u : 0u) | (place.selected ? 2u : 0u) | (place.faulty ? 4u : 0u) | (place.smooth ? 8u : 0u);
}

std::vector<PlacementRecord> placement_records(std::span<const Placement> placements, std::size_t bodies) {
  std::vector<PlacementRecord> records(std::max<std::size_t>(bodies, 1));
  for (std::size_t i = 0; i < std::min(bodies, placements.size()); ++i) {
    const Vector3f& offset = placements[i].offset;
    records[i] = {offset.x(), offset.y(), offset.z(), flags_of(placements[i])};
  }
  return records;
}

std::vector<Vector4f> look_records(std::span<const Look> looks) {
  std::vector<Vector4f> records;
  for (const Look& look : looks) {
    const auto linear = linear_of(look.color);
    records.push_back({linear[0], linear[1], linear[2], look.activation});
  }
  if (records.empty()) records.push_back({0.6f, 0.6f, 0.6f, 0});
  return records;
}

// The boxes of bodies as they stand in the picture; empty for one that is not shown.
std::vector<Bounds> placed(std::vector<Bounds> bodies, std::span<const Placement> placements) {
  for (std::size_t i = 0; i < std::min(bodies.size(), placements.size()); ++i)
    bodies[i] = placements[i].hidden ? Bounds{} : bodies[i].moved(placements[i].offset);
  return bodies;
}

Bounds joined(std::span<const Bounds> boxes) {
  Bounds all;
  for (const Bounds& box : boxes)
    if (!box.empty()) all.extend(box);
  return all;
}

// Whether some corner of the picture looks at, or nearly at, the horizon.
bool sees_horizon(const Camera& camera, int width, int height) {
  bool high = false;
  for (const int x : {0, width})
    for (const int y : {0, height}) high = high || camera.ray(float(x), float(y), width, height).direction.z() > -0.06f;
  return high;
}

// What the shaders are told of the scene before they are compiled.
std::string surroundings_variant(const Scene& scene, const FrameBlock& block) {
  return define("AROUND", int(scene.surroundings)) + define("OCTAVES", block.octave.z() > 0 ? 2 : 1);
}

std::string skin_variant(const Scene& scene) {
  const auto any = [&](auto property) { return std::any_of(scene.placements.begin(), scene.placements.end(), property); };
  return std::string(any([](const Placement& p) { return p.smooth; }) ? "#define ROUNDED\n" : "") +
         (any([](const Placement& p) { return p.selected || p.faulty; }) ? "#define MARKED\n" : "");
}

Overlay written(const Scene& scene, const Camera& camera, std::span<const Bounds> bodies, const Style& style, int width,
                int height, float text_size) {
  Overlay overlay(width, height, text_size, style);
  overlay.labels(scene.labels, bodies, camera);
  if (scene.legend) overlay.legend(*scene.legend);
  if (!scene.clock.empty()) overlay.clock(scene.clock);
  if (!scene.caption.empty()) overlay.caption(scene.caption);
  if (scene.scale_bar) overlay.length(camera);
  return overlay;
}

// One map a row, from the middle of the first texel to the middle of the last.
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

// What quality decides: thrown away and made anew when it changes.
struct Passes {
  explicit Passes(const QualitySettings& settings)
      : skin(settings.skin_defines()), lattice(settings.skin_defines()), light(settings), occlusion(settings), finish(settings), backdrop("backdrop.frag") {}
  void resize(int width, int height) {
    occlusion.resize(width, height);
    finish.resize(width, height);
  }
  SkinPass skin;
  LatticePass lattice;
  AnnotationPass annotation;
  LightPass light;
  OcclusionPass occlusion;
  FinishPass finish;
  Fullscreen backdrop;
};

}  // namespace

struct Renderer::Parts {
  int width = 0, height = 0;
  Quality quality = Quality::automatic;
  bool software = false;
  QualitySettings settings;
  Targets targets;
  Bodies bodies;
  Buffer frame, placements, looks, face_values, mass_values;
  Texture colormaps = make_colormaps();
  OverlayPass overlay;
  float text_size = 0;
  std::optional<Passes> passes;
  BoundsPass bounds;

  void upload(const Scene& scene);
  void bind() const;
};

Renderer::Renderer(const Context& context, const RendererOptions& options) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.software = context.is_software();
  p.text_size = options.text_size;
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
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
  parts_->bodies.set(bodies);
  parts_->passes->skin.attach(parts_->bodies);
}

std::size_t Renderer::body_count() const { return parts_->bodies.body_count(); }
std::size_t Renderer::mass_count() const { return parts_->bodies.mass_count(); }
std::size_t Renderer::face_count() const { return parts_->bodies.face_count(); }
std::size_t Renderer::spring_count() const { return parts_->bodies.spring_count(); }
std::span<const std::uint32_t> Renderer::mass_offsets() const { return parts_->bodies.mass_offsets(); }
unsigned Renderer::position_buffer() const { return parts_->bodies.positions.get(); }

std::vector<Bounds> Renderer::body_bounds() {
  parts_->bodies.positions.bind_storage(binding::positions);
  return parts_->bounds.measure(parts_->bodies);
}

void Renderer::Parts::upload(const Scene& scene) {
  const auto require = [](std::size_t size, std::size_t wanted, const char* what) {
    if (size != 0 && size != wanted) throw std::invalid_argument(std::string("Scene::") + what + " has the wrong length");
  };
  require(scene.positions.size(), 3 * bodies.mass_count(), "positions");
  require(scene.placements.size(), bodies.body_count(), "placements");
  require(scene.face_values.size(), bodies.face_count(), "face_values");
  require(scene.mass_values.size(), bodies.mass_count(), "mass_values");
  require(scene.spring_values.size(), bodies.spring_count(), "spring_values");
  if (!scene.positions.empty())
    glNamedBufferSubData(bodies.positions.get(), 0, GLsizeiptr(scene.positions.size_bytes()), scene.positions.data());
  placements.write(placement_records(scene.placements, bodies.body_count()));
  looks.write(look_records(scene.looks));
  face_values.write(scene.face_values);
  mass_values.write(scene.mass_values);
}

void Renderer::Parts::bind() const {
  frame.bind_uniform(0);
  bodies.positions.bind_storage(binding::positions);
  placements.bind_storage(binding::placements);
  bodies.mass_bodies.bind_storage(binding::mass_bodies);
  bodies.face_records.bind_storage(binding::face_records);
  looks.bind_storage(binding::looks);
  face_values.bind_storage(binding::face_values);
  mass_values.bind_storage(binding::mass_values);
}

void Renderer::draw(const Scene& scene, const Camera& camera) {
  Parts& p = *parts_;
  const Style style = style_of(scene.surroundings, scene.theme);
  p.upload(scene);
  const std::vector<Bounds> boxes = placed(body_bounds(), scene.placements);
  const Bounds group = joined(boxes);
  const ShadowFit shadow = fit_shadow(group, style.to_key, p.settings.shadow_side);
  const FrameBlock block = frame_block(scene, camera, style, shadow, group, p.settings.ground_side, p.width, p.height);
  const std::string variant = surroundings_variant(scene, block);
  p.frame.write(&block, sizeof block);
  p.bind();
  glDisable(GL_BLEND);
  // Skins are closed: their insides show where they are cut alone.
  scene.cut ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);

  Passes& passes = *p.passes;
  const bool smooth = std::any_of(scene.placements.begin(), scene.placements.end(), [](const auto& x) { return x.smooth; });
  passes.skin.deform(p.bodies, smooth);
  passes.light.draw(scene.surroundings == Surroundings::water, scene.surroundings != Surroundings::none,
                    [&] {
                      if (scene.show.skin) passes.skin.draw_shadow(p.bodies);
                      passes.lattice.draw_shadow(p.bodies, scene);
                    });
  passes.occlusion.draw(6 * p.bodies.typical_spring(), [&] { if (scene.show.skin) passes.skin.draw_depth(p.bodies); });

  glBindFramebuffer(GL_FRAMEBUFFER, p.targets.drawing.get());
  glViewport(0, 0, p.width, p.height);
  const float farthest = 0;
  glClearNamedFramebufferfv(p.targets.drawing.get(), GL_DEPTH, 0, &farthest);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glBindTextureUnit(binding::colormap, p.colormaps.get());
  const auto color_by = !scene.face_values.empty()   ? SkinPass::ColorBy::face_values
                        : !scene.mass_values.empty() ? SkinPass::ColorBy::mass_values
                                                     : SkinPass::ColorBy::looks;
  if (scene.show.skin) passes.skin.draw(p.bodies, color_by, scene.scale, variant + skin_variant(scene));
  glDisable(GL_CULL_FACE);
  passes.lattice.draw(p.bodies, scene);
  passes.annotation.draw_arrows(scene.arrows);
  glDepthFunc(GL_GEQUAL);
  passes.backdrop.draw(variant + (sees_horizon(camera, p.width, p.height) ? "#define HORIZON\n" : ""));
  glDepthFunc(GL_GREATER);
  passes.annotation.draw_paths(scene.paths, 0.0035f * float(p.height));
  if (scene.surroundings == Surroundings::water) passes.annotation.draw_particles(scene, camera, p.settings.particles);
  passes.finish.draw(p.targets.light.get(), p.targets.finished.get(), style.vignette);
  p.overlay.draw(written(scene, camera, boxes, style, p.width, p.height, p.text_size), p.targets.finished.get(), p.width,
                 p.height, p.colormaps.get());
}

unsigned Renderer::picture() const { return parts_->targets.picture.get(); }

void Renderer::present(unsigned framebuffer, int x, int y, int width, int height) const {
  const GLenum filter = width == parts_->width && height == parts_->height ? GL_NEAREST : GL_LINEAR;
  glBlitNamedFramebuffer(parts_->targets.finished.get(), framebuffer, 0, 0, parts_->width, parts_->height, x, y,
                         x + width, y + height, GL_COLOR_BUFFER_BIT, filter);
}

}  // namespace mercury::render
