// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/encodings.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "mercury/error.h"

namespace mercury {
namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::int8_t, 256> make_values() {
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < alphabet.size(); ++i)
    values[static_cast<unsigned char>(alphabet[i])] = static_cast<std::int8_t>(i);
  return values;
}
constexpr std::array<std::int8_t, 256> values = make_values();

bool is_space(char letter) { return letter == ' ' || letter == '\t' || letter == '\n' || letter == '\r'; }

}  // namespace

std::string base64_decoded(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0, padding = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_space(text[i])) continue;
    if (text[i] == '=') {
      ++padding;
      continue;
    }
    const std::int8_t value = values[static_cast<unsigned char>(text[i])];
    if (value < 0 || padding > 0)
      throw InputError(fmt::format("not valid base64: character {} cannot be there", i + 1));
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if (++count < 4) continue;
    for (int shift = 16; shift >= 0; shift -= 8) bytes += static_cast<char>(bits >> shift & 0xff);
    bits = 0;
    count = 0;
  }
  // Some writers leave the padding out.
  if (count == 1 || padding > 2 || (padding > 0 && count + padding != 4))
    throw InputError("not valid base64: the text breaks off");
  for (int byte = 0; byte + 1 < count; ++byte) bytes += static_cast<char>(bits >> (6 * count - 8 * (byte + 1)) & 0xff);
  return bytes;
}

std::string base64_encoded(std::string_view bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? alphabet[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string inflated(std::string_view stream, std::size_t size) {
  z_stream state{};
  if (::inflateInit(&state) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, int (*)(z_stream*)> owner(&state, ::inflateEnd);
  state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stream.data()));  // zlib does not write to it
  state.avail_in = static_cast<uInt>(std::min<std::size_t>(stream.size(), 0x7fffffff));
  std::string content;
  int status = Z_OK;
  std::array<char, 16384> piece;
  while (status == Z_OK) {
    state.next_out = reinterpret_cast<Bytef*>(piece.data());
    state.avail_out = static_cast<uInt>(piece.size());
    status = ::inflate(&state, Z_NO_FLUSH);
    content.append(piece.data(), piece.size() - state.avail_out);
    if (content.size() > size) throw InputError(fmt::format("the zlib data hold more than {} bytes", size));
  }
  if (status == Z_BUF_ERROR) throw InputError("the zlib data break off");
  if (status != Z_STREAM_END)
    throw InputError(fmt::format("not valid zlib data: {}", state.msg ? state.msg : "damaged"));
  if (content.size() != size)
    throw InputError(fmt::format("the zlib data hold {} bytes, not {}", content.size(), size));
  return content;
}

}  // namespace mercury
