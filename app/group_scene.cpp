#include "app/group_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
std::vector<std::pair<render::Color, std::string>> swatches_of(std::span<const Robot* const> robots) {
  std::array<bool, max_materials> springs_of{};  // by id
  for (const Robot* robot : robots) {
    if (!robot->materials.empty()) continue;
    for (const Spring& spring : robot->springs) springs_of[spring.material] = true;
  }
  std::vector<bool> used(base_material_count + 1, false);
  for (int id = 1; id < default_material_count; ++id) {
    if (!springs_of[static_cast<std::size_t>(id)]) continue;
    const BasePair pair = base_materials_of(static_cast<MaterialId>(id));
    used[pair.first] = used[pair.second] = true;
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

// In slow motion so many digits that the last one is seen to move.
std::string clock_of(double time, double speed) {
  const int digits = speed >= 1 ? 1 : std::clamp(1 + static_cast<int>(std::ceil(-std::log10(speed) - 1e-9)), 1, 5);
  return speed == 1 ? fmt::format("{:.1f} s", time) : fmt::format("{:.{}f} s   x{:g}", time, digits, speed);
}

}  // namespace

Group group_of(const Simulation& simulation) {
  Group group{.telemetry = simulation.telemetry(), .environment = simulation.configuration().environment};
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    group.robots.push_back(&simulation.robot(i));
    group.names.push_back(simulation.robot(i).name);
    group.materials.push_back(materials_of(simulation.robot(i)));
  }
  return group;
}

GroupScene::GroupScene(const Group& group, std::vector<Eigen::Vector3f> offsets, const ViewSettings& settings)
    : settings_(settings), scale_(settings.color, settings.scale), names_(group.names),
      shared_looks_(group.shared_looks), environment_(group.environment), swatches_(swatches_of(group.robots)) {
  for (std::size_t i = 0; i < group.robots.size(); ++i) add(*group.robots[i], group.materials[i], offsets.at(i));
  restart(group.telemetry);
  place(group.telemetry);
  show_surroundings();
  place_floor();
}

void GroupScene::place_floor() {
  scene_.floor = scene_.surroundings == render::Surroundings::land ? 0 : sand_below(bounds_);
}

// What the settings and the environment say, and no moment changes.
void GroupScene::show_surroundings() {
  scene_.surroundings = surroundings_of(environment_);
  scene_.flow = eigen(flow_of(environment_));
  scene_.show = {.skin = settings_.shown.skin, .springs = settings_.shown.springs, .masses = settings_.shown.masses};
  scene_.theme = settings_.theme;
  scene_.cut = settings_.cut;
  scene_.scale_bar = settings_.shown.scale_bar;
}

void GroupScene::set_settings(const ViewSettings& settings) {
  if (settings.color != settings_.color || settings.scale != settings_.scale) scale_ = {settings.color, settings.scale};
  settings_ = settings;
  for (std::size_t i = 0; i < placements_.size(); ++i) placements_[i].smooth = settings.smooth || grown_[i];
  // What is no longer shown.
  scene_.clock.clear();
  scene_.paths = {};
  scene_.labels = {};
  scene_.legend.reset();
  show_surroundings();
}

void GroupScene::set_environment(const Environment& environment) {
  const bool moved = environment_.index() != environment.index();
  environment_ = environment;
  show_surroundings();
  if (moved) place_floor();
}

void GroupScene::set_offsets(std::span<const Eigen::Vector3f> offsets) {
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    bounds_[i] = bounds_[i].empty() ? bounds_[i] : bounds_[i].moved(offsets[i] - placements_[i].offset);
    placements_[i].offset = offsets[i];
  }
  place_floor();
}

void GroupScene::set_materials(std::size_t robot, std::span<const Material> materials) {
  Table& table = tables_[table_of_[robot]];
  std::copy_n(materials.begin(), std::min(materials.size(), table.materials.size()), table.materials.begin());
}

void GroupScene::mark(std::size_t robot, bool selected, bool hidden) {
  placements_[robot].selected = selected;
  placements_[robot].hidden = hidden;
}

void GroupScene::restart(std::span<const Telemetry> telemetry) {
  trails_.clear();
  for (const Telemetry& robot : telemetry) trails_.push_back({.start = eigen(robot.center_of_mass)});
}

void GroupScene::add(const Robot& robot, std::span<const Material> materials, const Eigen::Vector3f& offset) {
  const bool defaults = robot.materials.empty();
  // Most robots share the default table, and its looks.
  auto shared = std::find_if(tables_.begin(), tables_.end(), [&](const Table& table) {
    return shared_looks_ && std::equal(table.materials.begin(), table.materials.end(), materials.begin(), materials.end());
  });
  if (shared == tables_.end()) {
    tables_.push_back({looks_.size(), {materials.begin(), materials.end()}});
    shared = tables_.end() - 1;
    for (const render::Color color : material_colors(materials_of(robot), defaults)) looks_.push_back({.color = color});
  }
  table_of_.push_back(static_cast<std::size_t>(shared - tables_.begin()));
  shapes_.emplace_back(robot, static_cast<std::uint32_t>(shared->first_look));
  grown_.push_back(kind_of(robot) == "nn");
  placements_.push_back({.offset = offset, .smooth = settings_.smooth || grown_.back()});
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
  for (std::size_t i = 0; i < trails_.size(); ++i) {
    std::vector<float>& points = trails_[i].points;
    const Vec3 now = telemetry[i].center_of_mass;
    const bool moved = points.empty() || points[points.size() - 3] != now.x || points[points.size() - 2] != now.y || points.back() != now.z;
    if (!telemetry[i].exploded && moved) points.insert(points.end(), {now.x, now.y, now.z});
    if (points.size() > 3 * most_points) points.erase(points.begin(), points.begin() + 3);
    paths_.push_back({.body = static_cast<std::uint32_t>(i), .points = points, .color = render::category_color(static_cast<int>(i))});
  }
  scene_.paths = paths_;
}

void GroupScene::write_labels(std::span<const Telemetry> telemetry) {
  std::vector<float> distances;
  for (std::size_t i = 0; i < trails_.size(); ++i)
    distances.push_back(telemetry[i].exploded ? -1 : (eigen(telemetry[i].center_of_mass) - trails_[i].start).norm());
  // Nobody leads before somebody has moved.
  const bool ranked = trails_.size() > 1 && *std::max_element(distances.begin(), distances.end()) > 1e-3f;
  labels_.clear();
  for (std::size_t i = 0; i < trails_.size(); ++i) {
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
