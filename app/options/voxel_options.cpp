// SPDX-License-Identifier: Apache-2.0
#include "app/options/voxel_options.h"

#include <fmt/format.h>

#include "app/options/option_values.h"

namespace mercury {
namespace {

struct SizeRange {
  std::array<int, 3> smallest, largest;
};

std::array<int, 3> size_from(const std::string& option, const std::string& text) {
  const auto sizes = sizes_from(option, text, 3, "XxYxZ, or a range as in 4x3x3..7x5x4,");
  return {sizes[0], sizes[1], sizes[2]};
}

SizeRange range_from(const std::string& option, const std::string& text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) return {size_from(option, text), size_from(option, text)};
  const SizeRange range{size_from(option, text.substr(0, dots)), size_from(option, text.substr(dots + 2))};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (range.smallest[axis] > range.largest[axis])
      throw InputError(option,
                       fmt::format("\"{}\" is not accepted; the first size must not be above the second", text));
  return range;
}

Mirror mirror_from(const std::string& option, const std::string& text) {
  if (text == "none") return Mirror::none;
  if (text == "x") return Mirror::x;
  if (text == "y") return Mirror::y;
  if (text == "z") return Mirror::z;
  throw InputError(option, fmt::format("\"{}\" is not accepted; give none, x, y or z", text));
}

}  // namespace

void VoxelOptions::add_to(CLI::App& command) {
  const RandomVoxelOptions defaults;
  const auto size = [](const std::array<int, 3>& s) { return fmt::format("{}x{}x{}", s[0], s[1], s[2]); };
  command
      .add_option_function<std::string>(
          "--voxels",
          [this](const std::string& text) {
            const SizeRange range = range_from("--voxels", text);
            options_.smallest = range.smallest;
            options_.largest = range.largest;
          },
          fmt::format("Size in voxels, or smallest and largest (default {}..{})", size(defaults.smallest),
                      size(defaults.largest)))
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
      ->type_name("XxYxZ[..XxYxZ]")
      ->group("Voxel robots");
  const auto number = [&](const char* name, auto& value, const char* description, const char* form) {
    add_number(command, name, value, fmt::format("{} (default {})", description, value), form)->group("Voxel robots");
  };
  number("--edge", options_.edge, "Side of a voxel", "M");
  number("--air", options_.air, "Share of the voxels that are air", "0..1");
  add_value(command, "--symmetry", options_.mirror, "Axis along which the halves mirror each other (default y)",
            "none|x|y|z", mirror_from)
      ->group("Voxel robots");
  number("--patch", options_.patch, "Size of the regions of one material", "VOXELS");
  number("--muscle", options_.muscle, "Share of muscle among the regions", "SHARE");
  number("--tissue", options_.tissue, "Share of tissue", "SHARE");
  number("--bone", options_.bone, "Share of bone", "SHARE");
  number("--frequencies", options_.frequencies, "Muscle frequencies in one robot, 1 to 5", "N");
}

RandomVoxelOptions VoxelOptions::chosen() const {
  validate(options_);
  return options_;
}

}  // namespace mercury
