// SPDX-License-Identifier: Apache-2.0
// USDZ: one USD file in a ZIP archive without compression, whose content begins at a multiple of 64 bytes, as the
// format wants it so that programs map it into memory.
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <fstream>
#include <limits>
#include <string>
#include <system_error>
#include <vector>

#include "app/export/writers.h"
#include "mercury/error.h"

namespace mercury {
namespace {

// A USD file that lives until it is packed.
class TemporaryUsd {
 public:
  explicit TemporaryUsd(const std::filesystem::path& usdz)
      : path_(usdz.parent_path() / fmt::format(".{}.{}.usda", usdz.filename().string(), getpid())) {}
  ~TemporaryUsd() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryUsd(const TemporaryUsd&) = delete;
  TemporaryUsd& operator=(const TemporaryUsd&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Calls take(piece) for all of the file.
template <class Take>
void read_pieces(const std::filesystem::path& path, const Take& take) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 20);
  while (file.read(piece.data(), static_cast<std::streamsize>(piece.size())) || file.gcount() > 0)
    take(std::span<const char>(piece).first(static_cast<std::size_t>(file.gcount())));
}

void pack(const std::filesystem::path& usd, const std::filesystem::path& path) {
  constexpr std::string_view name = "robots.usda";
  constexpr std::size_t alignment = 64, header = 30, extra_header = 4;
  constexpr std::uint16_t version = 20, stored = 0, padding_id = 0x1986;
  std::uint64_t bytes = 0;
  uLong checksum = crc32(0, nullptr, 0);
  read_pieces(usd, [&](std::span<const char> piece) {
    bytes += piece.size();
    checksum = crc32(checksum, reinterpret_cast<const Bytef*>(piece.data()), static_cast<uInt>(piece.size()));
  });
  if (bytes > std::numeric_limits<std::uint32_t>::max() / 2)
    throw InputError(path.string(), "the motion is too long for a .usdz file; give .usda, --every or --to");
  const std::size_t before = header + name.size() + extra_header,
                    padding = (alignment - before % alignment) % alignment;
  OutputStreams files;
  OutputStream& file = files.add(path);
  // What both headers say of the file.
  const auto describe = [&](std::uint16_t extra) {
    file.raw(version);
    file.raw(std::uint16_t{0});
    file.raw(stored);
    file.raw(std::uint16_t{0});       // time
    file.raw(std::uint16_t{0x0021});  // 1980-01-01: the same robots give the same file
    file.raw(static_cast<std::uint32_t>(checksum));
    file.raw(static_cast<std::uint32_t>(bytes));
    file.raw(static_cast<std::uint32_t>(bytes));
    file.raw(static_cast<std::uint16_t>(name.size()));
    file.raw(extra);
  };
  file.text("PK\3\4");
  describe(static_cast<std::uint16_t>(extra_header + padding));
  file.text(name);
  file.raw(padding_id);
  file.raw(static_cast<std::uint16_t>(padding));
  file.text(std::string(padding, '\0'));
  read_pieces(usd, [&](std::span<const char> piece) { file.bytes(piece.data(), piece.size()); });
  const auto directory = static_cast<std::uint32_t>(file.size());
  file.text("PK\1\2");
  file.raw(version);
  describe(0);
  file.raw(std::uint16_t{0});  // no comment
  file.raw(std::uint16_t{0});
  file.raw(std::uint16_t{0});
  file.raw(std::uint32_t{0});
  file.raw(std::uint32_t{0});  // where the file is
  file.text(name);
  const auto end = static_cast<std::uint32_t>(file.size());
  file.text("PK\5\6");
  for (const int number : {0, 0, 1, 1}) file.raw(static_cast<std::uint16_t>(number));
  file.raw(end - directory);
  file.raw(directory);
  file.raw(std::uint16_t{0});
  files.keep();
}

}  // namespace

void write_usdz(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
                const ExportChoices& choices) {
  const TemporaryUsd usd(path);
  write_usda(robot, pose, usd.path(), choices);
  pack(usd.path(), path);
}

void write_usdz_motion(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                       const ExportChoices& choices) {
  const TemporaryUsd usd(path);
  write_usda_motion(robot, motion, usd.path(), choices);
  pack(usd.path(), path);
}

void write_usdz_motions(std::span<RecordedMotion> motions, const std::filesystem::path& path,
                        const ExportChoices& choices) {
  const TemporaryUsd usd(path);
  write_usda_motions(motions, usd.path(), choices);
  pack(usd.path(), path);
}

}  // namespace mercury
