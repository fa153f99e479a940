// SPDX-License-Identifier: Apache-2.0
#include "mercury/tapered.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "mercury/voxels.h"
#include "robots/genome_table.h"
#include "robots/portable_math.h"
#include "robots/tapered/tapered.h"

namespace mercury {
namespace {

constexpr MaterialId passive = 1;        // tissue; muscles follow
constexpr float muscle_stiffness = 900;  // of a body as in the paper [N/m], as in shells
// A spring at an angle to the body follows those along it.
constexpr double at_an_angle = 0.6;

// A curve through values at places, without hills of its own (F. N. Fritsch and J. Butland, 1984).
template <std::size_t n>
double curve(double at, const std::array<double, n>& places, const std::array<double, n>& values) {
  std::array<double, n> slope{};
  const auto rise = [&](std::size_t i) { return (values[i + 1] - values[i]) / (places[i + 1] - places[i]); };
  slope[0] = rise(0);
  slope[n - 1] = rise(n - 2);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = rise(i - 1), after = rise(i);
    if (before * after > 0) slope[i] = 2 * before * after / (before + after);
  }
  std::size_t i = 0;
  while (i + 2 < n && at >= places[i + 1]) ++i;
  const double step = places[i + 1] - places[i], t = (at - places[i]) / step;
  const double start = values[i] * (1 + 2 * t) + slope[i] * step * t,
               end = values[i + 1] * (3 - 2 * t) - slope[i + 1] * step * (1 - t);
  return start * (1 - t) * (1 - t) + end * t * t;
}

// The lattice of masses: stations from the tail to the nose, two skins, layers from edge to edge.
struct Lattice {
  int stations, layers;
  explicit Lattice(const TaperedGenome& genome) : stations(genome.stations), layers(genome.layers) {}
  std::uint16_t point(int station, int skin, int layer) const {
    return static_cast<std::uint16_t>((station * 2 + skin) * (layers + 1) + layer);
  }
  std::vector<Hexahedron> cells() const {
    std::vector<Hexahedron> cells;
    for (int station = 0; station < stations; ++station)
      for (int layer = 0; layer < layers; ++layer) {
        Hexahedron cell{};
        for (int corner = 0; corner < 8; ++corner)
          cell[static_cast<std::size_t>(corner)] =
              point(station + (corner & 1), corner >> 1 & 1, layer + (corner >> 2 & 1));
        cells.push_back(cell);
      }
    return cells;
  }
};

class Builder {
 public:
  explicit Builder(const TaperedGenome& genome) : g_(genome), lattice_(genome) {}

  Robot build() {
    add_points();
    add_materials();
    add_springs();
    add_skin();
    return std::move(robot_);
  }

 private:
  double behind(double station) const { return 1 - station / g_.stations; }

  void add_points() {
    struct Point {
      double x, y, z;
    };
    std::vector<Point> points;  // of a body of length 1
    for (int station = 0; station <= g_.stations; ++station) {
      const double at = behind(station), depth = curve(at, TaperedGenome::depth_places, g_.depths);
      for (const int side : {-1, 1})
        for (int layer = 0; layer <= g_.layers; ++layer) {
          const double height = 2.0 * layer / g_.layers - 1;
          points.push_back(
              {1 - at - 0.5, side * depth * g_.width / 2 * (1 - (1 - g_.edge) * height * height), depth / 2 * height});
        }
    }
    const auto corner = [&](int station, int layer) { return points[lattice_.point(station, 1, layer)]; };
    double volume = 0;
    for (int station = 0; station < g_.stations; ++station)
      for (int layer = 0; layer < g_.layers; ++layer) {
        const Point a = corner(station, layer), b = corner(station + 1, layer), c = corner(station, layer + 1),
                    d = corner(station + 1, layer + 1);
        volume += (b.x - a.x) * (a.y + b.y + c.y + d.y) / 2 * (c.z - a.z + d.z - b.z) / 2;
      }
    const double length = portable_exp(portable_log(g_.volume * 1e-3 / volume) / 3);
    for (const auto& [x, y, z] : points) {
      const auto scaled = [&](double value) { return static_cast<float>(value * length); };
      robot_.masses.push_back(g_.bending == TaperedBending::sideways ? Vec3{scaled(x), scaled(y), scaled(z)}
                                                                     : Vec3{scaled(x), scaled(-z), scaled(y)});
    }
  }

