// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "sim/cuda/chunks.h"
#include "sim/physics/face_backs.h"
#include "sim/physics/fixed_point.h"
#include "tests/sim/bodies.h"

namespace mercury::cuda {
namespace {

struct SplitRobot {
  Robot robot;
  SlotOrder order;
  std::vector<FacePair> faces;  // of masses, in the order of the whole robot's face tiles
  std::vector<Part> parts;

  SplitRobot(Robot made, std::uint32_t count) : robot(std::move(made)) {
    const Arrangement whole = arrange(robot);
    order = *whole.order;
    const std::vector<std::uint16_t> mass = order.masses();
    for (const FacePair& p : whole.faces)
      faces.push_back(p == padding_faces ? p : FacePair{mass[p.a], mass[p.b], mass[p.c], mass[p.d]});
    parts = split(robot, order, count);
  }
  // [mass of the robot], its part.
  std::vector<std::uint32_t> part_of() const {
    std::vector<std::uint32_t> part(robot.masses.size());
    for (std::uint32_t p = 0; p < parts.size(); ++p)
      for (std::uint32_t i = 0; i < parts[p].own; ++i) part[parts[p].masses[i]] = p;
    return part;
  }
};

// A bar, a body with odd sides, one with masses that only faces join, one whose cut goes through few masses.
std::vector<SplitRobot> split_robots() {
  std::vector<SplitRobot> all;
  all.emplace_back(bodies::random_voxels({.x = 20, .y = 3, .z = 2}, 1), 2);
  all.emplace_back(bodies::random_voxels({.x = 7, .y = 9, .z = 11}, 2), 4);
  all.emplace_back(bodies::random_voxels({.x = 11, .y = 11, .z = 11}, 3), 16);
  Robot sheet = bodies::random_voxels({.x = 30, .y = 1, .z = 1}, 4);
  std::erase_if(sheet.springs, [&](const Spring& s) { return s.a % 3 == 0 || s.b % 5 == 0; });
  all.emplace_back(std::move(sheet), 3);
  return all;
}

// [slot of the part], the mass of the robot that stands there, or none.
constexpr std::uint32_t none = ~0u;
std::vector<std::uint32_t> masses_in(const Part& part) {
  std::vector<std::uint32_t> mass(std::size_t{part.tiles()} * lanes, none);
  for (std::uint32_t i = 0; i < part.masses.size(); ++i) mass[part.arrangement.order->slots[i]] = part.masses[i];
  return mass;
}

TEST(Parts, OwnEachMassOnceAndAboutEquallyMany) {
  for (const SplitRobot& body : split_robots()) {
    std::vector<int> owners(body.robot.masses.size());
    std::size_t most = 0, least = owners.size();
    for (const Part& part : body.parts) {
      for (std::uint32_t i = 0; i < part.own; ++i) ++owners[part.masses[i]];
      most = std::max<std::size_t>(most, part.own);
      least = std::min<std::size_t>(least, part.own);
    }
    EXPECT_TRUE(std::ranges::all_of(owners, [](int n) { return n == 1; }));
    EXPECT_LE(most, least + 2);
  }
}

TEST(Parts, HaveOwnMassesInTheFirstTilesAndGhostsAfterThem) {
  for (const SplitRobot& body : split_robots())
    for (const Part& part : body.parts) {
      std::set<std::uint16_t> slots;
      for (std::uint32_t i = 0; i < part.masses.size(); ++i) {
        const std::uint16_t slot = part.arrangement.order->slots[i];
        EXPECT_TRUE(slots.insert(slot).second);
        if (i < part.own)
          EXPECT_LT(slot, part.own);
        else
          EXPECT_GE(slot, part.own_tiles() * lanes);
        EXPECT_LT(slot, part.tiles() * lanes);
      }
    }
}

TEST(Parts, ComputeEachSpringOfTheirOwnMassesOnceFromAnOwnMass) {
  for (const SplitRobot& body : split_robots()) {
    const std::vector<std::uint32_t> part_of = body.part_of();
    for (std::uint32_t p = 0; p < body.parts.size(); ++p) {
      const Part& part = body.parts[p];
      const Schedule& schedule = part.arrangement.schedule;
      const std::vector<std::uint32_t> mass = masses_in(part);
      std::multiset<std::uint32_t> computed;
      std::vector<std::uint32_t> incoming(mass.size());
      for (std::uint32_t tile = 0; tile < schedule.tiles(); ++tile)
        for (std::uint32_t i = schedule.row_start[tile] * lanes; i < schedule.row_start[tile + 1] * lanes; ++i) {
          const ScheduledSpring& entry = schedule.entries[i];
          ++incoming[entry.partner];
          if (entry.spring == padding) continue;
          const std::uint32_t number = part.springs[entry.spring], owner = tile * lanes + i % lanes;
          const Spring& spring = body.robot.springs[number];
          computed.insert(number);
          EXPECT_EQ(std::minmax<std::uint32_t>(mass[owner], mass[entry.partner]),
                    std::minmax<std::uint32_t>(spring.a, spring.b));
          EXPECT_EQ(part_of[mass[owner]], p);
        }
      EXPECT_EQ(incoming, schedule.incoming_counts);
      std::multiset<std::uint32_t> wanted;
      for (std::uint32_t i = 0; i < body.robot.springs.size(); ++i)
        if (part_of[body.robot.springs[i].a] == p || part_of[body.robot.springs[i].b] == p) wanted.insert(i);
      EXPECT_EQ(computed, wanted);
    }
  }
}

// All parts see a pair from the same side and with the same dither, though its faces may have changed places.
TEST(Parts, ComputeEachFaceOfTheirOwnMassesOnce) {
  for (const SplitRobot& body : split_robots()) {
    const std::vector<std::uint32_t> part_of = body.part_of();
    for (std::uint32_t p = 0; p < body.parts.size(); ++p) {
      const Part& part = body.parts[p];
      const std::vector<std::uint32_t> mass = masses_in(part);
      using Face = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;  // a, c, outer mass, dither
      std::multiset<Face> computed, wanted;
      ASSERT_EQ(part.face_dithers.size(), part.arrangement.faces.size());
      for (std::size_t i = 0; i < part.face_dithers.size(); ++i) {
        const FacePair& f = part.arrangement.faces[i];
        if (f == padding_faces) continue;
        computed.insert({mass[f.a], mass[f.c], mass[f.b], part.face_dithers[i]});
        computed.insert({mass[f.a], mass[f.c], mass[f.d], part.face_dithers[i] + second_face_dither});
      }
      for (std::uint32_t i = 0; i < body.faces.size(); ++i) {
        const FacePair& f = body.faces[i];
        if (f == padding_faces) continue;
        if (std::ranges::none_of(std::array{f.a, f.b, f.c, f.d}, [&](std::uint16_t m) { return part_of[m] == p; }))
          continue;
        wanted.insert({f.a, f.c, f.b, dither_of_pair(i)});
        wanted.insert({f.a, f.c, f.d, dither_of_pair(i) + second_face_dither});
      }
      EXPECT_EQ(computed, wanted);
    }
  }
}

// Faces without an own corner may lack it: what they add to is not used.
TEST(Parts, KnowTheMassBehindEachFaceOfTheirOwnMasses) {
  for (const SplitRobot& body : split_robots()) {
    const std::vector<std::uint32_t> part_of = body.part_of();
    const FaceBacks backs(body.robot);
    for (std::uint32_t p = 0; p < body.parts.size(); ++p) {
      const Part& part = body.parts[p];
      std::vector<std::uint16_t> mass_at;
      for (const std::uint32_t mass : masses_in(part))
        mass_at.push_back(mass == none ? part.masses.front() : static_cast<std::uint16_t>(mass));
      std::vector<std::uint32_t> found(part.arrangement.faces.size());
      fill_backs(found, body.robot, mass_at, part.arrangement.faces, 0);
      std::size_t own = 0, with_back = 0;
      const auto check = [&](std::uint32_t back, const Face& face) {
        if (part_of[face.a] != p && part_of[face.b] != p && part_of[face.c] != p) return;
        ++own;
        with_back += backs.behind(face) != face.a;
        EXPECT_EQ(mass_at[back], backs.behind(face));
        EXPECT_NE(masses_in(part)[back], none);
      };
      for (std::size_t i = 0; i < found.size(); ++i) {
        const FacePair& slots = part.arrangement.faces[i];
        if (slots == padding_faces) continue;
        const FacePair f{mass_at[slots.a], mass_at[slots.b], mass_at[slots.c], mass_at[slots.d]};
        check(found[i] & 0xffff, {f.a, f.b, f.c});
        if (f.d != f.a) check(found[i] >> 16, {f.a, f.c, f.d});
      }
      EXPECT_GT(with_back, own / 5);
    }
  }
}

TEST(Parts, FillEachGhostOnceFromItsOwnMass) {
  for (const SplitRobot& body : split_robots()) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> filled;  // (part, slot) from this mass
    for (std::uint32_t p = 0; p < body.parts.size(); ++p) {
      const Part& part = body.parts[p];
      const std::vector<std::uint32_t> mass = masses_in(part);
      ASSERT_EQ(part.export_start.back(), part.exports.size());
      for (std::uint32_t tile = 0; tile < part.own_tiles(); ++tile)
        for (std::uint32_t i = part.export_start[tile]; i < part.export_start[tile + 1]; ++i) {
          const Export& e = part.exports[i];
          EXPECT_EQ(e.from / lanes, tile);
          EXPECT_NE(e.part, p);
          EXPECT_TRUE(filled.try_emplace({e.part, e.to}, mass[e.from]).second);
        }
    }
    std::size_t ghosts = 0;
    for (std::uint32_t p = 0; p < body.parts.size(); ++p)
      for (std::size_t i = body.parts[p].own; i < body.parts[p].masses.size(); ++i, ++ghosts) {
        const auto found = filled.find({p, body.parts[p].arrangement.order->slots[i]});
        ASSERT_NE(found, filled.end());
        EXPECT_EQ(found->second, body.parts[p].masses[i]);
      }
    EXPECT_EQ(filled.size(), ghosts);
    EXPECT_GT(ghosts, 0u);
  }
}

// Each cut of a box crosses one layer of masses on each side, and a part of a cube of 11 voxels has at most three cuts.
TEST(Parts, HaveFewGhosts) {
  const SplitRobot halves(bodies::random_voxels({.x = 19, .y = 9, .z = 9}, 1), 2);
  for (const Part& part : halves.parts) EXPECT_EQ(part.masses.size() - part.own, 100u);
}

}  // namespace
}  // namespace mercury::cuda
