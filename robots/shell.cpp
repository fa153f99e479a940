// SPDX-License-Identifier: Apache-2.0
#include "mercury/shell.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "mercury/error.h"
#include "mercury/origin.h"
#include "mercury/random.h"
#include "robots/parameter_table.h"
#include "robots/portable_math.h"
#include "robots/revolved_mesh.h"
#include "robots/shell_evolution.h"

namespace mercury {
namespace {

// A ring's profile ends where it begins: what goes once around it is a whole number.
double once_around(const ShellGenome& genome, double count) {
  return genome.form == ShellForm::ring ? std::round(count) : count;
}

// 1 at the middle of a lobe, -1 between two.
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

void check_thickness(double thickness, double diameter) {
  if (thickness > diameter / 4)
    throw ParameterError("thickness", "more than a quarter of the diameter is not accepted; give less");
}

std::string origin_of(const ShellGenome& genome) {
  nlohmann::ordered_json origin{{"kind", "shell"}};
  if (!genome.environment.empty()) origin["environment"] = genome.environment;
  for (const auto& row : shell_genome_table())
    std::visit(
        [&]<class Value>(const Value& value) {
          if constexpr (!std::is_same_v<Value, SizeRange>) origin[row.description.name] = value;
        },
        row.get(genome));
  return origin.dump();
}

// A value of the kind that the default has.
ParameterValue read(const nlohmann::json& origin, const GeneratorParameter& description) {
  const std::string place = "/origin/" + description.name;
  const auto found = origin.find(description.name);
  if (found == origin.end()) throw InputError(place, "is missing");
  if (std::holds_alternative<std::string>(description.initial) && found->is_string()) return found->get<std::string>();
  if (std::holds_alternative<double>(description.initial) && found->is_number()) return found->get<double>();
  if (std::holds_alternative<std::int64_t>(description.initial) && found->is_number_integer())
    return found->get<std::int64_t>();
  throw InputError(place, "give " + accepted_values(description));
}

const ParameterTable<ShellOptions>& option_table() {
  using Options = ShellOptions;
  static const ParameterTable<Options> rows{
      parameter(&Options::form,
                {.name = "form", .help = "Form of the shells", .words = {"any", "bell", "tube", "ring", "pod"}}),
      parameter(&Options::diameter, {.name = "diameter",
                                     .help = "Diameter at the widest place",
                                     .unit = "m",
                                     .lowest = 0.2,
                                     .highest = 20,
                                     .usual_highest = 4}),
      parameter(&Options::segments, {.name = "segments",
                                     .help = "Masses of a layer around the widest place",
                                     .lowest = 12,
                                     .highest = 128,
                                     .usual_highest = 64}),
      parameter(&Options::thickness, {.name = "thickness",
                                      .help = "Distance of the two layers",
                                      .unit = "m",
                                      .lowest = 0.01,
                                      .highest = 5,
                                      .usual_highest = 0.4,
                                      .advanced = true}),
      parameter(
          &Options::opening,
          {.name = "opening", .help = "Mouth of bells, ends of tubes, holes of rings: 0 narrow, 1 wide", .highest = 1}),
      parameter(&Options::lobes,
                {.name = "lobes", .help = "Lobes around the axis; 0 draws them for each robot", .highest = 16}),
      parameter(&Options::active, {.name = "active",
                                   .help = "Share of the springs along the surface that are muscles",
                                   .highest = 1,
                                   .advanced = true})};
  return rows;
}

}  // namespace

void validate(const ShellGenome& genome) {
  check_each(shell_genome_table(), genome);
  check_thickness(genome.thickness, genome.diameter);
}

Robot grow(const ShellGenome& genome, const std::string& name) {
  validate(genome);
  const RevolvedMesh mesh = mesh_of(genome);
  if (2 * mesh.vertices().size() > max_masses)
    throw ParameterError("segments",
                         "the shell would have more than " + std::to_string(max_masses) + " masses; give fewer");
  Robot robot = Builder(genome, mesh).build();
  robot.name = name;
  robot.origin = origin_of(genome);
  return robot;
}

std::optional<ShellGenome> shell_genome_of(const Robot& robot) {
  if (kind_of(robot) != "shell") return std::nullopt;
  const auto origin = nlohmann::json::parse(robot.origin, nullptr, false);
  ShellGenome genome;
  genome.environment = environment_of(robot);
  for (const auto& row : shell_genome_table()) {
    const ParameterValue value = read(origin, row.description);
    try {
      check(row.description, value);
    } catch (const ParameterError& error) {
      throw InputError("/origin/" + error.parameter(), error.problem());
    }
    row.set(genome, value);
  }
  return genome;
}

void validate(const ShellOptions& options) {
  check_each(option_table(), options);
  check_thickness(options.thickness, options.diameter);
  if (options.lobes == 1 || options.lobes == 2)
    throw ParameterError("lobes", std::to_string(options.lobes) + " is not accepted; give 3 to 16, or 0");
}

ShellGenome random_shell_genome(const ShellOptions& options, std::uint64_t seed, std::uint64_t index) {
  validate(options);
  Random random(seed_of(seed, index));
  const auto maybe = [&](double chance, double low, double high) {
    const double value = random.uniform(low, high);
    return random.chance(chance) ? value : 0;
  };
  // Bells swim best: half of all are bells.
  constexpr ShellForm drawn[] = {ShellForm::bell, ShellForm::bell, ShellForm::bell,
                                 ShellForm::tube, ShellForm::ring, ShellForm::pod};
  ShellGenome g;
  g.form = drawn[random.below(std::size(drawn))];
  if (options.form != ShellOptions::Form::any) g.form = static_cast<ShellForm>(static_cast<int>(options.form) - 1);
  g.environment = options.environment;
  g.segments = options.segments;
  g.diameter = options.diameter;
  g.thickness = options.thickness;
  g.active = options.active;
  g.lobes = 4 + static_cast<int>(random.below(7));
  if (options.lobes > 0) g.lobes = options.lobes;
  const auto sign = [&] { return random.chance(0.5) ? 1. : -1.; };
  g.opening = std::clamp(options.opening + random.uniform(-0.3, 0.2), 0., 1.);
  g.squareness = random.uniform(-0.04, 0.1);
  g.flare = random.uniform(0.05, 0.35);
  g.lobe_depth = maybe(0.8, 0.03, 0.15);
  g.lappets = maybe(0.6, 0.05, 0.25);
  g.twist = maybe(0.4, -0.2, 0.2);
  g.contraction = random.uniform(0.28, 0.36);
  g.bending = random.uniform(0, 0.15);
  g.frequency = random.uniform(2.5, 3.4);
  // Ranges in which shells swim, found by simulation.
  switch (g.form) {
    case ShellForm::bell:
      g.height = random.uniform(0.8, 1.6);
      g.waves_along = sign() * random.uniform(0.9, 1.4);
      break;
    case ShellForm::tube:
      g.height = random.uniform(1.2, 1.8);
      g.lappets /= 2;
      g.waves_along = sign() * random.uniform(1.2, 1.7);
      break;
    case ShellForm::ring:
      g.height = random.uniform(0.4, 0.7);
      g.waves_along = 1;
      g.waves_around = static_cast<int>(sign()) * (2 + static_cast<int>(random.below(2)));
      g.lobe_depth /= 2;
      break;
    case ShellForm::pod:
      g.height = random.uniform(0.8, 1.3);
      g.waves_along = random.uniform(1.2, 2);
      g.waves_around = static_cast<int>(random.below(3));
      g.squareness /= 2;
      break;
  }
  return g;
}

Robot random_shell_robot(const ShellOptions& options, std::uint64_t seed, std::uint64_t index) {
  return grow(random_shell_genome(options, seed, index), "shell-" + std::to_string(seed) + "-" + std::to_string(index));
}

Generator shell_generator() {
  Generator shell{.kind = "shell",
                  .title = "Shell robots",
                  .noun = "a shell robot",
                  .help = "Thin hollow bodies that pulse: bells, tubes, rings and pods",
                  .note = "A file keeps the numbers that a shell is built from, so that it can be changed.",
                  .environment = "ocean",
                  .smooth = true,
                  .example = {.name = "medusa", .seed = 4, .values = {{"form", "bell"}, {"lobes", "8"}}},
                  .regrow = [](const Robot& robot) { return grow(shell_genome_in(robot), robot.name); },
                  .mutate = mutate_shell_robot,
                  .cross = cross_shell_robots};
  return with_parameters(std::move(shell), option_table(), random_shell_robot);
}

}  // namespace mercury