  void add_materials() {
    const auto add = [&](std::string name, double amplitude, double turns) {
      const auto frequency = static_cast<float>(g_.frequency * 2 * std::numbers::pi);
      const auto phase = static_cast<float>((turns - std::floor(turns)) * 2 * std::numbers::pi);
      Material material{.stiffness = muscle_stiffness};
      if (name.starts_with("muscle")) {
        material.amplitude = static_cast<float>(amplitude);
        material.frequency = frequency;
        material.phase = phase;
      }
      robot_.materials.push_back(material);
      robot_.material_names.push_back(std::move(name));
    };
    robot_.materials.emplace_back();
    robot_.material_names.emplace_back("air");
    add("tissue", 0, 0);
    for (int segment = 0; segment < g_.segments; ++segment) {
      const double at = (segment + 0.5) / g_.segments,
                   amplitude = curve(at, TaperedGenome::contraction_places, g_.contractions);
      for (const double side : {-1, 1})
        for (const bool along : {true, false})
          add("muscle " + std::to_string(segment + 1) + (side < 0 ? "a" : "b") + (along ? "" : ", at an angle"),
              side * amplitude * (along ? 1 : at_an_angle), -g_.waves * at);
    }
  }

  // Of the spring between two stations on one skin. The cells at both ends have none.
  MaterialId muscle(double station, int skin, bool along) const {
    if (station < 1 || station > g_.stations - 1) return passive;
    const int segment = std::min(g_.segments - 1, static_cast<int>(behind(station) * g_.segments));
    return static_cast<MaterialId>(passive + 1 + segment * 4 + skin * 2 + (along ? 0 : 1));
  }

  void add_springs() {
    std::map<std::uint32_t, MaterialId> springs;
    const auto station_of = [&](std::uint16_t point) { return point / (2 * (g_.layers + 1)); };
    const auto skin_of = [&](std::uint16_t point) { return point / (g_.layers + 1) % 2; };
    for (const Hexahedron& cell : lattice_.cells())
      for_each_pair_of_corners([&](std::size_t i, std::size_t j) {
        const std::uint16_t a = cell[i], b = cell[j];
        const bool moves = station_of(a) != station_of(b) && skin_of(a) == skin_of(b);
        springs[pair_of(a, b)] =
            moves ? muscle((station_of(a) + station_of(b)) / 2.0, skin_of(a), (i ^ j) == 1) : passive;
      });
    for (const auto& [pair, material] : springs) {
      const auto a = static_cast<std::uint16_t>(pair >> 16), b = static_cast<std::uint16_t>(pair & 0xffff);
      robot_.springs.push_back({a, b, material, rest_distance(robot_, a, b)});
    }
  }

  void add_side(std::array<std::uint16_t, 4> corners) {
    const auto [a, b, c, d] = corners;
    // Across the shorter way.
    if (rest_distance(robot_, b, d) < rest_distance(robot_, a, c) - 1e-6f) {
      robot_.faces.push_back({a, b, d});
      robot_.faces.push_back({b, c, d});
    } else {
      robot_.faces.push_back({a, b, c});
      robot_.faces.push_back({a, c, d});
    }
  }

  void add_skin() {
    const auto p = [&](int station, int skin, int layer) { return lattice_.point(station, skin, layer); };
    const int n = g_.stations, top = g_.layers;
    for (int s = 0; s < n; ++s) {
      for (int l = 0; l < top; ++l) {
        add_side({p(s, 1, l), p(s, 1, l + 1), p(s + 1, 1, l + 1), p(s + 1, 1, l)});
        add_side({p(s, 0, l), p(s + 1, 0, l), p(s + 1, 0, l + 1), p(s, 0, l + 1)});
      }
      add_side({p(s, 0, top), p(s + 1, 0, top), p(s + 1, 1, top), p(s, 1, top)});
      add_side({p(s, 0, 0), p(s, 1, 0), p(s + 1, 1, 0), p(s + 1, 0, 0)});
    }
    for (int l = 0; l < top; ++l) {
      add_side({p(n, 0, l), p(n, 1, l), p(n, 1, l + 1), p(n, 0, l + 1)});
      add_side({p(0, 0, l), p(0, 0, l + 1), p(0, 1, l + 1), p(0, 1, l)});
    }
  }

  const TaperedGenome& g_;
  Lattice lattice_;
  Robot robot_;
};

TaperedGenome genome_of(const Robot& robot) {
  std::optional<TaperedGenome> genome = tapered_genome_of(robot);
  if (!genome) throw InputError("/origin", "holds no tapered robot");
  return *std::move(genome);
}

}  // namespace

void validate(const TaperedGenome& genome) { check_each(tapered_genome_table(), genome); }

Robot grow(const TaperedGenome& genome, const std::string& name) {
  validate(genome);
  Robot robot = Builder(genome).build();
  robot.name = name;
  robot.origin = origin_of("tapered", tapered_genome_table(), genome);
  return robot;
}

std::optional<TaperedGenome> tapered_genome_of(const Robot& robot) {
  if (kind_of(robot) != "tapered") return std::nullopt;
  return genome_in(robot, tapered_genome_table());
}

std::vector<Hexahedron> tapered_cells(const Robot& robot) { return Lattice(genome_of(robot)).cells(); }

}  // namespace mercury
