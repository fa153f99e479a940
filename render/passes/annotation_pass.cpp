// SPDX-License-Identifier: Apache-2.0
#include "render/passes/annotation_pass.h"

#include <png.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "render/particles.h"
#include "render/passes/bindings.h"
#include "render/passes/scene_buffers.h"
#include "render/text/font.h"

namespace mercury::render {
namespace {

constexpr float exposure = 1.0f / 12;  // [s]: what flows by leaves a streak this long

// As shaders/arrow.vert has it.
struct ArrowRecord {
  Vector4 from, vector, color;
};

// The layout of shaders/tile.vert.
struct TileRecord {
  Vector4 center, half_width, half_height, fill, frame;
};

// The layout of shaders/path.vert.
struct PathPoint {
  Vector4 position, color;
};

Vector4 linear(Color color, float alpha = 1) {
  const auto light = linear_of(color);
  return {light[0], light[1], light[2], alpha};
}

float bits_of(std::uint32_t value) { return std::bit_cast<float>(value); }

void append(const Path& path, std::vector<PathPoint>& points) {
  const std::size_t count = path.points.size() / 3;
  for (std::size_t i = 0; i < count; ++i) {
    const float* p = path.points.data() + 3 * i;
    const float age = 1 - float(i) / float(std::max<std::size_t>(1, count - 1));
    const float opacity = path.fades ? 0.95f - 0.9f * age : 0.8f;
    points.push_back({{p[0], p[1], p[2], bits_of(path.body)}, linear(path.color, i + 1 < count ? opacity : -opacity)});
  }
}

// Blends colors and keeps alpha, which is the share of light that glows.
class Blending {
 public:
  Blending() {
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glDepthMask(GL_FALSE);
  }
  ~Blending() {
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
  }
};

Texture make_atlas() {
  const auto file = font_data().png;
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  std::vector<std::uint8_t> texels;
  if (png_image_begin_read_from_memory(&png, file.data(), file.size())) {
    png.format = PNG_FORMAT_GRAY;
    texels.resize(PNG_IMAGE_SIZE(png));
    if (!png_image_finish_read(&png, nullptr, texels.data(), 0, nullptr)) texels.clear();
  }
  if (texels.empty()) throw std::logic_error("the built-in font cannot be read");
  Texture atlas = make_texture(GL_R8, int(png.width), int(png.height));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(atlas.get(), 0, 0, 0, GLsizei(png.width), GLsizei(png.height), GL_RED, GL_UNSIGNED_BYTE,
                      texels.data());
  return atlas;
}

}  // namespace

AnnotationPass::AnnotationPass(const std::string& defines)
    : empty_(make_vertex_array()), arrow_(make_program({"arrow.vert", "arrow.frag"})),
      path_(make_program({"path.vert", "path.frag"})), particle_(make_program({"particle.vert", "particle.frag"})),
      tile_(make_program({"tile.vert", "tile.frag"}, defines)) {}

void AnnotationPass::draw_arrows(std::span<const Arrow> arrows) {
  if (arrows.empty()) return;
  std::vector<ArrowRecord> records;
  records.reserve(arrows.size());
  for (const Arrow& a : arrows)
    records.push_back(
        {{a.from.x, a.from.y, a.from.z, bits_of(a.body)}, {a.vector.x, a.vector.y, a.vector.z, 0}, linear(a.color)});
  arrows_.write(records);
  arrows_.bind_storage(binding::first_free);
  glUseProgram(arrow_.get());
  glBindVertexArray(empty_.get());
  glEnable(GL_CLIP_DISTANCE0);
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(18 * arrows.size()));
  glDisable(GL_CLIP_DISTANCE0);
}

void AnnotationPass::draw_tiles(std::span<const Tile> tiles) {
  if (tiles.empty()) return;
  std::vector<TileRecord> records;
  records.reserve(tiles.size());
  for (const Tile& t : tiles)
    records.push_back(
        {Vector4(t.center, 0), Vector4(t.half_width, 0), Vector4(t.half_height, 0), linear(t.fill), linear(t.frame)});
  tiles_.write(records);
  tiles_.bind_storage(binding::first_free);
  const Blending blending;
  glUseProgram(tile_.get());
  glBindVertexArray(empty_.get());
  glDepthFunc(GL_GEQUAL);  // bodies are nearer than tiles; the backdrop is as far
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * tiles.size()));
  glDepthFunc(GL_GREATER);
}

void AnnotationPass::draw_paths(std::span<const Path> paths, float width) {
  std::vector<PathPoint> points;
  for (const Path& path : paths) append(path, points);
  if (points.size() < 2) return;
  points_.write(points);
  points_.bind_storage(binding::first_free);
  const Blending blending;
  glUseProgram(path_.get());
  glUniform1f(0, width);
  glBindVertexArray(empty_.get());
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * (points.size() - 1)));
}

void AnnotationPass::draw_particles(const Scene& scene, const Camera& camera, int count) {
  const Octave octave = octave_of((camera.eye - camera.target).norm());
  if (octave.share_of_double < 1) draw_particles(scene, camera, count, 1.1f * octave.size, 1 - octave.share_of_double);
  if (octave.share_of_double > 0) draw_particles(scene, camera, count, 2.2f * octave.size, octave.share_of_double);
}

void AnnotationPass::draw_particles(const Scene& scene, const Camera& camera, int count, float half_side, float share) {
  const Vector3 sight = (camera.target - camera.eye).normalized();
  const Vector3 middle = camera.target - 0.2f * half_side * sight;
  particles_.write(particles_in(scene, middle, half_side, count));
  particles_.bind_storage(binding::first_free);
  const Blending blending;
  glUseProgram(particle_.get());
  glUniform4f(0, middle.x, middle.y, middle.z, half_side);
  glUniform2f(1, exposure, share);
  glBindVertexArray(empty_.get());
  glDrawArrays(GL_TRIANGLES, 0, 6 * count);
}

OverlayPass::OverlayPass()
    : empty_(make_vertex_array()), program_(make_program({"overlay.vert", "overlay.frag"})), atlas_(make_atlas()) {}

void OverlayPass::draw(const Overlay& overlay, GLuint framebuffer, int width, int height, GLuint colormaps) {
  if (overlay.quads().empty()) return;
  quads_.write(overlay.quads());
  quads_.bind_storage(binding::first_free);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glUseProgram(program_.get());
  glUniform2f(0, float(width), float(height));
  glBindTextureUnit(0, atlas_.get());
  glBindTextureUnit(1, colormaps);
  glBindVertexArray(empty_.get());
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * overlay.quads().size()));
  glDisable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
}

}  // namespace mercury::render
