// SPDX-License-Identifier: Apache-2.0
#include "mercury/nn_robot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string_view>
#include <tuple>

#include "mercury/error.h"
#include "mercury/muscle_laws.h"
#include "mercury/random.h"
#include "robots/muscle_fields.h"
#include "robots/nn/cloud_spacing.h"
#include "robots/nn/tetrahedra.h"

namespace mercury {
namespace {

struct CloudPoint {
  Vec3 place;
  MaterialId material = air;
  FieldValue value{};  // with fields
  std::uint64_t z_order = 0;
};

void require(bool holds, const char* where, std::string_view what) {
  if (!holds) throw InputError(where, std::string(what));
}

// Mutations move all weights alike, and outputs with them, too far for a phase in turns.
constexpr double field_scale = 0.25;

FieldMuscles muscles_of(const NnGenome& genome) { return {genome.frequencies, genome.frequency, genome.amplitude}; }

// Standard normal points, point after point.
std::vector<float> normal_points(const NnGenome& genome) {
  const auto inputs = static_cast<std::size_t>(genome.network.layers.front().inputs);
  Random random(genome.cloud_seed);
  std::vector<float> points;
  points.reserve((genome.points + 1) * inputs);
  while (points.size() < genome.points * inputs) {
    for (std::size_t k = 0; k < inputs; ++k) points.push_back(static_cast<float>(random.normal()));
    if (!genome.mirrored) continue;
    const std::size_t pair = points.size() - inputs;
    for (std::size_t k = 0; k < inputs; ++k) points.push_back(k == 1 ? -points[pair + k] : points[pair + k]);
  }
  points.resize(genome.points * inputs);
  return points;
}

// Moves the mean to the origin and the farthest point onto the unit sphere.
void fit_into_unit_sphere(std::vector<CloudPoint>& cloud) {
  double mean[3] = {}, farthest = 0;
  for (const CloudPoint& p : cloud) {
    mean[0] += p.place.x, mean[1] += p.place.y, mean[2] += p.place.z;
  }
  for (double& m : mean) m /= static_cast<double>(cloud.size());
  for (const CloudPoint& p : cloud) {
    const double x = p.place.x - mean[0], y = p.place.y - mean[1], z = p.place.z - mean[2];
    farthest = std::max(farthest, std::sqrt(x * x + y * y + z * z));
  }
  // A cloud that is small beside its distance from the origin is made of rounding errors.
  const double offset = std::sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
  require(farthest > 1e-4 * offset && farthest > 1e-30, "cloud", "the network puts all its points on one place");
  const double scale = (1 - 1e-6) / farthest;  // no rounding leads outside
  const auto fit = [&](float value, double center) { return static_cast<float>((value - center) * scale); };
  for (CloudPoint& p : cloud) p.place = {fit(p.place.x, mean[0]), fit(p.place.y, mean[1]), fit(p.place.z, mean[2])};
}

// Position along a Z-curve through the cube [-1, 1]^3: the bits of the three coordinates in turn.
std::uint64_t z_order(Vec3 place) {
  constexpr int bits = 16;
  const auto cell = [](float x) { return static_cast<std::uint64_t>((x + 1) * 0.5f * ((1 << bits) - 1)); };
  const std::uint64_t x = cell(place.x), y = cell(place.y), z = cell(place.z);
  std::uint64_t code = 0;
  for (int bit = bits - 1; bit >= 0; --bit)
    code = code << 3 | (x >> bit & 1) << 2 | (y >> bit & 1) << 1 | (z >> bit & 1);
  return code;
}

// Points that fall on one place are one mass; the first keeps its material.
void order_and_merge(std::vector<CloudPoint>& cloud) {
  for (CloudPoint& p : cloud) p.z_order = z_order(p.place);
  const auto key = [](const CloudPoint& p) { return std::tuple(p.z_order, p.place.x, p.place.y, p.place.z); };
  std::stable_sort(cloud.begin(), cloud.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  cloud.erase(std::unique(cloud.begin(), cloud.end(), [](const auto& a, const auto& b) { return a.place == b.place; }),
              cloud.end());
}

void spread_out(std::vector<CloudPoint>& cloud, const NnGenome& genome) {
  std::vector<Vec3> places;
  for (const CloudPoint& p : cloud) places.push_back(p.place);
  const double distance = static_cast<double>(genome.spacing) * mean_spacing(places);
  if (!(distance > 0)) return;  // a plane, which has no body
  std::vector<CloudPoint> spread_cloud;
  for (const SpreadPoint& point : spread(places, genome.mirrored, distance)) {
    spread_cloud.push_back(cloud[point.index]);
    spread_cloud.back().place = point.place;
  }
  cloud = std::move(spread_cloud);
  fit_into_unit_sphere(cloud);
}

std::vector<CloudPoint> cloud_of(const NnGenome& genome) {
  const std::vector<float> outputs = evaluate(genome.network, normal_points(genome));
  std::vector<CloudPoint> cloud(genome.points);
  const bool fields = genome.network.has_fields();
  const std::size_t numbers = outputs.size() / genome.points;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const float* output = &outputs[i * numbers];
    const auto is_finite = [](float x) { return std::isfinite(x); };
    require(std::all_of(output, output + 3, is_finite), "cloud", "the network gives places that are not finite");
    require(std::all_of(output + 3, output + numbers, is_finite), "cloud",
            "the network gives scores that are not finite");
    cloud[i].place = {output[0], output[1], output[2]};
    cloud[i].material = static_cast<MaterialId>(1 + most_probable({output + 3, base_material_count}));
    if (!fields) continue;
    const auto field = [&](int index) { return field_scale * static_cast<double>(output[network_outputs + index]); };
    cloud[i].value =
        field_value(cloud[i].material,
                    {.phase = field(0), .frequency = field(1), .amplitude = 0.5 + field(2), .stiffness = field(3)},
                    muscles_of(genome));
  }
  fit_into_unit_sphere(cloud);
  if (genome.spacing > 0) spread_out(cloud, genome);
  order_and_merge(cloud);
  return cloud;
}

// Leaving out short springs can cut masses off that lie within 0.001 m of all their neighbors; tetrahedra that need
// such a mass go with it, until springs and tetrahedra agree.
struct Frame {
  std::vector<Tetrahedron> tetrahedra;
  std::vector<Edge> springs;
  std::vector<Triangle> skin;
};

Frame sound_frame(AlphaBody whole, const std::vector<CloudPoint>& cloud) {
  std::vector<Tetrahedron> tetrahedra = std::move(whole.tetrahedra);
  for (bool is_whole = true;; is_whole = false) {
    std::vector<Edge> springs = edges_of(tetrahedra);
    std::erase_if(springs, [&](const Edge& e) {
      return !(length(cloud[e.second].place - cloud[e.first].place) >= min_rest_length);
    });
    const std::vector<std::uint32_t> part = components(cloud.size(), springs);
    std::vector<std::size_t> masses_of_part(cloud.size(), 0);
    for (const std::uint32_t p : part) ++masses_of_part[p];
    const auto largest = static_cast<std::uint32_t>(std::max_element(masses_of_part.begin(), masses_of_part.end()) -
                                                    masses_of_part.begin());
    const auto cut_off = [&](const Tetrahedron& t) {
      return std::any_of(t.begin(), t.end(), [&](std::uint32_t p) { return part[p] != largest; });
    };
    if (std::none_of(tetrahedra.begin(), tetrahedra.end(), cut_off)) {
      std::vector<Triangle> skin = is_whole ? skin_of(tetrahedra, whole.neighbors) : skin_of(tetrahedra);
      return {std::move(tetrahedra), std::move(springs), std::move(skin)};
    }
    if (is_whole) {  // their order decides between bodies of equal size
      std::transform(tetrahedra.begin(), tetrahedra.end(), tetrahedra.begin(), lowest_first);
      std::sort(tetrahedra.begin(), tetrahedra.end());
    }
    std::erase_if(tetrahedra, cut_off);
    require(!tetrahedra.empty(), "cloud", "its points lie within 0.001 m of each other");
    const SolidBody body = largest_body(tetrahedra, neighbors_of(tetrahedra), tetrahedra.size());
    std::vector<Tetrahedron> kept;
    for (const std::uint32_t index : body.tetrahedra) kept.push_back(tetrahedra[index]);
    tetrahedra = std::move(kept);
  }
}

}  // namespace

void validate(const NnGenome& genome) {
  validate(genome.network);
  for (const Layer& layer : genome.network.layers)
    for (const auto& values : {std::cref(layer.weights), std::cref(layer.biases)})
      require(std::all_of(values.get().begin(), values.get().end(), [](float x) { return std::isfinite(x); }),
              "network", "a weight is not a finite number");
  if (genome.points < min_cloud_points || genome.points > max_masses)
    throw InputError("points", std::to_string(genome.points) + " is not accepted; give 64 to 65535");
  require(std::isfinite(genome.alpha) && genome.alpha >= 0, "alpha",
          "give a radius > 0 m, or 0 for the smallest that holds all points");
  require(genome.spacing >= 0 && genome.spacing <= 1, "spacing", "give a share of the mean spacing, 0 to 1");
  if (!genome.network.has_fields()) return;
  require(genome.frequencies >= 1 && genome.frequencies <= max_field_frequencies, "frequencies", "give 1 or 2");
  require(genome.frequency >= 0 && genome.frequency <= max_muscle_frequency, "frequency", "give 0 to 20 rad/s");
  require(genome.amplitude >= 0 && genome.amplitude <= max_muscle_amplitude, "amplitude", "give 0 to 0.4");
}

Robot grow_without_genome(const NnGenome& genome, const std::string& name) {
  validate(genome);
  const std::vector<CloudPoint> cloud = cloud_of(genome);
  require(cloud.size() >= 4, "cloud", "the network puts all its points on fewer than four places");
  std::vector<Vec3> places;
  for (const CloudPoint& p : cloud) places.push_back(p.place);
  const auto [tetrahedra, springs, skin] = sound_frame(alpha_body(places, genome.alpha), cloud);

  Robot robot;
  robot.name = name;
  robot.masses.reserve(cloud.size());
  robot.springs.reserve(springs.size());
  robot.faces.reserve(skin.size());
  std::vector<std::uint16_t> mass_of(cloud.size(), 0);
  std::vector<bool> used(cloud.size(), false);
  for (const Tetrahedron& t : tetrahedra)
    for (const std::uint32_t p : t) used[p] = true;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!used[i]) continue;
    mass_of[i] = static_cast<std::uint16_t>(robot.masses.size());
    robot.masses.push_back(cloud[i].place);
  }
  for (const auto& [a, b] : springs) {
    const std::uint16_t mass_a = mass_of[a], mass_b = mass_of[b];
    robot.springs.push_back(
        {mass_a, mass_b, combine(cloud[a].material, cloud[b].material), rest_distance(robot, mass_a, mass_b)});
  }
  if (genome.network.has_fields()) {
    std::vector<FieldValue> values;
    for (const auto& [a, b] : springs) values.push_back(mean_value(std::array{cloud[a].value, cloud[b].value}));
    const FieldPalette palette = palette_of(values, max_materials - 1);
    for (std::size_t s = 0; s < values.size(); ++s)
      robot.springs[s].material = static_cast<MaterialId>(palette.of[s] + 1);
    FieldTable table = table_of(palette.values, muscles_of(genome));
    robot.materials = std::move(table.materials);
    robot.material_names = std::move(table.names);
  }
  for (const auto& [a, b, c] : skin) robot.faces.push_back({mass_of[a], mass_of[b], mass_of[c]});
  robot.origin = R"({"kind":"nn"})";
  return robot;
}

