#include "app/group_scene.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

#include "app/eigen_vec3.h"

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

}  // namespace

GroupScene::GroupScene(const Simulation& simulation, std::vector<Eigen::Vector3f> offsets) {
  constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::size_t default_looks = none;  // where the table that most robots share begins
  for (std::size_t i = 0; i < simulation.size(); ++i) {
    const Robot& robot = simulation.robot(i);
    const bool defaults = robot.materials.empty();
    std::size_t first_look = defaults ? default_looks : none;
    if (first_look == none) {
      first_look = looks_.size();
      const auto materials = materials_of(robot);
      tables_.push_back({first_look, {materials.begin(), materials.end()}});
      for (const render::Color color : material_colors(materials, defaults)) looks_.push_back({.color = color});
      if (defaults) default_looks = first_look;
    }
    shapes_.emplace_back(robot, static_cast<std::uint32_t>(first_look));
    placements_.push_back({.offset = offsets.at(i)});
    const Eigen::Vector3f middle = mean_position(robot);
    render::Bounds rest = rest_bounds(robot).moved(-middle);
    rest.low *= room_to_deform;
    rest.high *= room_to_deform;
    rest_.push_back(rest);
  }
  const Environment& environment = simulation.configuration().environment;
  scene_.surroundings = surroundings_of(environment);
  scene_.flow = eigen(flow_of(environment));
  update(simulation.time(), simulation.telemetry());
  scene_.floor = scene_.surroundings == render::Surroundings::land ? 0 : sand_below(bounds_);
}

void GroupScene::set_bodies(render::Renderer& renderer) const {
  std::vector<render::Body> bodies;
  for (const BodyShape& shape : shapes_) bodies.push_back(shape.body());
  renderer.set_bodies(bodies);
}

void GroupScene::update(double time, std::span<const Telemetry> telemetry) {
  for (const Table& table : tables_)
    set_activations(table.materials, time, std::span(looks_).subspan(table.first_look, table.materials.size()));
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
  scene_.looks = looks_;
  scene_.time = time;
}

}  // namespace mercury
