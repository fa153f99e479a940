// SPDX-License-Identifier: Apache-2.0
#include "render/text/font.h"

#include <algorithm>

namespace mercury::render {
namespace {

constexpr int replacement = 0xfffd;

// How many bytes follow a first byte (-1 = it is not a first byte), and the character's bits in the first byte.
struct Lead {
  int more, bits;
};
Lead lead_of(unsigned char byte) {
  if (byte < 0x80) return {0, byte};
  if ((byte & 0xe0) == 0xc0) return {1, byte & 0x1f};
  if ((byte & 0xf0) == 0xe0) return {2, byte & 0x0f};
  if ((byte & 0xf8) == 0xf0) return {3, byte & 0x07};
  return {-1, 0};
}

}  // namespace

const FontGlyph& glyph_of(int code) {
  const auto glyphs = font_data().glyphs;
  const auto find = [&](int wanted) {
    return std::lower_bound(glyphs.begin(), glyphs.end(), wanted, [](const FontGlyph& g, int c) { return g.code < c; });
  };
  const auto found = find(code);
  if (found != glyphs.end() && found->code == code) return *found;
  return *find(replacement);
}

std::vector<int> characters_of(std::string_view utf8) {
  std::vector<int> characters;
  for (std::size_t i = 0; i < utf8.size();) {
    const Lead lead = lead_of(static_cast<unsigned char>(utf8[i++]));
    int code = lead.bits, left = lead.more;
    while (left > 0 && i < utf8.size() && (static_cast<unsigned char>(utf8[i]) & 0xc0) == 0x80) {
      code = (code << 6) | (static_cast<unsigned char>(utf8[i++]) & 0x3f);
      --left;
    }
    characters.push_back(left == 0 ? code : replacement);
  }
  return characters;
}

float text_width(std::string_view utf8, float size) {
  float width = 0;
  for (const int code : characters_of(utf8)) width += glyph_of(code).advance;
  return width * size / float(font_data().size);
}

}  // namespace mercury::render
