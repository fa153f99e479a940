// SPDX-License-Identifier: Apache-2.0
// Figures as documents: SVG, and PDF 1.4 (ISO 32000-1 describes what is used of it).
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <stdexcept>
#include <vector>

#include "app/base/output_files.h"
#include "app/video/figure.h"
#include "mercury/names.h"
#include "render/png.h"
#include "render/text/font.h"

namespace mercury {
namespace {

using Bytes = std::span<const std::uint8_t>;

// What a figure consists of besides the picture, in its pixels. Both documents are written from these calls.
class Page {
 public:
  virtual ~Page() = default;
  virtual void box(const render::Rectangle& area, float radius, render::Color color, float opacity) = 0;
  // Colors from the lower to the upper end.
  virtual void scale(const render::Rectangle& area, std::span<const render::Color> colors) = 0;
  virtual void text(const render::OverlayText& line, render::Color color) = 0;
};

void draw(const render::Overlay& overlay, Page& page) {
  constexpr int stops = 32;
  for (const render::OverlayQuad& quad : overlay.quads()) {
    if (quad.kind == render::OverlayQuad::box) {
      page.box(quad.rectangle, quad.source.x, render::color_of_linear({quad.color[0], quad.color[1], quad.color[2]}),
               quad.color[3]);
    } else if (quad.kind == render::OverlayQuad::scale) {
      std::vector<render::Color> colors;
      for (int i = 0; i <= stops; ++i)
        colors.push_back(render::color_at(static_cast<render::Colormap>(quad.map), static_cast<float>(i) / stops));
      page.scale(quad.rectangle, colors);
    }
  }
  for (const render::OverlayText& line : overlay.texts()) page.text(line, overlay.style().text);
}

double points_per_pixel(const Figure& figure) { return 72 / (figure.dpi > 0 ? figure.dpi : 96); }

std::string hex(render::Color color) { return fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b); }

class SvgPage final : public Page {
 public:
  explicit SvgPage(const Figure& figure) {
    const PixelBox& box = figure.box;
    const int width = box.right - box.left, height = box.bottom - box.top;
    const double inches = points_per_pixel(figure) / 72;
    svg_ = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.6g}in\" height=\"{:.6g}in\" viewBox=\"{} {} {} {}\" "
        "font-family=\"DejaVu Sans, Arial, sans-serif\">\n<desc>{}</desc>\n"
        "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,",
        width * inches, height * inches, box.left, box.top, width, height, markup_text(figure.comment), box.left,
        box.top, width, height);
    const std::vector<std::uint8_t> png = render::png_bytes(cropped(figure.image, box));
    svg_ += base64({reinterpret_cast<const char*>(png.data()), png.size()}) + "\"/>\n";
  }

  void box(const render::Rectangle& area, float radius, render::Color color, float opacity) override {
    svg_ += fmt::format("<rect {} rx=\"{:.4g}\" fill=\"{}\" fill-opacity=\"{:.4g}\"/>\n", place(area), radius,
                        hex(color), opacity);
  }
  void scale(const render::Rectangle& area, std::span<const render::Color> colors) override {
    svg_ += fmt::format("<linearGradient id=\"scale-{}\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">", ++gradients_);
    for (std::size_t i = 0; i < colors.size(); ++i)
      svg_ += fmt::format("<stop offset=\"{:.4g}\" stop-color=\"{}\"/>",
                          static_cast<double>(i) / static_cast<double>(colors.size() - 1), hex(colors[i]));
    svg_ += fmt::format("</linearGradient>\n<rect {} fill=\"url(#scale-{})\"/>\n", place(area), gradients_);
  }
  void text(const render::OverlayText& line, render::Color color) override {
    const char* anchor = line.align > 0.75f ? "end" : line.align > 0.25f ? "middle" : "start";
    svg_ += fmt::format(
        "<text x=\"{:.6g}\" y=\"{:.6g}\" font-size=\"{:.4g}\" text-anchor=\"{}\" fill=\"{}\" "
        "fill-opacity=\"{:.3g}\">{}</text>\n",
        line.x, line.y + line.ascent, line.size, anchor, hex(color), line.opacity, markup_text(line.text));
  }

  std::string document() && { return std::move(svg_) + "</svg>\n"; }

 private:
  static std::string place(const render::Rectangle& area) {
    return fmt::format("x=\"{:.6g}\" y=\"{:.6g}\" width=\"{:.6g}\" height=\"{:.6g}\"", area.x, area.y, area.width,
                       area.height);
  }

  std::string svg_;
  int gradients_ = 0;
};

// Helvetica, one of the 14 fonts that every reader of PDF has: advances of the characters 32 to 126, in 1/1000 of its
// size (Adobe's font metrics). The others are near the last value.
constexpr std::array<int, 95> helvetica_advances{
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};
constexpr int usual_advance = 556;

