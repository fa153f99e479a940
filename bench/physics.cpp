// SPDX-License-Identifier: Apache-2.0
// How far the physics is from theory: one number per question, for bodies as in the paper and of a real material.
//
//   build/bin/bench_physics                the table of docs/physics.md, in Markdown
//   build/bin/bench_physics swim           rows whose name contains a word
//   build/bin/bench_physics 60.s           64 random robots of each kind for 60 s: how many explode
//
// "0.2" is what version 0.2 did, which had bodies as in the paper alone.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/evaluator.h"
#include "mercury/generator.h"
#include "mercury/observables.h"
#include "mercury/random_voxel.h"
#include "mercury/real_body.h"
#include "mercury/robot_file.h"
#include "mercury/samples.h"
#include "mercury/simulation.h"
#include "mercury/voxel.h"

namespace mercury {
namespace {

Configuration settings(Physics physics, std::string_view environment = "") {
  Configuration configuration = default_configuration(physics, environment);
  configuration.device.kind = DeviceKind::cpu;
  return configuration;
}

Robot box(int x, int y, int z, float edge, MaterialId material = tissue) {
  VoxelGrid grid(x, y, z, material);
  grid.edge = edge;
  return make_voxel_robot(grid);
}

Robot body_in(Physics physics, const Robot& robot, const RealMaterial& material = {}) {
  return physics == Physics::real ? with_real_body(robot, material) : robot;
}

double total_mass(const Robot& robot) {
  double sum = 0;
  for (std::size_t i = 0; i < robot.masses.size(); ++i) sum += static_cast<double>(mass_of(robot, i));
  return sum;
}
double density(const Robot& robot) { return total_mass(robot) / skin_volume(robot); }

// [m/s]
double speed_in_flow(Physics physics) {
  Configuration configuration = settings(physics);
  std::visit(
      [](auto& water) {
        if constexpr (requires { water.flow; }) water.flow = {0.1f, 0, 0};
      },
      configuration.environment.water);
  const Robot robot = body_in(physics, box(3, 3, 3, 0.1f));
  Simulation simulation(configuration, {&robot, 1});
  simulation.step(1000000);
  return static_cast<double>(simulation.telemetry(0).velocity.x);
}

// The speed of a sinking cube over that of theory, without damping. Theory: the drag of a rigid cube.
double sinking(Physics physics, double speed, double stiffness) {
  const float edge = 0.2f;
  Robot robot = box(2, 2, 2, edge);
  robot.materials.assign(default_materials().begin(), default_materials().end());
  robot.materials[tissue].stiffness = static_cast<float>(stiffness);
  Configuration configuration = settings(physics);
  if (physics == Physics::real) robot.materials[tissue].relaxation_time = 0.005f;
  configuration.damping = 0;
  const double area = 0.4 * 0.4, mass = total_mass(robot);
  double drag = 1000.0 * area, weight = mass, inertia = mass;  // equation 1: rho a^2 C_D u^2
  if (const auto* water = std::get_if<ResistiveDrag>(&configuration.environment.water)) {
    robot.mass.assign(robot.masses.size(), static_cast<float>(1200 * 0.064 / 27));
    drag = 500.0 * area *
           (2.0 * static_cast<double>(water->normal_coefficient) +
            4.0 * static_cast<double>(water->tangential_coefficient));
    weight = (1200 - 1000) * 0.064;
    inertia = (1200 + 500) * 0.064;
  }
  configuration.environment.gravity = {0, 0, static_cast<float>(-drag * speed * speed / weight)};
  configuration.environment.contacts.reset();
  Simulation simulation(configuration, {&robot, 1});
  const State start{robot.masses, std::vector<Vec3>(robot.masses.size(), Vec3{0, 0, static_cast<float>(-0.5 * speed)})};
  simulation.set_state(0, start);
  simulation.step(std::llround(3 * inertia / (drag * speed) / configuration.dt));
  return static_cast<double>(-simulation.telemetry(0).velocity.z) / speed;
}

struct Swim {
  double lengths_per_second = 0, strouhal = 0;
};

// A swimmer of muscles of one frequency, after the transient: speed of the center, and f A / U with the width A of the
// tail's beat across the way.
Swim swim(const Robot& robot, const Configuration& configuration, double frequency) {
  Simulation simulation(configuration, {&robot, 1});
  const auto steps = [&](double seconds) { return std::llround(seconds / configuration.dt); };
  simulation.step(steps(10));
  float low = 1e9f, high = -1e9f;
  for (const Vec3 x : robot.masses) {
    low = std::min(low, x.x);
    high = std::max(high, x.x);
  }
  const Vec3 before = simulation.telemetry(0).center_of_mass;
  // The end that trails is the tail; both are followed.
  std::array<std::vector<Vec3>, 2> ends;
  const double seconds = 10;
  const int samples = 500;
  for (int n = 0; n < samples; ++n) {
    simulation.step(steps(seconds / samples));
    const auto x = simulation.positions(0);
    std::array<Vec3, 2> sum{};
    std::array<int, 2> count{};
    for (std::size_t i = 0; i < x.size(); ++i)
      for (const std::size_t end : {0u, 1u})
        if (std::abs(robot.masses[i].x - (end == 0 ? low : high)) < 1e-3f) {
          sum[end] += x[i];
          ++count[end];
        }
    for (const std::size_t end : {0u, 1u}) ends[end].push_back((1.0f / static_cast<float>(count[end])) * sum[end]);
  }
  const Vec3 way = simulation.telemetry(0).center_of_mass - before;
  const double distance = static_cast<double>(length(way)), speed = distance / seconds;
  const Vec3 ahead = (1 / length(way)) * way;
  const std::size_t trailing = dot(ends[0].back() - ends[1].back(), ahead) < 0 ? 0 : 1;
  // Across the way, in the plane in which the tail moves most.
  const Vec3 side = length(cross(ahead, Vec3{0, 0, 1})) > 0.5f ? cross(ahead, Vec3{0, 0, 1}) : Vec3{0, 1, 0};
  float left = 1e9f, right = -1e9f;
  const Vec3 first = ends[trailing].front();
  const auto period = static_cast<std::size_t>(std::lround(samples / seconds / frequency));
  double width = 0;
  int cycles = 0;
  for (std::size_t begin = 0; begin + period <= ends[trailing].size(); begin += period, ++cycles) {
    left = 1e9f;
    right = -1e9f;
    for (std::size_t n = begin; n < begin + period; ++n) {
      const float along = dot(ends[trailing][n] - first, side);
      left = std::min(left, along);
      right = std::max(right, along);
    }
    width += static_cast<double>(right - left);
  }
  return {speed / static_cast<double>(high - low), frequency * width / cycles / speed};
}

// A grid with each voxel divided into n^3.
Robot refined(const Robot& robot, int n) {
  const VoxelGrid coarse = *voxel_grid_of(robot);
  VoxelGrid fine(coarse.nx * n, coarse.ny * n, coarse.nz * n);
  fine.edge = coarse.edge / static_cast<float>(n);
  for (int z = 0; z < fine.nz; ++z)
    for (int y = 0; y < fine.ny; ++y)
      for (int x = 0; x < fine.nx; ++x) fine.cell(x, y, z) = coarse.at(x / n, y / n, z / n);
  return make_voxel_robot(fine, {.materials = robot.materials, .material_names = robot.material_names});
}

double frequency_of(const Robot& robot) {  // of its muscles [Hz]
  for (const Spring& spring : robot.springs)
    if (const Material& own = materials_of(robot)[spring.material]; own.amplitude != 0)
      return static_cast<double>(own.frequency) / (2 * std::numbers::pi);
  return 1;
}

// The slope at which an elastic plate begins to slide, over the friction.
double slope_that_slides(Physics physics) {
  const Robot robot = body_in(physics, box(6, 6, 1, 0.1f));
  for (double slope = 0.6; slope < 1; slope += 0.02) {
    Configuration configuration = settings(physics, "land");
    const double angle = std::atan(slope);
    configuration.environment.gravity = {static_cast<float>(9.81 * std::sin(angle)), 0,
                                         static_cast<float>(-9.81 * std::cos(angle))};
    Simulation simulation(configuration, {&robot, 1});
    simulation.step(3000);
    const float before = simulation.telemetry(0).center_of_mass.x;
    simulation.step(2000);
    if (simulation.telemetry(0).center_of_mass.x - before > 0.01f) return slope / 0.8;
  }
  return 1.25;
}

// Young's modulus of a bar, n voxels across and 8 times as long, over that of an endless lattice. Both ends are held 1
// % further apart than at rest, and the middle half says how long the bar got.
double modulus_of_bar(Physics physics, int n) {
  constexpr double width = 0.4, stretched = 0.01;
  Robot robot = body_in(physics, box(8 * n, n, n, static_cast<float>(width / n)));
  const double length = 8 * width, edge = width / n;
  for (std::size_t i = 0; i < robot.masses.size(); ++i) {
    const double x = static_cast<double>(robot.masses[i].x - robot.masses.front().x);
    if (x < edge / 2 || x > length - edge / 2) robot.fixed.push_back(static_cast<std::uint16_t>(i));
  }
  Configuration configuration = settings(physics, "ocean");
  configuration.environment.water = NoWater{};
  configuration.environment.contacts.reset();
  const double slowest = physics == Physics::real ? 9.7 / (4 * length) : 1.0 / (4 * 8 * n);  // [Hz], about
  configuration.damping = static_cast<float>(2 * std::numbers::pi * slowest);
  configuration.dt = physics == Physics::real ? 1e-3 / n : 0.02;
  Simulation simulation(configuration, {&robot, 1});
  State start{robot.masses, std::vector<Vec3>(robot.masses.size())};
  for (Vec3& x : start.positions) x.x += static_cast<float>(stretched) * (x.x - robot.masses.front().x);
  simulation.set_state(0, start);
  simulation.step(std::llround(4 / slowest / configuration.dt));
  const std::vector<Vec3> positions = simulation.positions(0);
  const std::vector<MaterialNow> materials = materials_at(materials_of(robot), configuration.environment, 0.0);
  const std::vector<Vec3> forces = spring_forces(robot, materials, positions);
  double force = 0, near = 0, far = 0;
  const double quarter = std::round(2.0 * n) * edge, far_quarter = std::round(6.0 * n) * edge;
  int layer = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double x = static_cast<double>(robot.masses[i].x - robot.masses.front().x);
    if (x < edge / 2) force += static_cast<double>(forces[i].x);
    if (std::abs(x - quarter) < edge / 2) near += static_cast<double>(positions[i].x), ++layer;
    if (std::abs(x - far_quarter) < edge / 2) far += static_cast<double>(positions[i].x);
  }
  const double strain = (far - near) / layer / (far_quarter - quarter) - 1;
  // Of the lattice of equal springs: C11 = 13/3 k/h, C12 = C44 = 7/3 k/h.
  const double lattice = (13.0 / 3 - 2 * (7.0 / 3) * (7.0 / 3) / (20.0 / 3)) *
                         static_cast<double>(default_materials()[tissue].stiffness) / edge;
  const double theory = physics == Physics::real ? 0.8 * 1e5 : lattice;  // tissue
  return force / (width * width * strain) / theory;
}

// How fast a cantilever vibrates in water, over its frequency without water.
double frequency_in_water(Physics physics) {
  Robot robot = body_in(physics, box(12, 2, 2, 0.1f), {.relaxation_time = 1e-4f});
  for (std::size_t i = 0; i < robot.masses.size(); ++i)
    if (robot.masses[i].x < robot.masses.front().x + 0.05f) robot.fixed.push_back(static_cast<std::uint16_t>(i));
  const auto tip = static_cast<std::size_t>(
      std::ranges::max_element(robot.masses, {}, [](Vec3 x) { return x.x + x.y + x.z; }) - robot.masses.begin());
  const auto frequency = [&](bool in_water) {
    Configuration configuration = settings(physics);
    configuration.damping = 0;
    configuration.environment.gravity = {};
    configuration.environment.contacts.reset();
    if (!in_water) configuration.environment.water = NoWater{};
    if (physics == Physics::real) configuration.dt = 5e-4;
    Simulation simulation(configuration, {&robot, 1});
    State start{robot.masses, std::vector<Vec3>(robot.masses.size())};
    const float length = 1.2f;
    for (std::size_t i = 0; i < start.velocities.size(); ++i) {
      const float along = (robot.masses[i].x - robot.masses.front().x) / length;
      start.velocities[i].z = 0.002f * along * along;
    }
    simulation.set_state(0, start);
    const float rest = robot.masses[tip].z;
    constexpr int crossings = 12;
    double first = 0, last = 0, before = 0;
    for (int found = 0; found <= crossings && simulation.time() < 600;) {
      simulation.step(1);
      const double now = static_cast<double>(simulation.positions(0)[tip].z - rest);
      if (before > 0 && now <= 0) {
        last = simulation.time() - configuration.dt * now / (now - before);
        if (found++ == 0) first = last;
      }
      before = now;
    }
    return crossings / (last - first);
  };
  return frequency(true) / frequency(false);
}

// The largest share of a sample robot that is inside out within 20 s.
double inside_out(Physics physics, const char* name) {
  const Robot robot = body_in(physics, load_robot(sample_or_path(fmt::format("sample:paper/{}", name))));
  Simulation simulation(settings(physics), {&robot, 1});
  simulation.measure_folding(true);
  float most = 0;
  for (const Telemetry& sample : simulation.step_and_sample(20000, 50)) most = std::max(most, sample.inverted);
  return static_cast<double>(most);
}

// Of 64 random robots with the settings of their kind, how many explode within 60 s.
std::string explosions(Physics physics, const Generator& generator) {
  constexpr std::size_t robots = 64;
  const ParameterValues values{{"physics", std::string(name_of(physics))}};
  const Configuration configuration = settings(physics, physics == Physics::real ? "" : generator.environment);
  EvaluationRequest request{.configuration = configuration, .steps = std::llround(60 / configuration.dt)};
  Evaluator evaluator(
      request, [&](std::size_t i) { return std::make_shared<const Robot>(generator.make(values, "", 1, i)); }, robots);
  int exploded = 0, failed = 0;
  while (const std::optional<Evaluation> result = evaluator.next()) {
    exploded += result->end.exploded ? 1 : 0;
    failed += result->failure.empty() ? 0 : 1;
  }
  return fmt::format("{} of {}", exploded, robots - static_cast<std::size_t>(failed));
}

struct Row {
  std::string what, theory, before;
  std::function<std::string(Physics)> value;
};

std::string percent(double ratio) { return fmt::format("{:+.1f} %", 100 * (ratio - 1)); }

std::vector<Row> rows() {
  std::vector<Row> all{{"a free cube in a flow of 0.1 m/s drifts at [m/s]", "0.1", "0.042",
                        [](Physics physics) { return fmt::format("{:.4f}", speed_in_flow(physics)); }},
                       {"density of 64 random voxel robots [kg/m3]", "as given (1070)", "1978 to 2783",
                        [](Physics physics) {
                          double least = 1e9, most = 0;
                          for (const Robot& robot : random_voxel_robots({}, 1, 64)) {
                            const double d = density(body_in(physics, robot));
                            least = std::min(least, d);
                            most = std::max(most, d);
                          }
                          return fmt::format("{:.0f} to {:.0f}", least, most);
                        }},
                       {"slope at which an elastic plate slides, over that of its friction, 0.8", "1", "0.88",
                        [](Physics physics) { return fmt::format("{:.3f}", slope_that_slides(physics)); }}};
  const std::array<const char*, 4> softer{"-26 %", "-17 %", "-10 %", ""};
  for (std::size_t i = 0; i < softer.size(); ++i)
    all.push_back({fmt::format("Young's modulus of a bar with {} voxels across", 1 << i), "0 % (3 %)", softer[i],
                   [=](Physics physics) { return percent(modulus_of_bar(physics, 1 << i)); }});
  all.push_back({"frequency of a cantilever in water, over that in vacuum", "0.825 (5 %), of 1070 kg/m3", "1.00",
                 [](Physics physics) { return fmt::format("{:.3f}", frequency_in_water(physics)); }});
  for (const double stiffness : {10.0, 50.0, 6000.0, 1e5})
    for (const double speed : {0.001, 0.002, 0.02, 0.2, 3.0})
      all.push_back({fmt::format("terminal speed of a 0.4 m cube, {} m/s, springs of {} N/m", speed, stiffness),
                     "0 % (1 %)",
                     stiffness == 6000 && speed == 0.02  ? "+235 %"
                     : stiffness == 50 && speed == 0.002 ? "+130 %"
                                                         : "",
                     [=](Physics physics) { return percent(sinking(physics, speed, stiffness)); }});
  for (const char* name : {"eel", "fish"})
    all.push_back({fmt::format("swim of the sample {}: body lengths per second, Strouhal number", name),
                   "Strouhal 0.2 to 0.4 (animals)", std::string_view(name) == "eel" ? "1.8 to 2.9" : "2.9 to 4.4",
                   [=](Physics physics) {
                     const Robot robot = load_robot(sample_or_path(fmt::format("sample:paper/{}", name)));
                     std::string text;
                     for (const float modulus : {1e4f, 1e5f, 1e6f}) {
                       Configuration configuration = settings(physics);
                       configuration.dt *= std::min(1.0, 1e5 / static_cast<double>(modulus));  // so that it is stable
                       const Swim found =
                           swim(body_in(physics, robot, {.modulus = modulus}), configuration, frequency_of(robot));
                       const std::string numbers =
                           fmt::format("{:.3f}, {:.2f}", found.lengths_per_second, found.strouhal);
                       if (physics == Physics::paper) return numbers;
                       text += fmt::format("{}{} ({:.0f} kPa)", text.empty() ? "" : "; ", numbers,
                                           static_cast<double>(modulus) / 1000);
                     }
                     return text;
                   }});
  for (const int n : {1, 2, 3})
    all.push_back({fmt::format("swim of the sample eel, voxels divided by {}: body lengths per second", n), "converges",
                   std::array{"", "0.060", "0.090", "0.0004"}[static_cast<std::size_t>(n)], [=](Physics physics) {
                     const Robot robot = refined(load_robot(sample_or_path("sample:paper/eel")), n);
                     Configuration configuration = settings(physics);
                     configuration.dt /= n;
                     return fmt::format(
                         "{:.3f}",
                         swim(body_in(physics, robot), configuration, frequency_of(robot)).lengths_per_second);
                   }});
  for (const char* name : {"eel", "fish"})
    all.push_back({fmt::format("largest share of the sample {} that is inside out within 20 s", name), "0 %", "",
                   [=](Physics physics) { return fmt::format("{:.1f} %", 100 * inside_out(physics, name)); }});
  for (const Generator& generator : generators())
    all.push_back({fmt::format("random robots of kind {} that explode within 60 s", generator.kind), "0", "",
                   [&](Physics physics) { return explosions(physics, generator); }});
  return all;
}

int print_table(std::string_view wanted) {
  std::puts("| what | theory | 0.2 | paper | real |\n|---|---|---|---|---|");
  for (const Row& row : rows()) {
    if (row.what.find(wanted) == std::string::npos) continue;
    fmt::print("| {} | {} | {} | {} | {} |\n", row.what, row.theory, row.before, row.value(Physics::paper),
               row.value(Physics::real));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace mercury

int main(int count, char** words) { return mercury::print_table(count > 1 ? words[1] : ""); }
