// SPDX-License-Identifier: Apache-2.0
#include "robots/voxel_origin.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

#include "mercury/error.h"
#include "robots/document.h"

namespace mercury {
namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(const std::string& what) { throw InputError("/origin", what); }

int size_of(const Json& size, std::size_t axis) {
  const Json& value = size[axis];
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() == 0 ||
      value.get<std::uint64_t>() > VoxelGrid::max_cells)
    refuse("size must be three whole numbers of at least 1");
  return value.get<int>();
}

VoxelGrid grid_of(const Json& origin) {
  const auto size = origin.find("size"), edge = origin.find("edge"), cells = origin.find("cells");
  if (size == origin.end() || !size->is_array() || size->size() != 3)
    refuse("size must be three whole numbers of at least 1");
  if (edge == origin.end() || !edge->is_number() || !(std::abs(edge->get<double>()) <= 1e6))
    refuse("edge must be a number of meters");
  if (cells == origin.end() || !cells->is_array()) refuse("cells must be an array of materials");
  VoxelGrid grid;
  grid.nx = size_of(*size, 0);
  grid.ny = size_of(*size, 1);
  grid.nz = size_of(*size, 2);
  grid.edge = edge->get<float>();
  grid.cells.reserve(cells->size());
  for (const Json& cell : *cells) {
    if (!cell.is_number_unsigned() || cell.get<std::uint64_t>() > base_material_count)
      refuse("cells must be 0 (air) or base materials (1 to 22)");
    grid.cells.push_back(cell.get<MaterialId>());
  }
  return grid;
}

}  // namespace

std::string voxel_origin(const VoxelGrid& grid, const VoxelRobotOptions& options) {
  std::string origin = R"({"kind":"voxel","size":[)" + std::to_string(grid.nx) + "," + std::to_string(grid.ny) + "," +
                       std::to_string(grid.nz) + "],\"edge\":";
  std::array<char, 32> room;
  origin += to_text(real_number(grid.edge, room));
  if (!options.environment.empty()) origin += ",\"environment\":" + json_text(options.environment);
  if (options.seed) origin += ",\"seed\":" + std::to_string(*options.seed);
  if (options.index) origin += ",\"index\":" + std::to_string(*options.index);
  origin += ",\"cells\":[";
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (i > 0) origin += ',';
    origin += std::to_string(grid.cells[i]);
  }
  return origin += "]}";
}

std::optional<VoxelGrid> voxel_grid_of(const Robot& robot) {
  if (robot.origin.empty()) return std::nullopt;
  const Json origin = Json::parse(robot.origin, nullptr, false);
  if (!origin.is_object()) refuse("must be a JSON object");
  const auto kind = origin.find("kind");
  if (kind == origin.end() || *kind != "voxel") return std::nullopt;
  VoxelGrid grid = grid_of(origin);
  try {
    validate(grid);
  } catch (const InputError& error) {
    refuse(error.what());
  }
  return grid;
}

}  // namespace mercury
