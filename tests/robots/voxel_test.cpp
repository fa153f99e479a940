// SPDX-License-Identifier: Apache-2.0
#include "mercury/voxel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "mercury/random.h"
#include "tests/refusal.h"
#include "tests/robots/surface.h"

namespace mercury {
namespace {

using Corner = std::tuple<int, int, int>;
using Voxel = std::tuple<int, int, int>;

Corner corner_of(const VoxelGrid& grid, Vec3 x) {
  const auto coordinate = [&](float value, int n) {
    return static_cast<int>(std::lround(static_cast<double>(value) / static_cast<double>(grid.edge) + n / 2.0));
  };
  return {coordinate(x.x, grid.nx), coordinate(x.y, grid.ny), coordinate(x.z, grid.nz)};
}

std::vector<Voxel> voxels_of(const VoxelGrid& grid) {
  std::vector<Voxel> voxels;
  for (int z = 0; z < grid.nz; ++z)
    for (int y = 0; y < grid.ny; ++y)
      for (int x = 0; x < grid.nx; ++x)
        if (grid.at(x, y, z) != air) voxels.emplace_back(x, y, z);
  return voxels;
}

// The largest part of voxels that share sides, found by growing sets.
std::set<Voxel> largest_part(const VoxelGrid& grid) {
  std::set<Voxel> largest;
  std::set<Voxel> seen;
  for (const Voxel& start : voxels_of(grid)) {
    if (seen.contains(start)) continue;
    std::set<Voxel> part{start}, edge{start};
    while (!edge.empty()) {
      std::set<Voxel> next;
      for (const auto& [x, y, z] : edge)
        for (const Voxel& voxel : {Voxel{x - 1, y, z}, Voxel{x + 1, y, z}, Voxel{x, y - 1, z}, Voxel{x, y + 1, z},
                                   Voxel{x, y, z - 1}, Voxel{x, y, z + 1}})
          if (grid.at(std::get<0>(voxel), std::get<1>(voxel), std::get<2>(voxel)) != air && part.insert(voxel).second)
            next.insert(voxel);
      edge = next;
    }
    seen.insert(part.begin(), part.end());
    if (part.size() > largest.size()) largest = part;
  }
  return largest;
}

struct Expected {
  std::set<Corner> corners;
  std::map<std::pair<Corner, Corner>, std::map<MaterialId, int>> springs;  // how many voxels of each material share it
  std::size_t sides = 0;
};

Expected brute_force(const VoxelGrid& grid) {
  Expected expected;
  const std::set<Voxel> body = largest_part(grid);
  for (const auto& [x, y, z] : body) {
    std::vector<Corner> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
    expected.corners.insert(corners.begin(), corners.end());
    for (const Corner& a : corners)
      for (const Corner& b : corners)
        if (a < b) ++expected.springs[{a, b}][grid.at(x, y, z)];
    for (const Voxel& side : {Voxel{x - 1, y, z}, Voxel{x + 1, y, z}, Voxel{x, y - 1, z}, Voxel{x, y + 1, z},
                              Voxel{x, y, z - 1}, Voxel{x, y, z + 1}})
      expected.sides += body.contains(side) ? 0 : 1;
  }
  return expected;
}

MaterialId expected_material(const std::map<MaterialId, int>& shares) {
  std::vector<std::pair<int, MaterialId>> order;
  for (const auto& [material, voxels] : shares) order.emplace_back(-voxels, material);
  std::sort(order.begin(), order.end());
  return order.size() == 1 ? order[0].second : combine(order[0].second, order[1].second);
}

VoxelGrid random_cells(std::uint64_t seed) {
  Random random(seed);
  const auto size = [&] { return 1 + static_cast<int>(random.below(5)); };
  const int nx = size(), ny = size(), nz = size();
  VoxelGrid grid(nx, ny, nz);
  // Few materials, so that ties and majorities are common.
  const MaterialId choices[] = {3, 7, tissue, bone};
  for (MaterialId& cell : grid.cells) cell = random.chance(0.4) ? air : choices[random.below(4)];
  grid.cells[random.below(grid.cells.size())] = 5;
  return grid;
}

TEST(VoxelRobot, OneVoxelizACube) {
  const Robot robot = make_voxel_robot(VoxelGrid(1, 1, 1, tissue));
  EXPECT_EQ(robot.masses.size(), 8u);
  EXPECT_EQ(robot.springs.size(), 28u);
  EXPECT_EQ(robot.faces.size(), 12u);
  std::map<float, int> lengths;
  for (const Spring& spring : robot.springs) ++lengths[spring.rest_length];
  EXPECT_THAT(lengths, testing::ElementsAre(testing::Pair(testing::FloatEq(0.1f), 12),
                                            testing::Pair(testing::FloatEq(0.14142136f), 12),
                                            testing::Pair(testing::FloatEq(0.17320508f), 4)));
  EXPECT_NEAR(enclosed_volume(robot), 1e-3, 1e-8);
  EXPECT_EQ(robot.masses[0], (Vec3{-0.05f, -0.05f, -0.05f}));
  EXPECT_EQ(robot.masses[1], (Vec3{0.05f, -0.05f, -0.05f}));
}

TEST(VoxelRobot, AFullLatticeHasTheCountsOfTheFormula) {
  // n^3 voxels: (n+1)^3 masses; 3n(n+1)^2 edges, 6n^2(n+1) face diagonals, 4n^3 body diagonals; 6n^2 sides.
  const Robot robot = make_voxel_robot(VoxelGrid(10, 10, 10, 1));
  EXPECT_EQ(robot.masses.size(), 1331u);
  EXPECT_EQ(robot.springs.size(), 14230u);
  EXPECT_EQ(robot.faces.size(), 1200u);
  EXPECT_NO_THROW(validate(robot));
}

TEST(VoxelRobot, FollowsTheGridVoxelByVoxel) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const VoxelGrid grid = random_cells(seed);
    const Expected expected = brute_force(grid);
    const Robot robot = make_voxel_robot(grid);
    ASSERT_NO_THROW(validate(robot));
    ASSERT_EQ(robot.masses.size(), expected.corners.size()) << "seed " << seed;
    ASSERT_EQ(robot.springs.size(), expected.springs.size()) << "seed " << seed;
    ASSERT_EQ(robot.faces.size(), 2 * expected.sides) << "seed " << seed;
    for (const Vec3& mass : robot.masses) ASSERT_TRUE(expected.corners.contains(corner_of(grid, mass)));
    for (const Spring& spring : robot.springs) {
      const Corner a = corner_of(grid, robot.masses[spring.a]), b = corner_of(grid, robot.masses[spring.b]);
      const auto found = expected.springs.find({std::min(a, b), std::max(a, b)});
      ASSERT_NE(found, expected.springs.end()) << "seed " << seed;
      ASSERT_EQ(spring.material, expected_material(found->second)) << "seed " << seed;
      ASSERT_NEAR(spring.rest_length, rest_distance(robot, spring.a, spring.b), 1e-6);
    }
  }
}