Robot grow(const NnGenome& genome, const std::string& name) {
  Robot robot = grow_without_genome(genome, name);
  robot.origin = to_origin(genome);
  return robot;
}

namespace {

NnGenome with_network(const NnGenome& genome, Network network) {
  return {.network = std::move(network),
          .cloud_seed = genome.cloud_seed,
          .points = genome.points,
          .mirrored = genome.mirrored,
          .alpha = genome.alpha,
          .spacing = genome.spacing,
          .frequencies = genome.frequencies,
          .frequency = genome.frequency,
          .amplitude = genome.amplitude,
          .environment = genome.environment};
}

}  // namespace

NnGenome mutate(const NnGenome& genome, double rate, double size, std::uint64_t seed) {
  return with_network(genome, mutate(genome.network, rate, size, seed));
}

NnGenome crossover(const NnGenome& a, const NnGenome& b, std::uint64_t seed) {
  return with_network(a, crossover(a.network, b.network, seed));
}

NnGenome mutate_muscles(const NnGenome& genome, double strength, std::uint64_t seed, int tail) {
  NnGenome child = genome;
  move_muscles(child.frequency, child.amplitude, strength, seed, tail);
  return child;
}

NnGenome cross_muscles(const NnGenome& a, const NnGenome& b, std::uint64_t seed) {
  Random random(seed);
  NnGenome child = a;
  if (random.chance(0.5)) child.frequency = b.frequency;
  if (random.chance(0.5)) child.amplitude = b.amplitude;
  return child;
}

}  // namespace mercury
