// SPDX-License-Identifier: Apache-2.0
// The scene to draw, as plain numbers: bodies that deform, their colors, and the text beside them.
//
// Lengths in meters, axes right-handed with z up. Each body has coordinates of its own; a placement moves it into the
// picture. Functions read spans during the call and do not keep them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/colormap.h"
#include "render/cut.h"
#include "render/text/scale.h"
#include "render/vector.h"

namespace mercury::render {

// The parts of a body that stay the same while it moves. Indices count the body's own masses.
struct Body {
  std::span<const float> rest_positions;            // 3 per mass; they decide which edges of the skin are sharp
  std::span<const std::uint32_t> faces;             // 3 masses per face, counter-clockwise seen from outside
  std::span<const std::uint32_t> springs;           // 2 masses per spring
  std::span<const std::uint32_t> face_materials;    // one per face, index into Scene::materials; empty = all 0
  std::span<const std::uint32_t> spring_materials;  // one per spring, the same
};

// How the faces and springs of one material are drawn at this time.
struct RenderMaterial {
  Color color;
  float activation = 0;  // of a muscle, -1 stretched to +1 contracted; it lights up as it contracts
};

// Where and how a body is drawn.
struct Placement {
  Vector3 offset{0, 0, 0};  // added to the body's coordinates [m]
  bool hidden = false;
  bool selected = false;             // drawn with a bright outline around it
  bool faulty = false;               // drawn gray, with a red rim: it has exploded
  bool smooth = false;               // skin rounded rather than with its edges
  std::uint32_t first_material = 0;  // added to the body's face_materials and spring_materials, below 2^24
};

enum class Surroundings {
  none,   // a plain backdrop
  water,  // light from above, fog, drifting particles, sand far below
  land,   // ground at z = 0 with a metric grid
};

enum class Theme { dark, light };

// An arrow in a body's coordinates.
struct Arrow {
  std::uint32_t body = 0;
  Vector3 from{0, 0, 0};
  Vector3 vector{0, 0, 0};  // from tail to tip [m]
  Color color;
};

// A line in a body's coordinates, such as the path of its center of mass.
struct Path {
  static constexpr std::uint32_t no_body = 0xffffffff;  // the line is in the picture's coordinates
  std::uint32_t body = 0;
  std::span<const float> points;  // 3 per point, oldest first
  Color color;
  bool fades = true;  // older points are fainter
};

// Text beside a body; '\n' starts a new, smaller line. Of many, only some are shown (text/label_layout.h).
struct Label {
  std::uint32_t body = 0;
  std::string text;
  float priority = 0;   // higher ones are placed first
  bool forced = false;  // shown even where it covers a body
};

// A flat rectangle behind bodies, with round corners: a cell of a table. It takes shadows, but no other light.
struct Tile {
  Vector3 center{0, 0, 0}, half_width{1, 0, 0}, half_height{0, 0, 1};  // in the picture's coordinates [m]
  Color fill, frame;
};

// A line of text at a point in the picture's coordinates.
struct Text {
  Vector3 at{0, 0, 0};
  std::string text;
  float align_x = 0.5f, align_y = 0.5f;  // where the point is in the line: 0 = left and upper end, 1 = right and lower
  float size = 1;                        // of the picture's usual size of text
  bool free = false;                     // it may move into the picture, and below other free texts
};

// Explains the colors, at the right edge of the picture: a bar for a scale, or swatches with names.
struct Legend {
  std::string title;           // "strain"
  std::string unit;            // "m/s"; empty = none
  std::optional<Scale> scale;  // a bar with numbers
  std::vector<std::pair<Color, std::string>> swatches;
  // Colors of muscles by their phase: dots on a circle, phase 0 at the right, rising counter-clockwise. Empty = none.
  std::vector<Color> wheel;
  // How many values are in each part of the scale, from its low end to its high one, as shares of the largest; drawn
  // beside the bar. Empty = not drawn.
  std::vector<float> histogram;
};

// A disc on the ground that slides under a body which is kept in its place, so that the body is seen to move. While
// there are patches, only they have meter lines.
struct Patch {
  Vector2 center{0, 0};  // in the picture's coordinates [m]
  float radius = 1;      // [m]
  Vector2 slide{0, 0};   // added to the picture's coordinates for the ground's texture and lines [m]
};

// A dent in the ground on land: around a triangle, or around a line or a point if corners are the same.
struct Print {
  std::array<Vector2, 3> corners;  // in the picture's coordinates [m]
  float radius = 0.03f;            // around the triangle [m]
  float depth = 1;                 // 1 = fresh, 0 = gone
};

// Plants and stones on the floor of water and land, never in a body or higher than the room below it.
struct GroundCover {
  float height = 0.3f;  // of the tallest plants; stones and distances follow from it [m]
  Vector2 bare_low{1e9f, 1e9f}, bare_high{1e9f, 1e9f};  // a rectangle where nothing grows [m]
};

// Something that moves through the water and carries particles along.
struct Mover {
  Vector3 center{0, 0, 0};    // in the picture's coordinates [m]
  float radius = 0;           // of a ball of about its size [m]
  Vector3 velocity{0, 0, 0};  // [m/s]
};

// A body in one translucent color, without a shadow. What is nearer hides it.
struct Ghost {
  std::span<const float> positions;      // 3 per mass
  std::span<const std::uint32_t> faces;  // 3 masses per face, counter-clockwise seen from outside
  Vector3 offset{0, 0, 0};               // added to the positions [m]
  Color color;
  float opacity = 0.4f;
};

// The key light of a picture, in place of that of its theme.
struct KeyLight {
  Vector3 to_key{0, 0, 1};  // direction toward it
};

struct Show {
  bool skin = true;
  bool springs = false;
  bool masses = false;
};

struct Scene {
  // 3 floats per mass, one body after the other, each in its own coordinates.
  // Empty = Renderer::position_buffer() already holds them.
  std::span<const float> positions;
  std::span<const Placement> placements;      // one per body; empty = no offset for any
  std::span<const RenderMaterial> materials;  // by Body::face_materials and spring_materials; empty = gray

