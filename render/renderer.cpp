#include "render/renderer.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "render/bodies.h"
#include "render/frame_block.h"
#include "render/gl_objects.h"

namespace mercury::render {
namespace {

using Eigen::Vector3f;
using Eigen::Vector4f;

constexpr std::array<std::pair<Quality, std::string_view>, 4> quality_names{{
    {Quality::automatic, "auto"},
    {Quality::low, "low"},
    {Quality::medium, "medium"},
    {Quality::high, "high"},
}};

struct Targets {
  Texture light, depth, picture;
  Framebuffer drawing, finished;
};

Targets make_targets(int width, int height, int samples) {
  Targets t;
  t.light = make_texture(GL_RGBA16F, width, height, samples);
  t.depth = make_texture(GL_DEPTH_COMPONENT32F, width, height, samples);
  t.picture = make_texture(GL_SRGB8_ALPHA8, width, height);
  t.drawing = make_framebuffer({t.light.get()}, t.depth.get());
  t.finished = make_framebuffer({t.picture.get()});
  return t;
}

// As shaders/bodies.glsl has it.
struct PlacementRecord {
  float x, y, z;
  std::uint32_t flags;
};

Vector4f light(Color color, float strength = 1) {
  const auto linear = linear_of(color);
  return {strength * linear[0], strength * linear[1], strength * linear[2], 1};
}

}  // namespace

std::string_view name_of(Quality quality) {
  for (const auto& [value, name] : quality_names)
    if (value == quality) return name;
  return "?";
}

Quality quality_named(std::string_view name) {
  for (const auto& [value, known] : quality_names)
    if (known == name) return value;
  throw std::invalid_argument("'" + std::string(name) + "' is no quality; give auto, low, medium or high");
}

struct Renderer::Parts {
  int width = 0, height = 0;
  Quality quality = Quality::low;
  bool software = false;
  int samples = 4;
  Targets targets;
  Bodies bodies;
  Buffer frame, face_frames, placements, looks;
  VertexArray empty, skin_corners;
  Program face_frames_program, skin, backdrop, resolve;

