// SPDX-License-Identifier: Apache-2.0
// Bodies of imported robots on land, with springs of their own for each voxel: they bend as well as stretch like the
// beams of VoxCAD, and stand on the middles of voxels, as there.
//
//      o---e---o        Corners have springs along edges (e) and across sides. The middle M of a voxel has springs to
//      | b   b |        its corners (b) and to the middles beside it (c), which run along the axis of a limb: they
//      |   M   |        stretch with it and do not resist its bending. Half of a voxel's mass is in its middle.
//      | b | b |
//      o---c---o        A voxel with none below stands on its middle: there the floor lifts and rubs a voxel in its
//        b | b          middle, without a moment. Lower corners that only such voxels have are left out, and what is
//          M            left of the voxel changes its length by 4/3 of its amplitude, as much as half a voxel more.
//     ----------- floor
//
// Springs that resist bending have half of the relaxation time, as the moments of beams have, those of the axis have
// 3/2 of it. There, damping resists what differs from the muscle's own movement; here, it resists all. A muscle that
// leads by tau dL/dt gives the same force. docs/formats.md derives the numbers.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "mercury/error.h"
#include "robots/importers/calibration.h"
#include "robots/importers/voxel_body.h"

namespace mercury {
namespace {

using Place = std::array<int, 3>;

constexpr auto edge = static_cast<float>(imported_edge);
constexpr double mass_of_middle = 0.5;  // [kg] of the voxel's 1 kg

// What a voxel adds, in stiffnesses of its beam. Stretch and bending of bars of 4 and 8 voxels, 1 to 3 voxels thick,
// clamped at one end, are those of frames of beams within a fifth; torsion gives the springs across sides.
struct Kind {
  double share;            // of the beam's stiffness
  double relaxation_time;  // as a share
};
constexpr Kind along_edge{1.0 / 16, 0.5}, across_side{1.0 / 15, 0.5}, to_corner{13.0 / 20, 1}, to_middle{7.0 / 10, 1.5};
// Of a voxel that stands on its middle, between 3/2, which half a voxel needs to be as stiff upward, and 3/4 in shear.
constexpr double to_corner_of_foot = 1.06, amplitude_of_foot = 4.0 / 3;

constexpr std::array<Place, 8> corners{
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}};

Place operator+(Place a, Place b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

class Builder {
 public:
  explicit Builder(const VoxelBody& body) : body_(body) {}

  Robot build(const std::string& name, double relaxation_time, std::size_t most_materials, Rounding& rounding) {
    number_masses();
    for_each_voxel([&](Place at) { add_springs(at); });
    Robot robot = bare_robot(body_, name);
    robot.faces = faces(robot);
    set_masses(robot);
    robot.springs.clear();
    std::vector<Substance> substances;
    std::vector<std::string> names;
    for (const auto& [ends, spring] : springs_) {
      const Vec3 &a = robot.masses[ends.first], &b = robot.masses[ends.second];
      robot.springs.push_back({.a = ends.first,
                               .b = ends.second,
                               .rest_length = static_cast<float>(std::hypot(b.x - a.x, b.y - a.y, b.z - a.z))});
      substances.push_back(substance(spring, relaxation_time));
      names.push_back(names_of(spring));
    }
    set_substances(robot, substances, names, most_materials, rounding);
    return robot;
  }

 private:
  struct Part {
    std::size_t cell;
    double share, amplitude;
  };
  struct Parts {
    std::vector<Part> of_voxels;
    double relaxation_time = 1;
  };

  bool has(Place at) const {
    return at[0] >= 0 && at[1] >= 0 && at[2] >= 0 && at[0] < body_.nx && at[1] < body_.ny && at[2] < body_.nz &&
           body_.cells[body_.index(at[0], at[1], at[2])] != 0;
  }
  bool stands(Place at) const { return !has(at + Place{0, 0, -1}); }

  template <class Visit>
  void for_each_voxel(const Visit& visit) const {
    for (int z = 0; z < body_.nz; ++z)
      for (int y = 0; y < body_.ny; ++y)
        for (int x = 0; x < body_.nx; ++x)
          if (const Place at{x, y, z}; has(at)) visit(at);
  }

  // Corners that some voxel does not leave out come first.
  void number_masses() {
    std::set<std::pair<std::array<int, 3>, Place>> kept;  // by z, y, x
    for_each_voxel([&](Place at) {
      for (const Place& corner : corners)
        if (const Place place = at + corner; corner[2] == 1 || !stands(at))
          kept.insert({{place[2], place[1], place[0]}, place});
    });
    std::size_t count = 0;
    const auto number = [&](std::map<Place, std::uint16_t>& masses, Place place) {
      if (count < max_masses) masses.emplace(place, static_cast<std::uint16_t>(count));
      ++count;
    };
    for (const auto& [order, place] : kept) number(corner_, place);
    for_each_voxel([&](Place at) { number(middle_, at); });
    if (count > max_masses)
      throw InputError(fmt::format("the body has {} masses, at most {} are accepted", count, max_masses));
  }

  void add(std::uint16_t a, std::uint16_t b, Place voxel, const Kind& kind, double share, double amplitude = 1) {
    Parts& parts = springs_[std::minmax(a, b)];
    parts.relaxation_time = kind.relaxation_time;
    parts.of_voxels.push_back({body_.index(voxel[0], voxel[1], voxel[2]), share, amplitude});
  }

  void add_springs(Place at) {
    const std::uint16_t middle = middle_.at(at);
    std::vector<std::pair<Place, std::uint16_t>> present;
    for (const Place& corner : corners)
      if (const auto mass = corner_.find(at + corner); mass != corner_.end())
        present.emplace_back(corner, mass->second);
    const bool is_foot = present.size() < corners.size();
    for (std::size_t i = 0; i < present.size(); ++i) {
      add(middle, present[i].second, at, to_corner, is_foot ? to_corner_of_foot : to_corner.share,
          is_foot ? amplitude_of_foot : 1);
      for (std::size_t j = i + 1; j < present.size(); ++j) {
        int axes = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) axes += present[i].first[axis] != present[j].first[axis];
        if (axes == 3) continue;
        const Kind& kind = axes == 1 ? along_edge : across_side;
        add(present[i].second, present[j].second, at, kind, kind.share);
      }
    }
    // Half of a spring between two middles is of either voxel. Between feet it has the two lower edges, too.
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Place beside = at;
        beside[axis] += step;
        if (!has(beside)) continue;
        const bool both_stand = is_foot && axis < 2 && stands(beside);
        add(middle, middle_.at(beside), at, to_middle, to_middle.share / 2 + (both_stand ? along_edge.share : 0));
      }
    if (!is_foot) return;
    for (const Place& step : {Place{-1, -1, 0}, Place{1, -1, 0}, Place{-1, 1, 0}, Place{1, 1, 0}})
      if (const Place beside = at + step; has(beside) && stands(beside))
        add(middle, middle_.at(beside), at, to_middle, across_side.share / 2);
  }

