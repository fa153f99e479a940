#include "app/group_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "app/eigen_vec3.h"
#include "robots/origin.h"

namespace mercury {
namespace {

// Muscles change lengths by up to 14 %, and bodies bend.
constexpr float room_to_deform = 1.2f;

render::Surroundings surroundings_of(const Environment& environment) {
  return std::holds_alternative<Land>(environment) ? render::Surroundings::land : render::Surroundings::water;
}

Vec3 flow_of(const Environment& environment) {
  return std::visit(
      []<class Kind>(const Kind& kind) {
        if constexpr (requires { kind.flow; })
          return kind.flow;
        else
          return Vec3{};
      },
      environment);
}

// Height of the sand under a group that swims: half the group's height below it, and twice its tallest robot.
float sand_below(std::span<const render::Bounds> robots) {
  render::Bounds group;
  float tallest = 0;
  for (const render::Bounds& robot : robots) {
    if (robot.empty()) continue;
    group.extend(robot);
    tallest = std::max(tallest, robot.high.z() - robot.low.z());
  }
  return group.empty() ? 0 : group.low.z() - 0.5f * (group.high.z() - group.low.z()) - 2 * tallest;
}

Eigen::Vector3f mean_position(const Robot& robot) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Vec3 mass : robot.masses) sum += eigen(mass).cast<double>();
  return (sum / static_cast<double>(robot.masses.size())).cast<float>();
}

// Materials of the legend: the base materials that the group's springs are of, alone or in pairs, if they are the
// defaults.
std::vector<std::pair<render::Color, std::string>> swatches_of(const Simulation& simulation) {
  std::vector<bool> used(base_material_count + 1, false);
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const Robot& robot = simulation.robot(i);
    if (!robot.materials.empty()) continue;
    for (const Spring& spring : robot.springs) {
      const BasePair pair = base_materials_of(spring.material);
      used[pair.first] = used[pair.second] = true;
    }
  }
  const std::vector<render::Color> colors = material_colors(default_materials(), true);
  std::vector<std::pair<render::Color, std::string>> swatches;
  for (std::size_t id = 1; id < used.size(); ++id)
    if (used[id]) swatches.emplace_back(colors[id], default_material_name(static_cast<MaterialId>(id)));
  return swatches;
}

std::string distance_text(float metres) {
  if (metres < 0.01f) return fmt::format("{:.1f} mm", 1000 * metres);
  if (metres < 1) return fmt::format("{:.1f} cm", 100 * metres);
  return fmt::format("{:.2f} m", metres);
}

std::string clock_of(double time, double speed) {
  return speed == 1 ? fmt::format("{:.1f} s", time) : fmt::format("{:.1f} s   x{:g}", time, speed);
}

}  // namespace

GroupScene::GroupScene(const Simulation& simulation, std::vector<Eigen::Vector3f> offsets, const ViewSettings& settings)
    : settings_(settings), scale_(settings.color, settings.scale) {
  for (std::size_t i = 0; i < simulation.size(); ++i) add(simulation.robot(i), offsets.at(i));
  const std::vector<Telemetry> telemetry = simulation.telemetry();
  for (const Telemetry& robot : telemetry) start_.push_back(eigen(robot.center_of_mass));
  path_points_.resize(simulation.size());
  if (settings.shown.legend && settings.color == ColorBy::material) swatches_ = swatches_of(simulation);
  const Environment& environment = simulation.configuration().environment;
  scene_.surroundings = surroundings_of(environment);
  scene_.flow = eigen(flow_of(environment));
  scene_.show = {.skin = settings.shown.skin, .springs = settings.shown.springs, .masses = settings.shown.masses};
  scene_.theme = settings.theme;
  scene_.cut = settings.cut;
  scene_.scale_bar = settings.shown.scale_bar;
  place(telemetry);
  scene_.floor = scene_.surroundings == render::Surroundings::land ? 0 : sand_below(bounds_);
}

