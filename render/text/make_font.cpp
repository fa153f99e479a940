// SPDX-License-Identifier: Apache-2.0
// make_font FONT.ttf OUTPUT.cpp: at build time, converts a font into a picture of signed distances and a table of
// glyphs.
#include <png.h>

#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

constexpr int size = 44;    // pixels from the deepest descender to the highest ascender
constexpr int padding = 7;  // pixels around a glyph that hold distances
constexpr int atlas_width = 1024;

struct Glyph {
  int code = 0;
  float advance = 0;
  int x = 0, y = 0, width = 0, height = 0, left = 0, top = 0;  // in the atlas; offset from the pen, downward
  std::vector<std::uint8_t> distances;
};

std::vector<int> wanted_codes() {
  std::vector<int> codes;
  for (int c = 32; c < 127; ++c) codes.push_back(c);
  for (int c = 160; c < 0x180; ++c) codes.push_back(c);    // Latin
  for (int c = 0x391; c < 0x3ca; ++c) codes.push_back(c);  // Greek
  for (const int c : {0x2013, 0x2014, 0x2018, 0x2019, 0x201c, 0x201d, 0x2022, 0x2026, 0x2074, 0x207b,
                      0x2190, 0x2192, 0x2206, 0x2212, 0x221e, 0x2248, 0x2264, 0x2265, 0x25cf, 0xfffd})
    codes.push_back(c);
  return codes;
}

std::vector<unsigned char> read_file(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Glyph draw_glyph(const stbtt_fontinfo& font, float scale, int code) {
  Glyph glyph;
  glyph.code = code;
  int advance = 0, bearing = 0;
  stbtt_GetCodepointHMetrics(&font, code, &advance, &bearing);
  glyph.advance = scale * float(advance);
  unsigned char* pixels = stbtt_GetCodepointSDF(&font, scale, code, padding, 128, 128.0f / padding, &glyph.width,
                                                &glyph.height, &glyph.left, &glyph.top);
  if (!pixels) return glyph;
  glyph.distances.assign(pixels, pixels + glyph.width * glyph.height);
  stbtt_FreeSDF(pixels, nullptr);
  return glyph;
}

// Places the glyphs in rows, the highest first. Returns the atlas's height.
int pack(std::vector<Glyph>& glyphs) {
  std::vector<Glyph*> order;
  for (Glyph& glyph : glyphs) order.push_back(&glyph);
  std::stable_sort(order.begin(), order.end(), [](const Glyph* a, const Glyph* b) { return a->height > b->height; });
  int x = 0, y = 0, row = 0;
  for (Glyph* glyph : order) {
    if (x + glyph->width > atlas_width) {
      x = 0;
      y += row + 1;
      row = 0;
    }
    glyph->x = x;
    glyph->y = y;
    x += glyph->width + 1;
    row = std::max(row, glyph->height);
  }
  return y + row;
}

std::vector<unsigned char> compress(const std::vector<Glyph>& glyphs, int height) {
  std::vector<unsigned char> atlas(std::size_t(atlas_width * height), 0);
  for (const Glyph& glyph : glyphs)
    for (int row = 0; row < glyph.height; ++row)
      std::copy_n(glyph.distances.begin() + row * glyph.width, glyph.width,
                  atlas.begin() + (glyph.y + row) * atlas_width + glyph.x);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = atlas_width;
  png.height = png_uint_32(height);
  png.format = PNG_FORMAT_GRAY;
  png_alloc_size_t bytes = 0;
  png_image_write_to_memory(&png, nullptr, &bytes, 0, atlas.data(), 0, nullptr);
  std::vector<unsigned char> result(bytes);
  png_image_write_to_memory(&png, result.data(), &bytes, 0, atlas.data(), 0, nullptr);
  return result;
}

void write(std::FILE* out, const std::vector<Glyph>& glyphs, const std::vector<unsigned char>& png, float ascent) {
  std::fprintf(out,
               "// Made from a font at build time.\n#include \"render/text/font.h\"\n\nnamespace mercury::render "
               "{\nnamespace {\n\n");
  std::fprintf(out, "const FontGlyph glyphs[] = {\n");
  for (const Glyph& g : glyphs)
    std::fprintf(out, "    {%d, %.3ff, %d, %d, %d, %d, %d, %d},\n", g.code, double(g.advance), g.x, g.y, g.width,
                 g.height, g.left, g.top);
  std::fprintf(out, "};\n\nconst unsigned char atlas[] = {");
  for (std::size_t i = 0; i < png.size(); ++i) std::fprintf(out, "%s%d,", i % 32 ? "" : "\n", int(png[i]));
  std::fprintf(out, "};\n\n}  // namespace\n\nconst FontData& font_data() {\n");
  std::fprintf(out, "  static const FontData data{glyphs, atlas, %d, %.3ff, %d};\n  return data;\n}\n\n", size,
               double(ascent), padding);
  std::fprintf(out, "}  // namespace mercury::render\n");
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<unsigned char> file = argc == 3 ? read_file(argv[1]) : std::vector<unsigned char>{};
  stbtt_fontinfo font;
  if (file.empty() || !stbtt_InitFont(&font, file.data(), 0)) {
    std::fprintf(stderr, "usage: make_font FONT.ttf OUTPUT.cpp\n");
    return 2;
  }
  const float scale = stbtt_ScaleForPixelHeight(&font, size);
  int ascent = 0, descent = 0, gap = 0;
  stbtt_GetFontVMetrics(&font, &ascent, &descent, &gap);
  std::vector<Glyph> glyphs;
  for (const int code : wanted_codes())
    if (code == 0xfffd || stbtt_FindGlyphIndex(&font, code)) glyphs.push_back(draw_glyph(font, scale, code));
  const int height = pack(glyphs);
  std::FILE* out = std::fopen(argv[2], "w");
  if (!out) return 1;
  write(out, glyphs, compress(glyphs, height), scale * float(ascent));
  return std::fclose(out) == 0 ? 0 : 1;
}