  void upload(const Scene& scene, const Camera& camera);
  void compute_faces();
  void draw_skin();
};

Renderer::Renderer(const Context& context, const RendererOptions& options) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.software = context.is_software();
  p.empty = make_vertex_array();
  p.skin_corners = make_vertex_array();
  p.face_frames_program = make_program({"face_frames.comp"});
  p.skin = make_program({"skin.vert", "skin.frag"});
  p.backdrop = make_program({"fullscreen.vert", "backdrop.frag"});
  p.resolve = make_program({"fullscreen.vert", "resolve.frag"}, "#define SAMPLES " + std::to_string(p.samples) + "\n");
  set_quality(options.quality);
  resize(options.width, options.height);
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::resize(int width, int height) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (width < 1 || height < 1 || width > largest || height > largest)
    throw ContextError("a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                       " pixels cannot be drawn here, at most " + std::to_string(largest) + " a side");
  if (width == parts_->width && height == parts_->height) return;
  parts_->targets = make_targets(width, height, parts_->samples);
  parts_->width = width;
  parts_->height = height;
}

void Renderer::set_quality(Quality quality) {
  if (quality == Quality::automatic) quality = parts_->software ? Quality::low : Quality::high;
  parts_->quality = quality;
}

int Renderer::width() const { return parts_->width; }
int Renderer::height() const { return parts_->height; }
Quality Renderer::quality() const { return parts_->quality; }

void Renderer::set_bodies(std::span<const Body> bodies) {
  Parts& p = *parts_;
  p.bodies.set(bodies);
  p.face_frames.reserve(64 * p.bodies.face_count());
  const GLuint array = p.skin_corners.get();
  glVertexArrayVertexBuffer(array, 0, p.bodies.positions.get(), 0, 12);
  glVertexArrayVertexBuffer(array, 1, p.bodies.mass_bodies.get(), 0, 4);
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribIFormat(array, 1, 1, GL_UNSIGNED_INT, 0);
  for (GLuint i = 0; i < 2; ++i) {
    glVertexArrayAttribBinding(array, i, i);
    glEnableVertexArrayAttrib(array, i);
  }
  glVertexArrayElementBuffer(array, p.bodies.faces.get());
}

std::size_t Renderer::body_count() const { return parts_->bodies.body_count(); }
std::size_t Renderer::mass_count() const { return parts_->bodies.mass_count(); }
std::size_t Renderer::face_count() const { return parts_->bodies.face_count(); }
std::size_t Renderer::spring_count() const { return parts_->bodies.spring_count(); }
std::span<const std::uint32_t> Renderer::mass_offsets() const { return parts_->bodies.mass_offsets(); }
unsigned Renderer::position_buffer() const { return parts_->bodies.positions.get(); }

std::vector<Bounds> Renderer::body_bounds() {
  const Bodies& bodies = parts_->bodies;
  std::vector<float> positions(3 * bodies.mass_count());
  if (!positions.empty())
    glGetNamedBufferSubData(bodies.positions.get(), 0, GLsizeiptr(4 * positions.size()), positions.data());
  std::vector<Bounds> result;
  for (std::size_t i = 0; i < bodies.body_count(); ++i) {
    const std::size_t first = bodies.mass_offsets()[i], end = bodies.mass_offsets()[i + 1];
    result.push_back(bounds_of(std::span(positions).subspan(3 * first, 3 * (end - first))));
  }
  return result;
}

void Renderer::Parts::upload(const Scene& scene, const Camera& camera) {
  if (!scene.positions.empty()) {
    if (scene.positions.size() != 3 * bodies.mass_count())
      throw std::invalid_argument("Scene::positions must have 3 floats a mass of all bodies");
    glNamedBufferSubData(bodies.positions.get(), 0, GLsizeiptr(scene.positions.size_bytes()), scene.positions.data());
  }
  std::vector<PlacementRecord> records(std::max<std::size_t>(bodies.body_count(), 1));
  for (std::size_t i = 0; i < std::min(records.size(), scene.placements.size()); ++i) {
    const Placement& place = scene.placements[i];
    records[i] = {place.offset.x(), place.offset.y(), place.offset.z(),
                  (place.hidden ? 1u : 0u) | (place.selected ? 2u : 0u) | (place.faulty ? 4u : 0u) |
                      (place.smooth ? 8u : 0u)};
  }
  placements.write(records);
  std::vector<Vector4f> look_records;
  for (const Look& look : scene.looks) {
    look_records.push_back(light(look.color));
    look_records.back().w() = look.activation;
  }
  if (look_records.empty()) look_records.push_back({0.6f, 0.6f, 0.6f, 0});
  looks.write(look_records);

  FrameBlock block;
  block.view = camera.view();
  block.view_projection = camera.projection(float(width) / float(height)) * block.view;
  block.inverse_view_projection = block.view_projection.inverse();
  block.eye = {camera.eye.x(), camera.eye.y(), camera.eye.z(), float(scene.time)};
  block.to_key = Vector4f(0.35f, -0.45f, 0.85f, 0).normalized();
  block.key_light = {2.0f, 1.95f, 1.8f, 0};
  block.sky_light = {0.35f, 0.45f, 0.6f, 0};
  block.ground_light = {0.12f, 0.14f, 0.16f, 0};
  const bool dark = scene.theme == Theme::dark;
  block.backdrop_high = light(dark ? rgb(0x1d5d7c) : rgb(0xdff0f5));
  block.backdrop_low = light(dark ? rgb(0x06182a) : rgb(0x8fc3d6));
  block.cut = scene.cut ? Vector4f(scene.cut->normal.x(), scene.cut->normal.y(), scene.cut->normal.z(), scene.cut->offset)
                        : Vector4f(0, 0, 0, 1);
  block.screen = {float(width), float(height), 1 / float(width), 1 / float(height)};
  frame.write(&block, sizeof block);
}

void Renderer::Parts::compute_faces() {
  if (bodies.face_count() == 0) return;
  glUseProgram(face_frames_program.get());
  glUniform1ui(0, GLuint(bodies.face_count()));
  const GLuint groups = GLuint((bodies.face_count() + 63) / 64);
  const GLuint across = std::min(groups, 32768u);
  glDispatchCompute(across, (groups + across - 1) / across, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void Renderer::Parts::draw_skin() {
  glUseProgram(skin.get());
  glBindVertexArray(skin_corners.get());
  glEnable(GL_CLIP_DISTANCE0);
  glDrawElements(GL_TRIANGLES, GLsizei(3 * bodies.face_count()), GL_UNSIGNED_INT, nullptr);
  glDisable(GL_CLIP_DISTANCE0);
}

void Renderer::draw(const Scene& scene, const Camera& camera) {
  Parts& p = *parts_;
  p.upload(scene, camera);
  p.frame.bind_uniform(0);
  p.bodies.positions.bind_storage(1);
  p.placements.bind_storage(2);
  p.bodies.mass_bodies.bind_storage(3);
  p.bodies.face_records.bind_storage(4);
  p.face_frames.bind_storage(5);
  p.looks.bind_storage(6);
  p.bodies.faces.bind_storage(7);
  p.compute_faces();

  glBindFramebuffer(GL_FRAMEBUFFER, p.targets.drawing.get());
  glViewport(0, 0, p.width, p.height);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  const float farthest = 0;
  glClearNamedFramebufferfv(p.targets.drawing.get(), GL_DEPTH, 0, &farthest);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(p.empty.get());
  glUseProgram(p.backdrop.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  if (scene.show.skin) p.draw_skin();

  glBindFramebuffer(GL_FRAMEBUFFER, p.targets.finished.get());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glBindVertexArray(p.empty.get());
  glUseProgram(p.resolve.get());
  glBindTextureUnit(0, p.targets.light.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_FRAMEBUFFER_SRGB);
}

unsigned Renderer::picture() const { return parts_->targets.picture.get(); }

void Renderer::present(unsigned framebuffer, int x, int y, int width, int height) const {
  const GLenum filter = width == parts_->width && height == parts_->height ? GL_NEAREST : GL_LINEAR;
  glBlitNamedFramebuffer(parts_->targets.finished.get(), framebuffer, 0, 0, parts_->width, parts_->height, x, y,
                         x + width, y + height, GL_COLOR_BUFFER_BIT, filter);
}

}  // namespace mercury::render
