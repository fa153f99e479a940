// SPDX-License-Identifier: Apache-2.0
#include "render/passes/print_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "render/passes/bindings.h"
#include "render/vector.h"

namespace mercury::render {
namespace {

constexpr float depth_of_print = 0.42f;  // in radii
constexpr float finest = 0.1f;           // texel, in radii
constexpr float reach = 1.6f;            // of the map, in distances from the eye to the target
constexpr int relief_levels = 7;
constexpr GLuint at_place = binding::first_free + 1;

// The layouts of shaders/print.vert and shaders/prints.glsl.
struct PrintRecord {
  Vector4 a_b, c_radius_depth;
};
struct PlaceRecord {
  Vector4 map;  // corner x, y; side; depth of a fresh print [m]
};

}  // namespace

PrintMap print_map(std::span<const Print> prints, const Camera& camera, int side) {
  const float distance = (camera.eye - camera.target).norm();
  const Vector2 middle = camera.target.xy();
  float half = 0;
  std::vector<float> radii;
  for (const Print& print : prints) {
    const Vector2 from = print.corners[0] - middle;
    radii.push_back(print.radius);
    half = std::max(half, std::max(std::abs(from.x), std::abs(from.y)) + 8 * print.radius);
  }
  std::ranges::nth_element(radii, radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2));
  const float radius = std::max(radii[radii.size() / 2], 1e-6f);
  half = std::min(half, reach * distance);
  const float wanted = std::max(finest * radius, 2 * half / float(side - 16));
  PrintMap map{
      .texel = std::exp2(std::ceil(4 * std::log2(wanted)) / 4), .corner = {}, .depth = depth_of_print * radius};
  const auto snapped = [&](float x) { return 8 * map.texel * std::floor(x / (8 * map.texel)); };
  const float half_side = 0.5f * map.texel * float(side);
  map.corner = {snapped(middle.x - half_side), snapped(middle.y - half_side)};
  return map;
}

PrintPass::PrintPass(const QualitySettings& settings) : side_(settings.prints_side), empty_(make_vertex_array()) {}

void PrintPass::make() {
  heights_ = make_texture(GL_RG16F, side_, side_);
  relief_ = make_texture(GL_RGBA8, side_, side_, 0, relief_levels);
  glTextureParameteri(relief_.get(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  heights_framebuffer_ = make_framebuffer({heights_.get()});
  print_ = make_program({"print.vert", "print.frag"});
  shade_ = make_program({"print_relief.comp"});
}

void PrintPass::draw(const Scene& scene, const Camera& camera, const Style& style) {
  variant_.clear();
  if (side_ == 0 || scene.prints.empty() || scene.surroundings != Surroundings::land) return;
  if (!heights_) make();
  variant_ = "#define PRINTS\n";
  const PrintMap map = print_map(scene.prints, camera, side_);
  std::vector<PrintRecord> records;
  records.reserve(scene.prints.size());
  Vector2 low = scene.prints.front().corners[0], high = low;
  for (const Print& print : scene.prints) {
    const auto& [a, b, c] = print.corners;
    const Vector2 room{2.4f * print.radius, 2.4f * print.radius};  // with its rim, see print.vert
    low = smallest(low, smallest(smallest(a, b), c) - room);
    high = largest(high, largest(largest(a, b), c) + room);
    records.push_back({{a.x, a.y, b.x, b.y}, {c.x, c.y, print.radius, depth_of_print * print.radius * print.depth}});
  }
  records_.write(records);
  const PlaceRecord place{{map.corner.x, map.corner.y, map.texel * float(side_), map.depth}};
  place_.write(&place, sizeof place);
  records_.bind_storage(binding::first_free);
  place_.bind_uniform(1);

  constexpr float none[] = {0, 0, 0, 0};
  glClearNamedFramebufferfv(heights_framebuffer_.get(), GL_COLOR, 0, none);
  glBindFramebuffer(GL_FRAMEBUFFER, heights_framebuffer_.get());
  glViewport(0, 0, side_, side_);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendEquation(GL_MAX);
  glUseProgram(print_.get());
  glBindVertexArray(empty_.get());
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * records.size()));
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);

  glBindTextureUnit(binding::source, heights_.get());
  const Vector3 to_key = style.to_key.normalized();
  glUseProgram(shade_.get());
  glUniform3f(0, to_key.x, to_key.y, std::max(to_key.z, 0.05f));
  // The texels of prints alone, as they are few; elsewhere the ground is level.
  constexpr std::array<GLubyte, 4> level{128, 128, 0, 255};
  glClearTexImage(relief_.get(), 0, GL_RGBA, GL_UNSIGNED_BYTE, level.data());
  const auto texel = [&](float x, float corner) {
    return std::clamp(int(std::floor((x - corner) / map.texel)), 0, side_);
  };
  const int left = texel(low.x, map.corner.x), lower = texel(low.y, map.corner.y);
  const int width = texel(high.x, map.corner.x) + 1 - left, height = texel(high.y, map.corner.y) + 1 - lower;
  glUniform2i(1, left, lower);
  compute_texels(shade_.get(), relief_.get(), GL_RGBA8, width, height);
  glGenerateTextureMipmap(relief_.get());
  glBindTextureUnit(binding::prints, relief_.get());
}

}  // namespace mercury::render
