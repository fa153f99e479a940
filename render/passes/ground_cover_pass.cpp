// SPDX-License-Identifier: Apache-2.0
#include "render/passes/ground_cover_pass.h"

#include <algorithm>
#include <cmath>

#include "render/passes/bindings.h"
#include "render/vector.h"

namespace mercury::render {
namespace {

constexpr int most_cells = 128;                 // of the grid, per side
constexpr std::size_t draw_command_bytes = 20;  // DrawElementsIndirectCommand
constexpr int stone_columns = 12, stone_rows = 6;

// How plants look: blades of a sea plant are long, grass is short.
struct PlantShape {
  int cells;  // of the grid, per side
  int blades, segments;
  float cell;         // side of a cell, in heights of the tallest plant
  float share;        // of cells with a plant, where plants are densest
  float blade, tuft;  // widths, as shares of the height
  float sway;         // as a share of the height
  float growth;       // seen from twice as far, by how much plants are taller, where cells are larger
  float stone;        // the highest stone, in heights of the tallest plant
  float stones;       // share of cells with a stone, where stones are densest
  float reach;        // where they end, in distances from the eye to the target
  int corners() const { return 6 * blades * segments; }  // of triangles
};
constexpr PlantShape sea_plant{.cells = 64,
                               .blades = 11,
                               .segments = 6,
                               .cell = 1.0f,
                               .share = 0.60f,
                               .blade = 0.052f,
                               .tuft = 0.36f,
                               .sway = 0.13f,
                               .growth = 0,
                               .stone = 0.42f,
                               .stones = 0.22f,
                               .reach = 2.4f};
constexpr PlantShape grass{.cells = 128,
                           .blades = 9,
                           .segments = 3,
                           .cell = 0.80f,
                           .share = 0.80f,
                           .blade = 0.055f,
                           .tuft = 0.60f,
                           .sway = 0.035f,
                           .growth = 0.22f,
                           .stone = 0.26f,
                           .stones = 0.05f,
                           .reach = 2.3f};

const PlantShape& shape_in(Surroundings surroundings) {
  return surroundings == Surroundings::water ? sea_plant : grass;
}

std::string plant_defines(const PlantShape& shape) { return "#define PLANT\n" + define("SEGMENTS", shape.segments); }

// Two triangles between four vertices.
void add_quad(std::vector<GLuint>& indices, GLuint a, GLuint b, GLuint c, GLuint d) {
  indices.insert(indices.end(), {a, b, c, b, d, c});
}

// The triangles of a sea plant, of a tuft of grass and of a stone. With indices, a vertex is computed once for all of
// its triangles.
std::vector<GLuint> indices_of_all() {
  std::vector<GLuint> indices;
  for (const PlantShape& shape : {sea_plant, grass})
    for (int blade = 0; blade < shape.blades; ++blade)
      for (int segment = 0; segment < shape.segments; ++segment) {
        const auto low = GLuint(2 * (blade * (shape.segments + 1) + segment));
        add_quad(indices, low, low + 2, low + 1, low + 3);
      }
  const GLuint row = stone_columns + 1;
  for (GLuint y = 0; y < stone_rows; ++y)
    for (GLuint x = 0; x < stone_columns; ++x) {
      const GLuint corner = y * row + x;
      add_quad(indices, corner, corner + 1, corner + row, corner + row + 1);
    }
  return indices;
}

// The layout of shaders/ground_cover.comp.
struct DiscRecord {
  Vector4 disc, slide;
};

// Where the camera looks at the floor, or before that, where the floor is far away.
Vector2 middle_of(const Camera& camera) {
  const Vector2 ahead = (camera.target - camera.eye).xy();
  const float distance = (camera.target - camera.eye).norm(), level = ahead.norm();
  return camera.target.xy() + (level > 1e-6f * distance ? 0.7f * distance / level * ahead : Vector2(0, 0));
}

}  // namespace

GroundCoverPass::GroundCoverPass()
    : empty_(make_vertex_array()), indexed_(make_vertex_array()), place_({"ground_cover.comp"}, ""),
      plant_({"ground_cover.vert", "ground_cover.frag"}, ""),
      stone_({"ground_cover.vert", "ground_cover.frag"},
             define("COLUMNS", stone_columns) + define("ROWS", stone_rows)) {}

void GroundCoverPass::place(const Scene& scene, const Camera& camera, const BoundsPass& bounds, std::size_t bodies) {
  if (!shade_) {
    shade_ = make_program({"ground_cover_shade.vert", "ground_cover_shade.frag"});
    items_.reserve(sizeof(Item) * most_cells * most_cells);
    lists_.reserve(2 * sizeof(GLuint) * most_cells * most_cells);
    commands_.reserve(4 * draw_command_bytes);
    indices_.write(indices_of_all());
    glVertexArrayElementBuffer(indexed_.get(), indices_.get());
  }
  const GroundCover& cover = *scene.ground_cover;
  const PlantShape& shape = shape_in(scene.surroundings);
  const float side = shape.cell * cover.height, reach = shape.reach * (camera.eye - camera.target).norm();
  // The cells of this level together cover at least what the camera sees.
  const float exact = std::log2(std::max(2 * reach / (float(shape.cells) * side), 1e-6f));
  const float level = std::max(0.0f, std::ceil(exact)), left = std::clamp(level - exact, 0.0f, 1.0f);
  const float height = cover.height * (1 + shape.growth * std::max(exact, 0.0f));
  std::vector<DiscRecord> patches;
  for (const Patch& patch : scene.patches)
    patches.push_back({{patch.center.x, patch.center.y, patch.radius, 0}, {0, 0, 0, 0}});
  const auto patch_count = GLuint(patches.size());
  if (patches.empty()) patches.emplace_back();
  patches_.write(patches);
  bounds.boxes().bind_storage(binding::first_free);
  patches_.bind_storage(binding::first_free + 1);
  bind();
  commands_.bind_storage(binding::first_free + 4);
  const std::string cells = define("CELLS", shape.cells);
  placed_ = shape.cells * shape.cells;
  glUseProgram(place_.get(cells + define("STAGE", 0)));
  glUniform1ui(0, GLuint(bodies));
  glUniform1ui(1, patch_count);
  glUniform4f(2, side, height, shape.stone * cover.height, shape.share);
  glUniform4f(3, cover.bare_low.x, cover.bare_low.y, cover.bare_high.x, cover.bare_high.y);
  const Vector2 middle = middle_of(camera);
  glUniform4f(4, middle.x, middle.y, reach, shape.stones);
  glUniform2f(5, level, level > 0 ? left : 1);
  glDispatchCompute(GLuint(placed_) / 64, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  glUseProgram(place_.get(cells + define("STAGE", 1)));
  glUniform4ui(6, GLuint(shape.corners()), 6 * stone_columns * stone_rows,
               &shape == &grass ? GLuint(sea_plant.corners()) : 0, GLuint(sea_plant.corners() + grass.corners()));
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void GroundCoverPass::bind() const {
  items_.bind_storage(binding::first_free + 2);
  lists_.bind_storage(binding::first_free + 3);
}

void GroundCoverPass::draw(const Scene& scene, const Style& style, const std::string& variant) const {
  const PlantShape& shape = shape_in(scene.surroundings);
  bind();
  glDisable(GL_CULL_FACE);
  glBindVertexArray(indexed_.get());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.get());
  const auto draw_all = [&](GLuint program, GLuint first, const Vector3& low, const Vector3& high) {
    glUseProgram(program);
    glUniform1ui(0, first);
    // Plants lean with the flow.
    const Vector2 flow = scene.flow.xy();
    const Vector2 lean = 0.35f / (1 + 2 * flow.norm()) * flow;
    glUniform4f(1, lean.x, lean.y, shape.sway, 0);
    glUniform2f(2, shape.blade, shape.tuft);
    glUniform3f(3, low.x, low.y, low.z);
    glUniform3f(4, high.x, high.y, high.z);
    const std::size_t command = first > 0 ? draw_command_bytes : 0;
    glDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, reinterpret_cast<const void*>(command));
  };
  draw_all(plant_.get(plant_defines(shape) + variant), 0, style.plant_low, style.plant_high);
  draw_all(stone_.get(variant), GLuint(placed_), style.stone, style.stone);
}

void GroundCoverPass::draw_shades(const Scene& scene) const {
  const PlantShape& shape = shape_in(scene.surroundings);
  bind();
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDepthMask(GL_FALSE);
  glUseProgram(shade_.get());
  glBindVertexArray(empty_.get());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.get());
  const auto draw_all = [&](GLuint first, float radius, float darkness, std::size_t command) {
    glUniform1ui(0, first);
    glUniform2f(1, radius, darkness);
    glDrawArraysIndirect(GL_TRIANGLES, reinterpret_cast<const void*>(command * draw_command_bytes));
  };
  draw_all(0, 0.75f * shape.tuft, 0.40f, 2);
  draw_all(GLuint(placed_), 1.8f, 0.50f, 3);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

std::vector<GroundCoverPass::Item> GroundCoverPass::items() const {
  std::vector<Item> all(static_cast<std::size_t>(placed_));
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(items_.get(), 0, GLsizeiptr(sizeof(Item) * all.size()), all.data());
  std::erase_if(all, [](const Item& item) { return !(item.height > 0); });
  return all;
}

}  // namespace mercury::render
