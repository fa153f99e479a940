// SPDX-License-Identifier: Apache-2.0
#include "sim/cuda/parts.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "mercury/parallel.h"
#include "sim/physics/face_pairs.h"
#include "sim/physics/fixed_point.h"

namespace mercury::cuda {
namespace {

// Cuts masses at the median across their longest side, until there are `parts`.
void bisect(const Robot& robot, std::span<std::uint16_t> masses, std::uint32_t first_part, std::uint32_t parts,
            std::vector<std::uint8_t>& part_of) {
  if (parts == 1) {
    for (const std::uint16_t mass : masses) part_of[mass] = static_cast<std::uint8_t>(first_part);
    return;
  }
  const auto range = [&](float Vec3::*axis) {
    const auto [low, high] =
        std::ranges::minmax(masses, {}, [&](std::uint16_t mass) { return robot.masses[mass].*axis; });
    return robot.masses[high].*axis - robot.masses[low].*axis;
  };
  float Vec3::*longest = &Vec3::x;
  for (float Vec3::*axis : {&Vec3::y, &Vec3::z})
    if (range(axis) > range(longest)) longest = axis;
  const std::uint32_t before = parts / 2;
  const auto cut = masses.begin() + static_cast<std::ptrdiff_t>(masses.size() * before / parts);
  std::ranges::nth_element(masses, cut, {},
                           [&](std::uint16_t mass) { return std::pair(robot.masses[mass].*longest, mass); });
  bisect(robot, {masses.begin(), cut}, first_part, before, part_of);
  bisect(robot, {cut, masses.end()}, first_part + before, parts - before, part_of);
}

// The same for all vertex orders of a pair.
auto key_of(const FacePair& p) {
  return std::tuple(std::min(p.a, p.c), std::max(p.a, p.c), std::min(p.b, p.d), std::max(p.b, p.d));
}

class Splitter {
 public:
  Splitter(const Robot& robot, const SlotOrder& order, std::uint32_t parts)
      : robot_(robot), parts_(parts), part_of_(robot.masses.size()), slot_in_part_(robot.masses.size()),
        parts_of_robot_(parts) {
    std::vector<std::uint16_t> masses(robot.masses.size());
    std::iota(masses.begin(), masses.end(), std::uint16_t{0});
    bisect(robot, masses, 0, parts, part_of_);
    pairs_ = make_face_tiles(order.placed(pair_faces(robot)));
    const std::vector<std::uint16_t> mass_in = order.masses();
    for (FacePair& p : pairs_)
      if (p != padding_faces) p = {mass_in[p.a], mass_in[p.b], mass_in[p.c], mass_in[p.d]};
    parallel_for(0, parts, [&](std::size_t part) { add_part(static_cast<std::uint32_t>(part)); });
    add_exports();
  }

  std::vector<Part> take() { return std::move(parts_of_robot_); }

 private:
  void add_part(std::uint32_t part) {
    Part& made = parts_of_robot_[part];
    constexpr std::uint16_t absent = 0xffff;
    std::vector<std::uint16_t> number(robot_.masses.size(), absent);  // in the part
    const auto take_in = [&](std::uint16_t mass) {
      if (number[mass] != absent) return;
      number[mass] = static_cast<std::uint16_t>(made.masses.size());
      made.masses.push_back(mass);
    };
    const auto is_own = [&](std::uint16_t mass) { return part_of_[mass] == part; };
    for (std::uint32_t mass = 0; mass < robot_.masses.size(); ++mass)
      if (is_own(static_cast<std::uint16_t>(mass))) take_in(static_cast<std::uint16_t>(mass));
    made.own = static_cast<std::uint32_t>(made.masses.size());
    Robot body;
    for (std::uint32_t i = 0; i < robot_.springs.size(); ++i) {
      Spring spring = robot_.springs[i];
      if (!is_own(spring.a) && !is_own(spring.b)) continue;
      if (!is_own(spring.a)) std::swap(spring.a, spring.b);
      take_in(spring.b);
      spring.a = number[spring.a], spring.b = number[spring.b];
      body.springs.push_back(spring);
      made.springs.push_back(i);
    }
    std::vector<FacePair> pairs;
    std::vector<std::uint32_t> pair_numbers;
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
      const FacePair& p = pairs_[i];
      if (p == padding_faces || !(is_own(p.a) || is_own(p.b) || is_own(p.c) || is_own(p.d))) continue;
      for (const std::uint16_t corner : {p.a, p.b, p.c, p.d}) take_in(corner);
      pairs.push_back({number[p.a], number[p.b], number[p.c], number[p.d]});
      pair_numbers.push_back(i);
    }
    for (const std::uint16_t mass : made.masses) body.masses.push_back(robot_.masses[mass]);
    made.arrangement = arrange(body, pairs, static_cast<std::uint32_t>(made.masses.size()) - made.own);
    number_faces(made, pairs, pair_numbers);
    const SlotOrder& order = *made.arrangement.order;
    for (std::uint32_t i = 0; i < made.own; ++i) slot_in_part_[made.masses[i]] = order.slots[i];
  }