  // Values to color by, through `scale`, one per face, mass or spring of all bodies; empty = colors of `materials`.
  // Skin takes face_values, else mass_values; springs take spring_values, else mass_values; masses take mass_values.
  std::span<const float> face_values, mass_values, spring_values;
  Scale scale;

  Show show;
  // Skins of few faces are rounded and finer than their masses (subdivision.h), unless springs, masses or cuts are
  // shown.
  bool rounded = false;
  std::optional<Cut> cut;   // opens each body
  float spring_radius = 0;  // [m]; 0 = chosen from the springs' lengths
  float mass_radius = 0;    // [m]; 0 = chosen from the springs' lengths

  Surroundings surroundings = Surroundings::water;
  Theme theme = Theme::dark;
  std::optional<KeyLight> against_light;  // the camera looks toward this light, which bodies, water and air scatter
  float floor = 0;                        // height of the ground or sand [m]
  bool catch_shadows = false;  // without surroundings: bodies still darken the backdrop where the floor would be
  // The backdrop is of this light alone, and bodies do not depend on it: what matted() takes two pictures of.
  std::optional<float> flat_backdrop;
  bool text_aside = false;        // nothing is written on the picture; Renderer::overlay() has it
  Vector3 flow{0, 0, 0};          // of the water; particles drift with it [m/s]
  std::span<const Mover> movers;  // in water
  double time = 0;                // moves caustics and particles [s]

  std::span<const Patch> patches;  // on land
  std::span<const Print> prints;   // on land, where there are patches only on them; not at low quality
  std::optional<GroundCover> ground_cover;
  std::span<const Tile> tiles;
  std::span<const Text> texts;
  std::span<const Arrow> arrows;
  std::span<const Path> paths;
  std::span<const Label> labels;
  std::span<const Ghost> ghosts;
  std::optional<Legend> legend;
  std::string clock;       // text in the lower left corner, such as "12.3 s   x4"; empty = none
  std::string caption;     // text in the upper left corner; empty = none
  bool scale_bar = false;  // a length in meters, at the depth of the camera's target
};

}  // namespace mercury::render
