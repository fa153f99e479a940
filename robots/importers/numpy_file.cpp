// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/encodings.h"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstring>

#include "mercury/error.h"

namespace mercury {
namespace {

constexpr std::size_t most_bytes = std::size_t{64} << 20;  // of an array
constexpr std::size_t most_arrays = 1000;

[[noreturn]] void damaged() { throw InputError("not an archive of NumPy (.npz), or damaged"); }

// Whole numbers of a ZIP archive, the lowest byte first.
template <class Number>
Number number_at(std::string_view bytes, std::size_t place) {
  if (place > bytes.size() || bytes.size() - place < sizeof(Number)) damaged();
  Number number = 0;
  for (std::size_t i = sizeof(Number); i-- > 0;)
    number = static_cast<Number>(number << 8 | static_cast<unsigned char>(bytes[place + i]));
  return number;
}

std::string_view part(std::string_view bytes, std::size_t begin, std::size_t size) {
  if (begin > bytes.size() || bytes.size() - begin < size) damaged();
  return bytes.substr(begin, size);
}

std::string unpacked(std::string_view packed, std::size_t size) {
  std::string bytes(size, '\0');
  z_stream stream{};
  constexpr int raw = -15;  // without a header
  if (inflateInit2(&stream, raw) != Z_OK) throw std::bad_alloc();
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(bytes.size());
  const int status = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  if (status != Z_STREAM_END || stream.avail_out != 0) damaged();
  return bytes;
}

// What follows 'key': in the header of a .npy file, which is a dictionary of Python.
std::string_view value_of(std::string_view header, std::string_view key) {
  const std::size_t place = header.find(fmt::format("'{}':", key));
  if (place == std::string_view::npos) damaged();
  std::string_view value = header.substr(place + key.size() + 3);
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  return value;
}

template <class Number>
double as(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return static_cast<double>(number);
}

struct NumberKind {
  std::string_view name;
  std::size_t size;
  double (*read)(const char*);
};
constexpr NumberKind kinds[]{
    {"<f8", 8, as<double>},        {"<f4", 4, as<float>},         {"<i8", 8, as<std::int64_t>},
    {"<i4", 4, as<std::int32_t>},  {"<i2", 2, as<std::int16_t>},  {"|i1", 1, as<std::int8_t>},
    {"<u8", 8, as<std::uint64_t>}, {"<u4", 4, as<std::uint32_t>}, {"<u2", 2, as<std::uint16_t>},
    {"|u1", 1, as<std::uint8_t>},  {"|b1", 1, as<std::uint8_t>}};
static_assert(std::endian::native == std::endian::little);

// "(5, 5), ..."
std::vector<std::size_t> shape_in(std::string_view text) {
  std::vector<std::size_t> shape;
  if (!text.starts_with('(')) damaged();
  const std::string_view inside = text.substr(1, text.find(')') - 1);
  for (std::size_t i = 0; i < inside.size();) {
    if (!std::isdigit(static_cast<unsigned char>(inside[i]))) {
      ++i;
      continue;
    }
    std::size_t length = 0;
    const auto [end, error] = std::from_chars(inside.data() + i, inside.data() + inside.size(), length);
    if (error != std::errc{} || length > most_bytes) damaged();
    shape.push_back(length);
    i = static_cast<std::size_t>(end - inside.data());
  }
  return shape;
}

NumpyArray array_of(std::string_view npy, std::string name) {
  if (!npy.starts_with("\x93NUMPY")) damaged();
  const bool is_first_version = number_at<std::uint8_t>(npy, 6) == 1;
  const std::size_t length = is_first_version ? number_at<std::uint16_t>(npy, 8) : number_at<std::uint32_t>(npy, 8);
  const std::size_t begin = is_first_version ? 10 : 12;
  const std::string_view header = part(npy, begin, length), data = npy.substr(begin + length);
  const std::string_view description = value_of(header, "descr");
  if (description.empty()) damaged();
  const std::string_view kind_name = description.substr(1, 3);
  const NumberKind* kind = nullptr;
  for (const NumberKind& known : kinds)
    if (known.name == kind_name) kind = &known;
  if (!kind) throw InputError("/" + name, fmt::format("holds {}, and numbers are expected", description.substr(0, 12)));
  NumpyArray array{.name = std::move(name), .shape = shape_in(value_of(header, "shape")), .values = {}};
  std::size_t count = 1;
  for (const std::size_t n : array.shape)
    count = n == 0 || count > most_bytes / n ? (n == 0 ? 0 : most_bytes + 1) : count * n;
  if (count > data.size() / kind->size) damaged();
  array.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) array.values[i] = kind->read(data.data() + i * kind->size);
  if (!value_of(header, "fortran_order").starts_with("True") || array.shape.size() != 2) return array;
  std::vector<double> rows(count);
  for (std::size_t i = 0; i < count; ++i)
    rows[i % array.shape[0] * array.shape[1] + i / array.shape[0]] = array.values[i];
  array.values = std::move(rows);
  return array;
}

}  // namespace

// The directory at the end of the archive lists the files; before each file stands a header of its own, whose length
// only that header says.
std::vector<NumpyArray> numpy_arrays(std::string_view file) {
  const std::size_t end = file.rfind("PK\5\6");
  constexpr std::size_t end_size = 22;
  if (end == std::string_view::npos || file.size() - end < end_size) damaged();
  const std::size_t count = number_at<std::uint16_t>(file, end + 10);
  std::size_t entry = number_at<std::uint32_t>(file, end + 16);
  if (count > most_arrays) damaged();
  std::vector<NumpyArray> arrays;
  for (std::size_t i = 0; i < count; ++i) {
    if (part(file, entry, 4) != "PK\1\2") damaged();
    const auto method = number_at<std::uint16_t>(file, entry + 10);
    const std::size_t packed_size = number_at<std::uint32_t>(file, entry + 20),
                      size = number_at<std::uint32_t>(file, entry + 24),
                      name_size = number_at<std::uint16_t>(file, entry + 28),
                      extra = number_at<std::uint16_t>(file, entry + 30),
                      comment = number_at<std::uint16_t>(file, entry + 32),
                      local = number_at<std::uint32_t>(file, entry + 42);
    std::string name(part(file, entry + 46, name_size));
    entry += 46 + name_size + extra + comment;
    if (!name.ends_with(".npy")) continue;
    name.resize(name.size() - 4);
    if (size > most_bytes) throw InputError("/" + name, "is larger than 64 MB");
    const std::size_t begin =
        local + 30 + number_at<std::uint16_t>(file, local + 26) + number_at<std::uint16_t>(file, local + 28);
    const std::string_view packed = part(file, begin, packed_size);
    constexpr int stored = 0, deflated = 8;
    if (method == stored)
      arrays.push_back(array_of(packed, std::move(name)));
    else if (method == deflated)
      arrays.push_back(array_of(unpacked(packed, size), std::move(name)));
    else
      damaged();
  }
  return arrays;
}

}  // namespace mercury