  // `pairs` with the masses of the part, and their numbers among the robot's.
  static void number_faces(Part& part, std::span<const FacePair> pairs, std::span<const std::uint32_t> numbers) {
    const std::vector<std::uint16_t>& slots = part.arrangement.order->slots;
    struct Numbered {
      std::uint32_t number;
      FacePair pair;
    };
    std::multimap<decltype(key_of({})), Numbered> by_key;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const FacePair in_slots{slots[pairs[i].a], slots[pairs[i].b], slots[pairs[i].c], slots[pairs[i].d]};
      by_key.insert({key_of(in_slots), {numbers[i], in_slots}});
    }
    for (FacePair& p : part.arrangement.faces) {
      const auto found = p == padding_faces ? by_key.end() : by_key.find(key_of(p));
      if (found == by_key.end()) {
        part.face_dithers.push_back(0);
        continue;
      }
      const auto [number, pair] = found->second;
      by_key.erase(found);
      // All parts must see a face from the same side: flow exactly along it lifts it to that side.
      p.a = pair.a, p.c = pair.c;
      part.face_dithers.push_back(dither_of_pair(number) + (p.b == pair.b ? 0 : second_face_dither));
    }
  }

  void add_exports() {
    std::vector<std::vector<Export>> exports(parts_);
    for (std::uint32_t part = 0; part < parts_; ++part) {
      const Part& importer = parts_of_robot_[part];
      for (std::size_t ghost = importer.own; ghost < importer.masses.size(); ++ghost) {
        const std::uint16_t mass = importer.masses[ghost];
        exports[part_of_[mass]].push_back({slot_in_part_[mass], importer.arrangement.order->slots[ghost], part});
      }
    }
    for (std::uint32_t part = 0; part < parts_; ++part) {
      Part& exporter = parts_of_robot_[part];
      exporter.exports = std::move(exports[part]);
      std::ranges::sort(exporter.exports, {}, [](const Export& e) { return std::tuple(e.from / lanes, e.part, e.to); });
      exporter.export_start.assign(exporter.own_tiles() + 1, 0);
      for (const Export& e : exporter.exports) ++exporter.export_start[e.from / lanes + 1];
      std::partial_sum(exporter.export_start.begin(), exporter.export_start.end(), exporter.export_start.begin());
    }
  }

  const Robot& robot_;
  std::uint32_t parts_;
  std::vector<std::uint8_t> part_of_;        // [mass]
  std::vector<std::uint16_t> slot_in_part_;  // [mass], where its own part has it
  std::vector<FacePair> pairs_;              // of masses, in the order of the whole robot's face tiles
  std::vector<Part> parts_of_robot_;
};

}  // namespace

std::vector<Part> split(const Robot& robot, const SlotOrder& order, std::uint32_t parts) {
  return Splitter(robot, order, parts).take();
}

}  // namespace mercury::cuda
