// SPDX-License-Identifier: Apache-2.0
#include "mercury/shell.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "mercury/error.h"
#include "mercury/origin.h"
#include "robots/genome_table.h"
#include "robots/portable_math.h"
#include "robots/shell/revolved_mesh.h"
#include "robots/shell/shell_genome.h"

namespace mercury {
namespace {

// A ring's profile ends where it begins: what goes once around it is a whole number.
double once_around(const ShellGenome& genome, double count) {
  return genome.form == ShellForm::ring ? std::round(count) : count;
}

// 1 at the middle of a lobe, -1 between two. `s` along the profile, 0 to 1; `turns` around the axis.
double lobe_wave(const ShellGenome& genome, double s, double turns) {
  return wave(genome.lobes * turns + once_around(genome, genome.twist * genome.lobes) * s).cosine;
}

// The surface of a shell, in units of half the diameter.
class Surface {
 public:
  explicit Surface(const ShellGenome& genome) : g_(genome) {
    for (int i = 0; i <= samples; ++i) widest_ = std::max(widest_, raw_profile(fraction(i)).r);
  }

  using Profile = RevolvedSurface::Profile;
  Profile profile(double s) const {
    const Profile raw = raw_profile(s);
    return {raw.r / widest_, raw.z / widest_};
  }
  Point at(double s, double turns) const {
    const Profile p = profile(s);
    const double lobe = lobe_wave(g_, s, turns);
    const double r = p.r * (1 + g_.lobe_depth * lobe_weight(s) * lobe);
    const double hang = is_bell() ? s * s * s * s : is_tube() ? (2 * s - 1) * (2 * s - 1) * (2 * s - 1) : 0;
    const auto [sine, cosine] = wave(turns);
    return {r * cosine, r * sine, p.z - g_.lappets * hang * lobe};
  }

 private:
  static constexpr int samples = 512;
  static double fraction(int i) { return static_cast<double>(i) / samples; }
  bool is_bell() const { return g_.form == ShellForm::bell; }
  bool is_tube() const { return g_.form == ShellForm::tube; }

  // Lobes grow from a pole, where the surface must stay smooth.
  double lobe_weight(double s) const {
    if (is_bell()) return s * s * (3 - 2 * s);
    if (g_.form == ShellForm::pod) return 16 * s * s * (1 - s) * (1 - s);
    return 1;
  }

  Profile raw_profile(double s) const {
    switch (g_.form) {
      case ShellForm::bell: {
        const double angle = (0.44 - 0.2 * g_.opening) * s;
        const auto [sine, cosine] = wave(angle);
        const double s2 = s * s;
        return {sine + g_.squareness * wave(3 * angle).sine + g_.flare * s2 * s2 * s2, g_.height * cosine};
      }
      case ShellForm::tube: {
        const double end = 0.35 + 0.6 * g_.opening, middle = wave(s / 2).sine, from_middle = 2 * s - 1;
        return {end + (1 - end) * middle + g_.squareness * wave(1.5 * s).sine +
                    g_.flare * from_middle * from_middle * from_middle * from_middle,
                -g_.height * from_middle};
      }
      case ShellForm::ring: {
        const double tube = 0.42 - 0.22 * g_.opening;
        const auto [sine, cosine] = wave(s);
        return {1 - tube + tube * cosine, -tube * (0.5 + g_.height) * sine};
      }
      case ShellForm::pod:
        break;
    }
    const double angle = s / 2;
    return {wave(angle).sine + g_.squareness * wave(3 * angle).sine, g_.height * wave(angle).cosine};
  }

  const ShellGenome& g_;
  double widest_ = 0;
};

// In units of half the diameter. The genome must be valid, and outlive the mesh.
RevolvedMesh mesh_of(const ShellGenome& genome) {
  const Surface surface(genome);
  const bool is_pod = genome.form == ShellForm::pod;
  return RevolvedMesh({.profile = [&](double s) { return surface.profile(s); },
                       .point = [&](double s, double turns) { return surface.at(s, turns); },
                       .lobes = genome.lobes,
                       .closed = genome.form == ShellForm::ring,
                       .starts_on_axis = is_pod || genome.form == ShellForm::bell,
                       .ends_on_axis = is_pod},
                      2 * std::numbers::pi / genome.segments);
}

// The materials of one robot: tissue, struts, and muscles of a few amplitudes and phases.
class Materials {
 public:
  static constexpr MaterialId tissue = 1, strut = 2;

  explicit Materials(const ShellGenome& genome)
      : frequency_(static_cast<float>(genome.frequency)),
        largest_(std::max(std::abs(genome.contraction), std::abs(genome.bending))) {
    add("air", {});
    add("tissue", {.stiffness = 250});
    add("strut", {.stiffness = 400});
  }

  // `phase` in turns.
  MaterialId muscle(double amplitude, double phase) {
    if (largest_ == 0) return tissue;
    int level = static_cast<int>(std::round(levels * amplitude / largest_));
    if (level == 0) level = amplitude < 0 ? -1 : 1;
    const int step = static_cast<int>(std::round(phases * (phase - std::floor(phase)))) % phases;
    const auto [found, is_new] = muscles_.try_emplace({level, step}, static_cast<MaterialId>(table.size()));
    if (is_new)
      add("muscle " + std::to_string(table.size() - strut),
          {.stiffness = 900,
           .amplitude = static_cast<float>(largest_ * level / levels),
           .frequency = frequency_,
           .phase = static_cast<float>(2 * std::numbers::pi * step / phases)});
    return found->second;
  }

  std::vector<Material> table;
  std::vector<std::string> names;

 private:
  static constexpr int levels = 4, phases = 30;  // 2 x 4 x 30 muscles at most
  void add(std::string name, const Material& material) {
    table.push_back(material);
    names.push_back(std::move(name));
  }

