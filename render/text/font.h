// SPDX-License-Identifier: Apache-2.0
// The built-in font. Glyphs are stored as signed distances, so they are sharp at any size.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace mercury::render {

struct FontGlyph {
  int code;                 // Unicode
  float advance;            // to the next glyph
  int x, y, width, height;  // in the atlas
  int left, top;            // from the pen on the base line to its upper left corner, y downward
};

// All lengths in pixels, for lines of `size` pixels.
struct FontData {
  std::span<const FontGlyph> glyphs;   // by code
  std::span<const unsigned char> png;  // the atlas in gray: 128 on the outline, more inside
  int size;
  float ascent;  // of the highest glyph above the base line
  int spread;    // distance that 128 steps of gray stand for
};

// Generated at build time.
const FontData& font_data();

// The glyph of a character, or of U+FFFD if the font does not have it.
const FontGlyph& glyph_of(int code);

// Unicode characters of UTF-8; a broken byte gives U+FFFD.
std::vector<int> characters_of(std::string_view utf8);

// Width of a line of text in pixels, at a line height of `size` pixels.
float text_width(std::string_view utf8, float size);

}  // namespace mercury::render