TEST(VoxelRobot, HasAClosedOrientedSkinOneComponentAndEverySpringOnce) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const VoxelGrid grid = random_cells(seed);
    const Robot robot = make_voxel_robot(grid);
    ASSERT_TRUE(half_edges_cancel(robot)) << "seed " << seed;
    ASSERT_TRUE(every_spring_is_there_once(robot)) << "seed " << seed;
    ASSERT_EQ(spring_components(robot), 1u) << "seed " << seed;
    // The skin encloses the body's voxels exactly, so the faces look outward.
    ASSERT_NEAR(enclosed_volume(robot), 1e-3 * static_cast<double>(largest_part(grid).size()), 1e-6) << "seed " << seed;
  }
}

TEST(VoxelRobot, ABodyThatHangsOnAnEdgeOrCornerIsDropped) {
  VoxelGrid grid(3, 2, 1);
  grid.cell(0, 0, 0) = 1;
  grid.cell(1, 0, 0) = 1;
  grid.cell(2, 1, 0) = 2;  // touches (1, 0, 0) along an edge
  const Robot robot = make_voxel_robot(grid);
  EXPECT_EQ(robot.masses.size(), 12u);
  for (const Spring& spring : robot.springs) EXPECT_EQ(spring.material, 1);
}

TEST(VoxelRobot, OfEquallyLargeBodiesTheFirstStays) {
  VoxelGrid grid(3, 1, 1);
  grid.cell(0, 0, 0) = 4;
  grid.cell(2, 0, 0) = 5;
  EXPECT_EQ(largest_body(grid).cells, (std::vector<MaterialId>{4, 0, 0}));
}