void GroupScene::add(const Robot& robot, const Eigen::Vector3f& offset) {
  const bool defaults = robot.materials.empty();
  const auto materials = materials_of(robot);
  // Most robots share the default table, and its looks.
  const auto shared = std::find_if(tables_.begin(), tables_.end(), [&](const Table& table) {
    return std::equal(table.materials.begin(), table.materials.end(), materials.begin(), materials.end());
  });
  const std::size_t first_look = shared == tables_.end() ? looks_.size() : shared->first_look;
  if (shared == tables_.end()) {
    tables_.push_back({first_look, {materials.begin(), materials.end()}});
    for (const render::Color color : material_colors(materials, defaults)) looks_.push_back({.color = color});
  }
  names_.push_back(robot.name);
  shapes_.emplace_back(robot, static_cast<std::uint32_t>(first_look));
  placements_.push_back({.offset = offset, .smooth = settings_.smooth || kind_of(robot) == "nn"});
  render::Bounds rest = rest_bounds(robot).moved(-mean_position(robot));
  rest.low *= room_to_deform;
  rest.high *= room_to_deform;
  rest_.push_back(rest);
}

void GroupScene::set_bodies(render::Renderer& renderer) const {
  std::vector<render::Body> bodies;
  for (const BodyShape& shape : shapes_) bodies.push_back(shape.body());
  renderer.set_bodies(bodies);
}

void GroupScene::update(double time, std::span<const Telemetry> telemetry, SceneDetails details) {
  for (const Table& table : tables_)
    set_activations(table.materials, time, std::span(looks_).subspan(table.first_look, table.materials.size()));
  scene_.looks = looks_;
  scene_.time = time;
  if (settings_.shown.clock) scene_.clock = clock_of(time, settings_.speed);
  place(telemetry);
  if (settings_.shown.path) lengthen_paths(telemetry);
  if (settings_.shown.labels) write_labels(telemetry);
  color(std::move(details));
}

void GroupScene::place(std::span<const Telemetry> telemetry) {
  bounds_.assign(placements_.size(), {});
  bool any = false;
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    placements_[i].faulty = telemetry[i].exploded;
    const Eigen::Vector3f middle = eigen(telemetry[i].center_of_mass);
    if (telemetry[i].exploded || !middle.allFinite()) continue;
    bounds_[i] = rest_[i].moved(middle + placements_[i].offset);
    any = true;
  }
  for (std::size_t i = 0; i < placements_.size() && !any; ++i) bounds_[i] = rest_[i].moved(placements_[i].offset);
  scene_.placements = placements_;
}

void GroupScene::lengthen_paths(std::span<const Telemetry> telemetry) {
  constexpr std::size_t most_points = 2000;
  paths_.clear();
  for (std::size_t i = 0; i < path_points_.size(); ++i) {
    std::vector<float>& points = path_points_[i];
    const Vec3 now = telemetry[i].center_of_mass;
    if (!telemetry[i].exploded) points.insert(points.end(), {now.x, now.y, now.z});
    if (points.size() > 3 * most_points) points.erase(points.begin(), points.begin() + 3);
    paths_.push_back({.body = static_cast<std::uint32_t>(i), .points = points, .color = render::category_color(static_cast<int>(i))});
  }
  scene_.paths = paths_;
}

void GroupScene::write_labels(std::span<const Telemetry> telemetry) {
  std::vector<float> distances;
  for (std::size_t i = 0; i < start_.size(); ++i)
    distances.push_back(telemetry[i].exploded ? -1 : (eigen(telemetry[i].center_of_mass) - start_[i]).norm());
  // Nobody leads before somebody has moved.
  const bool ranked = start_.size() > 1 && *std::max_element(distances.begin(), distances.end()) > 1e-3f;
  labels_.clear();
  for (std::size_t i = 0; i < start_.size(); ++i) {
    const auto rank = 1 + std::count_if(distances.begin(), distances.end(), [&](float d) { return d > distances[i]; });
    std::string text = names_[i];
    if (telemetry[i].exploded)
      text += fmt::format("\nexploded at {:.1f} s", telemetry[i].exploded_at);
    else
      text += fmt::format("\n{}{}", distance_text(distances[i]), ranked ? fmt::format("   #{}", rank) : "");
    labels_.push_back({static_cast<std::uint32_t>(i), text});
  }
  scene_.labels = labels_;
}

void GroupScene::color(SceneDetails details) {
  details_ = std::move(details);
  scale_.fit(details_.values);
  scene_.face_values = details_.values.face;
  scene_.mass_values = details_.values.mass;
  scene_.spring_values = details_.values.spring;
  scene_.scale = scale_.scale();
  scene_.arrows = details_.arrows;
  scene_.caption = details_.arrow_key;
  if (!settings_.shown.legend) return;
  scene_.legend = settings_.color == ColorBy::material ? render::Legend{.title = "material", .swatches = swatches_}
                                                       : scale_.legend();
}

}  // namespace mercury
