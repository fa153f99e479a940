// SPDX-License-Identifier: Apache-2.0
#include "render/png.h"

#include <png.h>
#include <zlib.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <stdexcept>

namespace mercury::render {
namespace {

std::uint32_t png_format(PixelFormat format) {
  switch (format) {
    case PixelFormat::rgb:
      return PNG_FORMAT_RGB;
    case PixelFormat::rgba:
      return PNG_FORMAT_RGBA;
    default:
      throw std::invalid_argument("a PNG is written from rgb or rgba");
  }
}

png_image description_of(const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = png_uint_32(image.width);
  png.height = png_uint_32(image.height);
  png.format = png_format(image.format);
  return png;
}

void append(std::vector<std::uint8_t>& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(number >> shift));
}

// A chunk: length, name, content, checksum of the latter two.
void insert_chunk(std::vector<std::uint8_t>& png, std::ptrdiff_t place, std::string_view name,
                  const std::vector<std::uint8_t>& content) {
  std::vector<std::uint8_t> chunk;
  append(chunk, static_cast<std::uint32_t>(content.size()));
  chunk.insert(chunk.end(), name.begin(), name.end());
  chunk.insert(chunk.end(), content.begin(), content.end());
  append(chunk, static_cast<std::uint32_t>(crc32(0, chunk.data() + 4, static_cast<unsigned>(chunk.size() - 4))));
  png.insert(png.begin() + place, chunk.begin(), chunk.end());
}

// Goes before the last chunk, the 12 bytes of IEND.
void add_text(std::vector<std::uint8_t>& png, std::string_view keyword, std::string_view text) {
  std::vector<std::uint8_t> content(keyword.begin(), keyword.end());
  content.push_back(0);
  content.insert(content.end(), text.begin(), text.end());
  insert_chunk(png, std::ssize(png) - 12, "tEXt", content);
}

// Goes after the signature of 8 bytes and the first chunk, IHDR, of 25.
void add_resolution(std::vector<std::uint8_t>& png, double dpi) {
  constexpr double inch = 0.0254;  // [m]
  std::vector<std::uint8_t> content;
  for (int axis = 0; axis < 2; ++axis) append(content, static_cast<std::uint32_t>(std::lround(dpi / inch)));
  content.push_back(1);  // per meter
  insert_chunk(png, 8 + 25, "pHYs", content);
}

[[noreturn]] void fail(const std::string& path, const std::string& why) { throw std::runtime_error(path + ": " + why); }

}  // namespace

void write_png(const std::string& path, const Image& image) {
  png_image png = description_of(image);
  const std::string temporary = path + ".part";
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (!file) fail(path, std::strerror(errno));
  errno = 0;
  const bool written = png_image_write_to_stdio(&png, file, 0, image.bytes.data(), 0, nullptr) != 0;
  const int error = errno;
  const bool closed = std::fclose(file) == 0;
  if (written && closed && std::rename(temporary.c_str(), path.c_str()) == 0) return;
  const std::string why = error ? std::strerror(error) : !written ? png.message : std::strerror(errno);
  std::remove(temporary.c_str());
  fail(path, why);
}

std::vector<std::uint8_t> png_bytes(const Image& image, std::string_view comment, double dpi) {
  png_image png = description_of(image);
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.bytes.data(), 0, nullptr))
    throw std::runtime_error(png.message);
  bytes.resize(size);
  if (!comment.empty()) add_text(bytes, "Comment", comment);
  if (dpi > 0) add_resolution(bytes, dpi);
  return bytes;
}

Image read_png(const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_file(&png, path.c_str())) fail(path, png.message);
  Image image;
  image.format = (png.format & PNG_FORMAT_FLAG_ALPHA) ? PixelFormat::rgba : PixelFormat::rgb;
  png.format = png_format(image.format);
  image.width = int(png.width);
  image.height = int(png.height);
  image.bytes.resize(PNG_IMAGE_SIZE(png));
  if (!png_image_finish_read(&png, nullptr, image.bytes.data(), 0, nullptr)) fail(path, png.message);
  return image;
}

}  // namespace mercury::render