  Substance substance(const Parts& spring, double relaxation_time) const {
    std::vector<Substance> shared;
    std::vector<double> stiffnesses;
    double sum = 0;
    for (const Part& part : spring.of_voxels) {
      shared.push_back(body_.substances[body_.cells[part.cell] - 1]);
      shared.back().amplitude =
          std::clamp(part.amplitude * shared.back().amplitude, -largest_amplitude, largest_amplitude);
      stiffnesses.push_back(part.share * shared.back().stiffness);
      sum += stiffnesses.back();
    }
    Substance mean = mean_substance(shared, stiffnesses);
    mean.stiffness = slice_stiffness(BeamModel{}.thickness) * sum;
    mean.relaxation_time = spring.relaxation_time * relaxation_time;
    // L + tau dL/dt; half of a wave has no such form.
    if (const double lead = mean.frequency * mean.relaxation_time; !mean.half_wave) {
      mean.amplitude = std::clamp(mean.amplitude * std::hypot(1.0, lead), -largest_amplitude, largest_amplitude);
      mean.phase += std::atan(lead);
    }
    return mean;
  }

  std::string names_of(const Parts& spring) const {
    std::set<std::string> names;
    for (const Part& part : spring.of_voxels) names.insert(body_.names[body_.cells[part.cell] - 1]);
    return fmt::format("{}", fmt::join(names, " + "));
  }

  // The mass at a corner, or instead of one that is left out the middle of a voxel that leaves it out.
  std::uint16_t mass_at(Place corner) const {
    if (const auto mass = corner_.find(corner); mass != corner_.end()) return mass->second;
    for (const Place& step : corners) {
      const Place voxel{corner[0] - 1 + step[0], corner[1] - 1 + step[1], corner[2]};
      if (step[2] == 0 && has(voxel)) return middle_.at(voxel);
    }
    return 0;
  }

  // `bare` has a mass at each corner.
  std::vector<Face> faces(const Robot& bare) const {
    const SpringVoxels lattice(bare, body_);
    std::vector<Face> kept;
    for (const Face& face : bare.faces) {
      const Face moved{mass_at(lattice.corner(face.a)), mass_at(lattice.corner(face.b)),
                       mass_at(lattice.corner(face.c))};
      if (moved.a != moved.b && moved.b != moved.c && moved.c != moved.a) kept.push_back(moved);
    }
    return kept;
  }

  void set_masses(Robot& robot) const {
    robot.masses.assign(corner_.size() + middle_.size(), Vec3{});
    robot.mass.assign(robot.masses.size(), 0);
    const auto put = [&](std::uint16_t mass, Place place, double offset) {
      const auto along = [&](std::size_t axis, int size) {
        return static_cast<float>((place[axis] + offset - size / 2.0) * imported_edge);
      };
      robot.masses[mass] = {along(0, body_.nx), along(1, body_.ny), along(2, body_.nz)};
    };
    for (const auto& [place, mass] : corner_) put(mass, place, 0);
    for (const auto& [place, mass] : middle_) {
      put(mass, place, 0.5);
      robot.mass[mass] += static_cast<float>(mass_of_middle);
      for (const Place& corner : corners) {
        const auto found = corner_.find(place + corner);
        robot.mass[found == corner_.end() ? mass : found->second] += static_cast<float>((1 - mass_of_middle) / 8);
      }
    }
  }

  const VoxelBody& body_;
  std::map<Place, std::uint16_t> corner_, middle_;
  std::map<std::pair<std::uint16_t, std::uint16_t>, Parts> springs_;
};

}  // namespace

Robot standing_body(const VoxelBody& body, const std::string& name, double relaxation_time, std::size_t most_materials,
                    Rounding& rounding) {
  return Builder(body).build(name, relaxation_time, most_materials, rounding);
}

}  // namespace mercury