  float frequency_;
  double largest_;
  std::map<std::pair<int, int>, MaterialId> muscles_;
};

// Turns a mesh into a robot of two layers.
class Builder {
 public:
  Builder(const ShellGenome& genome, const RevolvedMesh& mesh) : g_(genome), mesh_(mesh), materials_(genome) {
    const double radius = genome.diameter / 2, half = genome.thickness / 2;
    for (const RevolvedMesh::Vertex& vertex : mesh.vertices())
      for (const double side : {half, -half}) {
        const Point p = radius * vertex.point + side * vertex.normal;
        robot_.masses.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
      }
  }

  Robot build() && {
    for (std::size_t i = 0; i < mesh_.vertices().size(); ++i) join(outer(i), inner(i), Materials::strut);
    const std::vector<bool> active = active_edges();
    for (std::size_t i = 0; i < active.size(); ++i) {
      const auto [a, b] = mesh_.edges()[i];
      join(outer(a), outer(b), active[i] ? muscle(a, b, 1) : Materials::tissue);
      join(inner(a), inner(b), active[i] ? muscle(a, b, -1) : Materials::tissue);
      join(outer(a), inner(b), Materials::tissue);
      join(inner(a), outer(b), Materials::tissue);
    }
    add_skin();
    robot_.materials = std::move(materials_.table);
    robot_.material_names = std::move(materials_.names);
    return std::move(robot_);
  }

 private:
  static std::uint16_t outer(std::size_t vertex) { return static_cast<std::uint16_t>(2 * vertex); }
  static std::uint16_t inner(std::size_t vertex) { return static_cast<std::uint16_t>(2 * vertex + 1); }

  void join(std::uint16_t a, std::uint16_t b, MaterialId material) {
    robot_.springs.push_back({a, b, material, length(robot_.masses[a] - robot_.masses[b])});
  }

  // The share `active` of the edges: at a bell's rim, elsewhere in stripes along the lobes.
  std::vector<bool> active_edges() const {
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < mesh_.edges().size(); ++i) {
      double sum = 0;
      for (const std::size_t end : {mesh_.edges()[i].a, mesh_.edges()[i].b}) {
        const RevolvedMesh::Vertex& v = mesh_.vertices()[end];
        const double lobe = lobe_wave(g_, v.s, v.turns);
        sum += g_.form == ShellForm::bell ? v.s * (1 + 0.2 * lobe) : lobe;
      }
      order.emplace_back(-std::round(1e6 * sum), i);  // equal ones in the order of the mesh, whatever the rounding
    }
    std::ranges::sort(order);
    std::vector<bool> active(order.size(), false);
    const auto count = static_cast<std::size_t>(std::round(g_.active * static_cast<double>(order.size())));
    for (std::size_t i = 0; i < count; ++i) active[order[i].second] = true;
    return active;
  }

  // Around the axis an edge contracts the shell, along the profile it bends it; others do some of both.
  MaterialId muscle(std::size_t a, std::size_t b, int side) {
    const RevolvedMesh::Vertex &v = mesh_.vertices()[a], &w = mesh_.vertices()[b];
    const double step = w.turns - v.turns - std::round(w.turns - v.turns), middle = v.turns + step / 2;
    const double radius = std::sqrt(v.point.x * v.point.x + v.point.y * v.point.y);
    double along = w.s - v.s;
    if (g_.form == ShellForm::ring) along -= std::round(along);
    const double s = v.s + along / 2;
    along *= mesh_.profile_length();
    const double around = 2 * std::numbers::pi * radius * step;
    const double share = along * along / (along * along + around * around);
    const double phase = once_around(g_, g_.waves_along) * s + g_.waves_around * middle;
    return materials_.muscle((1 - share) * g_.contraction + side * share * g_.bending, phase);
  }

  void add_skin() {
    const bool hollow = g_.form == ShellForm::ring || g_.form == ShellForm::pod;
    for (const auto& [a, b, c] : mesh_.triangles()) {
      robot_.faces.push_back({outer(a), outer(b), outer(c)});
      if (!hollow) robot_.faces.push_back({inner(a), inner(c), inner(b)});
    }
    for (const auto& [a, b] : mesh_.rim()) {
      robot_.faces.push_back({outer(b), outer(a), inner(a)});
      robot_.faces.push_back({outer(b), inner(a), inner(b)});
    }
  }

  const ShellGenome& g_;
  const RevolvedMesh& mesh_;
  Materials materials_;
  Robot robot_;
};

// Turns a mesh into a robot of two layers, without name and origin. It has at most max_masses / 2 vertices.
Robot shell_body(const ShellGenome& genome, const RevolvedMesh& mesh) { return Builder(genome, mesh).build(); }

}  // namespace

void check_shell_thickness(double thickness, double diameter) {
  if (thickness > diameter / 4)
    throw ParameterError("thickness", "more than a quarter of the diameter is not accepted; give less");
}

void validate(const ShellGenome& genome) {
  check_each(shell_genome_table(), genome);
  check_shell_thickness(genome.thickness, genome.diameter);
}

Robot grow(const ShellGenome& genome, const std::string& name) {
  validate(genome);
  const RevolvedMesh mesh = mesh_of(genome);
  if (2 * mesh.vertices().size() > max_masses)
    throw ParameterError("segments",
                         "the shell would have more than " + std::to_string(max_masses) + " masses; give fewer");
  Robot robot = shell_body(genome, mesh);
  robot.name = name;
  robot.origin = origin_of("shell", shell_genome_table(), genome);
  return robot;
}

std::optional<ShellGenome> shell_genome_of(const Robot& robot) {
  if (kind_of(robot) != "shell") return std::nullopt;
  return genome_in(robot, shell_genome_table());
}

}  // namespace mercury