// A character in the encoding WinAnsi; ? if it has none.
char win_ansi(int code) {
  static const std::map<int, int> others{{0x20ac, 128}, {0x2026, 133}, {0x2018, 145}, {0x2019, 146}, {0x201c, 147},
                                         {0x201d, 148}, {0x2022, 149}, {0x2013, 150}, {0x2014, 151}, {0x2212, 150}};
  if ((code >= 32 && code < 127) || (code >= 160 && code < 256)) return static_cast<char>(code);
  const auto found = others.find(code);
  return found == others.end() ? '?' : static_cast<char>(found->second);
}

std::string deflated(Bytes bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, bytes.data(), static_cast<uLong>(bytes.size()), 9) !=
      Z_OK)
    throw std::runtime_error("the figure could not be compressed");
  packed.resize(size);
  return packed;
}

Bytes bytes_of(std::string_view text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

// Objects of a file, numbered from 1 in the order in which they are added.
class PdfObjects {
 public:
  int add(std::string_view body) {
    offsets_.push_back(file_.size());
    file_ += fmt::format("{} 0 obj\n{}\nendobj\n", offsets_.size(), body);
    return static_cast<int>(offsets_.size());
  }
  int add_stream(std::string_view dictionary, Bytes content) {
    const std::string packed = deflated(content);
    return add(fmt::format("<< {} /Filter /FlateDecode /Length {} >>\nstream\n", dictionary, packed.size()) + packed +
               "\nendstream");
  }
  // The whole file.
  std::string finish(int catalog, int information) && {
    const std::size_t table = file_.size();
    file_ += fmt::format("xref\n0 {}\n0000000000 65535 f \n", offsets_.size() + 1);
    for (const std::size_t offset : offsets_) file_ += fmt::format("{:010} 00000 n \n", offset);
    file_ += fmt::format("trailer\n<< /Size {} /Root {} 0 R /Info {} 0 R >>\nstartxref\n{}\n%%EOF\n",
                         offsets_.size() + 1, catalog, information, table);
    return std::move(file_);
  }

 private:
  std::string file_ = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";  // the second line says that it is no text
  std::vector<std::size_t> offsets_;
};

std::string pdf_text(std::string_view utf8) {
  std::string text = "(";
  for (const int code : render::characters_of(utf8)) {
    const char letter = win_ansi(code);
    if (letter == '(' || letter == ')' || letter == '\\') text += '\\';
    text += letter;
  }
  return text + ")";
}

std::string components(render::Color color) {
  return fmt::format("{:.4g} {:.4g} {:.4g}", color.r / 255.0, color.g / 255.0, color.b / 255.0);
}

class PdfPage final : public Page {
 public:
  explicit PdfPage(const Figure& figure) : figure_(figure) {
    const PixelBox& box = figure.box;
    const double points = points_per_pixel(figure);
    const int width = box.right - box.left, height = box.bottom - box.top;
    media_box_ = fmt::format("[0 0 {:.6g} {:.6g}]", width * points, height * points);
    // From here on in pixels, y down as in the picture.
    drawing_ =
        fmt::format("{:.9g} 0 0 {:.9g} {:.9g} {:.9g} cm\n", points, -points, -points * box.left, points * box.bottom);
    drawing_ += fmt::format("q {} 0 0 {} {} {} cm /Picture Do Q\n", width, -height, box.left, box.bottom);
  }

  void box(const render::Rectangle& area, float radius, render::Color color, float opacity) override {
    drawing_ += fmt::format("/{} gs {} rg\n", state_of(opacity), components(color));
    const float r = std::min({radius, area.width / 2, area.height / 2});
    if (!(r > 0)) {
      drawing_ += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} re f\n", area.x, area.y, area.width, area.height);
      return;
    }
    constexpr float bend = 0.44772f;  // 1 - 0.55228, of the curve that is nearest to a quarter of a circle
    const float left = area.x, top = area.y, right = area.x + area.width, bottom = area.y + area.height, b = bend * r;
    drawing_ += fmt::format("{:.6g} {:.6g} m {:.6g} {:.6g} l ", left + r, top, right - r, top);
    const auto corner = [&](float x1, float y1, float x2, float y2, float x3, float y3) {
      drawing_ += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.6g} {:.6g} c ", x1, y1, x2, y2, x3, y3);
    };
    corner(right - b, top, right, top + b, right, top + r);
    drawing_ += fmt::format("{:.6g} {:.6g} l ", right, bottom - r);
    corner(right, bottom - b, right - b, bottom, right - r, bottom);
    drawing_ += fmt::format("{:.6g} {:.6g} l ", left + r, bottom);
    corner(left + b, bottom, left, bottom - b, left, bottom - r);
    drawing_ += fmt::format("{:.6g} {:.6g} l ", left, top + r);
    corner(left, top + b, left + b, top, left + r, top);
    drawing_ += "h f\n";
  }
  void scale(const render::Rectangle& area, std::span<const render::Color> colors) override {
    std::vector<std::uint8_t> samples;
    for (const render::Color& color : colors) samples.insert(samples.end(), {color.r, color.g, color.b});
    const int function = objects_.add_stream(
        fmt::format("/FunctionType 0 /Domain [0 1] /Range [0 1 0 1 0 1] /Size [{}] /BitsPerSample 8", colors.size()),
        samples);
    const int shading = objects_.add(
        fmt::format("<< /ShadingType 2 /ColorSpace /DeviceRGB /Coords [0 {:.6g} 0 {:.6g}] /Function {} 0 R >>",
                    area.y + area.height, area.y, function));
    shadings_ += fmt::format("/Scale{0} {0} 0 R ", shading);
    drawing_ += fmt::format("q /{} gs {:.6g} {:.6g} {:.6g} {:.6g} re W n /Scale{} sh Q\n", state_of(1), area.x, area.y,
                            area.width, area.height, shading);
  }
  // As wide as it was laid out, in the program's own font.
  void text(const render::OverlayText& line, render::Color color) override {
    int advance = 0;
    for (const int code : render::characters_of(line.text))
      advance += code >= 32 && code < 127 ? helvetica_advances.at(static_cast<std::size_t>(code - 32)) : usual_advance;
    if (advance == 0) return;
    const float width = render::text_width(line.text, line.size), size = 0.83f * line.size;
    drawing_ += fmt::format("BT /{} gs {} rg /Text {:.5g} Tf {:.5g} Tz 1 0 0 -1 {:.6g} {:.6g} Tm {} Tj ET\n",
                            state_of(line.opacity), components(color), size,
                            100 * width / (size * static_cast<float>(advance) / 1000), line.x - line.align * width,
                            line.y + line.ascent, pdf_text(line.text));
  }

  std::string document() && {
    const render::Image image = cropped(figure_.image, figure_.box);
    const bool has_mask = image.format == render::PixelFormat::rgba;
    std::vector<std::uint8_t> colors, opacities;
    for (std::size_t i = 0; i < image.bytes.size(); ++i)
      (has_mask && i % 4 == 3 ? opacities : colors).push_back(image.bytes[i]);
    const std::string size = fmt::format("/Type /XObject /Subtype /Image /Width {} /Height {} /BitsPerComponent 8",
                                         image.width, image.height);
    std::string mask;
    if (has_mask)
      mask = fmt::format(" /SMask {} 0 R", objects_.add_stream(size + " /ColorSpace /DeviceGray", opacities));
    const int picture = objects_.add_stream(size + " /ColorSpace /DeviceRGB" + mask, colors);
    const int font = objects_.add("<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>");
    const int content = objects_.add_stream("", bytes_of(drawing_));
    std::string states;
    for (const auto& [opacity, name] : states_) states += fmt::format("/{} << /ca {:.4g} >> ", name, opacity);
    const int pages = objects_.add(fmt::format("<< /Type /Pages /Kids [{} 0 R] /Count 1 >>", content + 2));
    objects_.add(fmt::format(
        "<< /Type /Page /Parent {} 0 R /MediaBox {} /Contents {} 0 R /Group << /S /Transparency /CS /DeviceRGB >> "
        "/Resources << /XObject << /Picture {} 0 R >> /Font << /Text {} 0 R >> /ExtGState << {}>> /Shading << {}>> >> "
        ">>",
        pages, media_box_, content, picture, font, states, shadings_));
    const int catalog = objects_.add(fmt::format("<< /Type /Catalog /Pages {} 0 R >>", pages));
    const int information = objects_.add(fmt::format("<< /Subject {} >>", pdf_text(figure_.comment)));
    return std::move(objects_).finish(catalog, information);
  }

 private:
  // The name of the state of drawing with this opacity.
  std::string state_of(float opacity) {
    return states_.try_emplace(opacity, fmt::format("State{}", states_.size() + 1)).first->second;
  }

  const Figure& figure_;
  PdfObjects objects_;
  std::string media_box_, drawing_, shadings_;
  std::map<float, std::string> states_;
};

}  // namespace

std::string figure_svg(const Figure& figure) {
  SvgPage page(figure);
  draw(figure.text, page);
  return std::move(page).document();
}

std::string figure_pdf(const Figure& figure) {
  PdfPage page(figure);
  draw(figure.text, page);
  return std::move(page).document();
}

}  // namespace mercury