TEST(VoxelRobot, VoxelsOfOneBodyThatMeetAtAnEdgeShareItsMasses) {
  VoxelGrid grid(2, 2, 2, 1);
  grid.cell(0, 0, 0) = air;
  grid.cell(1, 1, 0) = air;  // (1,0,0) and (0,1,0) now meet along the middle edge, both resting on the upper layer
  const Robot robot = make_voxel_robot(grid);
  EXPECT_EQ(robot.masses.size(), 9u + 9u + 7u);
  EXPECT_TRUE(half_edges_cancel(robot));
}

TEST(VoxelRobot, GivesItsGridBack) {
  VoxelGrid grid = random_cells(7);
  grid.edge = 0.0725f;
  const Robot robot = make_voxel_robot(grid, {.name = "x", .environment = "land", .seed = ~0ull, .index = 3});
  EXPECT_EQ(voxel_grid_of(robot), grid);
  EXPECT_THAT(robot.origin, testing::HasSubstr("\"environment\":\"land\",\"seed\":18446744073709551615,\"index\":3"));
  EXPECT_EQ(voxel_grid_of(Robot{}), std::nullopt);
  EXPECT_EQ(voxel_grid_of(Robot{.origin = R"({"kind":"nn"})"}), std::nullopt);
}

TEST(VoxelRobot, RefusesGridsThatBreakARule) {
  const auto make = [](const VoxelGrid& grid) { return refusal([&] { make_voxel_robot(grid); }); };
  EXPECT_EQ(refusal([] { VoxelGrid(0, 4, 4); }),
            "voxel grid: size 0x4x4 is not accepted; give at least 1 voxel each way");
  EXPECT_EQ(refusal([] { VoxelGrid(2000000000, 2000000000, 2000000000); }),
            "voxel grid: size 2000000000x2000000000x2000000000 is not accepted; give at most 67108864 voxels");
  EXPECT_EQ(make(VoxelGrid(2, 2, 2)), "voxel grid: all voxels are air, a robot needs at least one that is not");
  EXPECT_EQ(make(VoxelGrid(2, 2, 2, 23)),
            "voxel grid: cell 0 is of material 23; give 0 (air) or a base material (1 to 22)");
  VoxelGrid grid(2, 2, 2, 1);
  grid.cells.pop_back();
  EXPECT_EQ(make(grid), "voxel grid: size 2x2x2 needs 8 cells, not 7");
  grid = VoxelGrid(1, 1, 1, 1);
  grid.edge = 0.0005f;
  EXPECT_EQ(make(grid),
            "voxel grid: a voxel edge of 0.000500 m is not accepted; give at least 0.001 m and a grid of at "
            "most 2e6 m");
  EXPECT_EQ(make(VoxelGrid(40, 40, 40, 1)), "voxel grid: the body has 68921 masses, at most 65535 are accepted");
  EXPECT_EQ(make_voxel_robot(VoxelGrid(39, 39, 39, 1)).masses.size(), 64000u);
}

TEST(VoxelRobot, RefusesAnOriginThatHoldsNoGrid) {
  const auto read = [](const char* origin) { return refusal([&] { voxel_grid_of(Robot{.origin = origin}); }); };
  EXPECT_EQ(read("nonsense"), "/origin: must be a JSON object");
  EXPECT_EQ(read(R"({"kind":"voxel"})"), "/origin: size must be three whole numbers of at least 1");
  EXPECT_EQ(read(R"({"kind":"voxel","size":[1,1,1],"edge":0.1,"cells":[99]})"),
            "/origin: cells must be 0 (air) or base materials (1 to 22)");
  EXPECT_EQ(read(R"({"kind":"voxel","size":[1,1,2],"edge":0.1,"cells":[1]})"),
            "/origin: voxel grid: size 1x1x2 needs 2 cells, not 1");
  EXPECT_EQ(read(R"({"kind":"voxel","size":[1,1,1],"edge":1e300,"cells":[1]})"),
            "/origin: edge must be a number of meters");
}

}  // namespace
}  // namespace mercury
