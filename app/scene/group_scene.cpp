// SPDX-License-Identifier: Apache-2.0
#include "app/scene/group_scene.h"

#include <algorithm>
#include <cmath>

#include "app/scene/camera_controller.h"
#include "app/scene/group_look.h"
#include "app/scene/hero_style.h"
#include "render/text/overlay.h"

namespace mercury {
namespace {

// Muscles change lengths by up to 14 %, and bodies bend.
constexpr float room_to_deform = 1.2f;

// The height of the sand below a swimming group: lower than the group by half its height plus twice its tallest robot.
float sand_below(std::span<const render::Bounds> robots) {
  render::Bounds group;
  float tallest = 0;
  for (const render::Bounds& robot : robots) {
    if (robot.empty()) continue;
    group.extend(robot);
    tallest = std::max(tallest, robot.high.z - robot.low.z);
  }
  return group.empty() ? 0 : group.low.z - 0.5f * (group.high.z - group.low.z) - 2 * tallest;
}

// Plants that suit the robots: in water about as tall as they are wide, on land short grass. Among many robots they
// would be a few pixels high, and each keeps clear of all robots, which takes time.
render::GroundCover ground_cover_for(std::span<const Room> rooms, bool land) {
  if (rooms.size() > most_with_extras) return {.height = 0};
  std::vector<float> radii;
  for (const Room& room : rooms) radii.push_back(room.radius);
  if (radii.empty()) radii.push_back(0.5f);
  std::ranges::nth_element(radii, radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2));
  return {.height = (land ? 0.35f : 1.15f) * std::max(1e-3f, radii[radii.size() / 2])};
}

// Between marks on trails and in lanes: a round length of about one robot.
float mark_distance_for(std::span<const Room> rooms) {
  float sum = 0;
  for (const Room& room : rooms) sum += room.radius;
  return render::round_length(rooms.empty() ? 1 : std::max(1e-3f, 1.2f * sum / static_cast<float>(rooms.size())));
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

GroupScene::GroupScene(const Group& given, std::vector<render::Vector3> offsets, const ViewSettings& settings)
    : settings_(settings), scale_(settings), names_(given.names), environment_(given.environment) {
  Group group = given;
  if (group.shapes.empty())
    for (const Robot* robot : group.robots) group.shapes.push_back(shape_of(*robot));
  materials_legend_ = material_legend(group.robots, group.shapes);
  for (std::size_t i = 0; i < group.robots.size(); ++i)
    add(*group.robots[i], group.materials[i], *group.shapes[i], offsets.at(i));
  for (const Robot* robot : group.robots) {
    seeks_target_.push_back(seeks_target(*robot));
    seeks_light_.push_back(seeks_light(*robot));
  }
  bodies_ = group.bodies ? group.bodies : bodies_of(group.shapes);
  mark_distance_ = mark_distance_for(rooms_);
  mark_times_ = MarkTimes(mark_distance_);
  restart(group.telemetry);
  show_surroundings();
  place(group.telemetry);
  place_floor();
}

void GroupScene::place_floor() {
  const bool land = has_ground(environment_);
  scene_.floor = land ? 0 : sand_below(bounds_);
  scene_.ground_cover = ground_cover_for(rooms_, land);
}

// The parts of the scene that depend only on the settings and the environment.
void GroupScene::show_surroundings() {
  const bool plain = settings_.plain || settings_.flat_backdrop || !tiles_.empty();
  const bool land = has_ground(environment_);
  const float azimuth = direction_of(settings_.camera, land).azimuth;
  motion_.set(motion_of(settings_), environment_, {-std::cos(azimuth), -std::sin(azimuth), 0});
  scene_.surroundings = plain ? render::Surroundings::none : surroundings_of(environment_);
  scene_.catch_shadows = plain && land && tiles_.empty();
  scene_.flat_backdrop = settings_.flat_backdrop;
  scene_.text_aside = settings_.text_aside;
  scene_.against_light.reset();
  if (settings_.hero) scene_.against_light = hero_light(settings_, environment_);
  scene_.rounded = !settings_.faceted;
  scene_.flow = render::Vector3(flow_of(environment_));
  scene_.show = {.skin = settings_.shown.skin, .springs = settings_.shown.springs, .masses = settings_.shown.masses};
  scene_.theme = settings_.theme;
  scene_.cut = settings_.cut;
  scene_.scale_bar = settings_.shown.scale_bar;
}

void GroupScene::set_settings(const ViewSettings& settings) {
  if (settings.color != settings_.color || settings.scale != settings_.scale ||
      settings.colormap != settings_.colormap || settings.log_scale != settings_.log_scale)
    scale_ = ColorScale(settings);
  settings_ = settings;
  for (std::size_t i = 0; i < placements_.size(); ++i) placements_[i].smooth = settings.smooth || smooth_[i];
  // Clears what may no longer be shown.
  scene_.clock.clear();
  scene_.paths = {};
  scene_.labels = {};
  scene_.legend.reset();
  show_surroundings();
}

void GroupScene::set_environment(const Environment& environment) {
  const bool moved = !same_parts(environment_, environment);
  environment_ = environment;
  show_surroundings();
  if (moved) place_floor();
}

void GroupScene::set_offsets(std::span<const render::Vector3> offsets) {
  for (std::size_t i = 0; i < placements_.size(); ++i) offsets_[i] = offsets[i];
  place_boxes();
  place_floor();
}

void GroupScene::set_materials(std::size_t robot, std::span<const Material> materials) {
  const Table& table = tables_[table_of_[robot]];
  if (std::ranges::equal(table.materials, materials)) return;
  const std::vector<Material> own = table.own;
  const bool defaults = table.defaults;
  --tables_[table_of_[robot]].robots;
  use_table(robot, table_for(own, materials, defaults));
}

// A table with these materials, which robots may share.
std::size_t GroupScene::table_for(std::span<const Material> own, std::span<const Material> materials, bool defaults) {
  const auto same = [&](const Table& table) {
    return table.robots > 0 && !table.driven && table.defaults == defaults &&
           std::ranges::equal(table.materials, materials) && std::ranges::equal(table.own, own);
  };
  const auto found = std::ranges::find_if(tables_, same);
  return found == tables_.end() ? new_table(own, materials, defaults)
                                : static_cast<std::size_t>(found - tables_.begin());
}

// A free or new table, filled with these materials.
std::size_t GroupScene::new_table(std::span<const Material> own, std::span<const Material> materials, bool defaults) {
  const auto free = [&](const Table& table) { return table.robots == 0 && table.own.size() == own.size(); };
  auto found = std::ranges::find_if(tables_, free);
  if (found == tables_.end()) {
    tables_.push_back({.first_material = materials_.size()});
    materials_.resize(materials_.size() + own.size());
    found = tables_.end() - 1;
  }
  const std::size_t first = found->first_material;
  *found = {first, {own.begin(), own.end()}, {materials.begin(), materials.end()}, defaults, 0};
  found->materials.resize(own.size());
  const std::vector<render::Color> colors = material_colors(own, defaults);
  for (std::size_t id = 0; id < colors.size(); ++id) materials_[first + id] = {.color = colors[id]};
  return static_cast<std::size_t>(found - tables_.begin());
}

void GroupScene::use_table(std::size_t robot, std::size_t table) {
  ++tables_[table].robots;
  table_of_[robot] = table;
  placements_[robot].first_material = static_cast<std::uint32_t>(tables_[table].first_material);
}

void GroupScene::set_background(std::vector<render::Tile> tiles, std::vector<render::Text> texts) {
  tiles_ = std::move(tiles);
  texts_ = std::move(texts);
  scene_.tiles = tiles_;
  show_surroundings();
}

void GroupScene::mark(std::size_t robot, bool selected, bool hidden) {
  placements_[robot].selected = selected;
  hidden_[robot] = hidden;
}

void GroupScene::restart(std::span<const Telemetry> telemetry) {
  trails_.clear();
  footprints_.assign(telemetry.size(), Footprints(telemetry.size()));
  for (std::size_t i = 0; i < telemetry.size(); ++i) {
    const bool known = !telemetry[i].exploded && render::Vector3(telemetry[i].center_of_mass).is_finite();
    const render::Vector3& rest = rooms_[i].center;
    trails_.emplace_back(known ? telemetry[i].center_of_mass : Vec3{rest.x, rest.y, rest.z});
  }
}

void GroupScene::add(const Robot& robot, std::span<const Material> materials, const RobotShape& shape,
                     const render::Vector3& offset) {
  smooth_.push_back(shape.smooth);
  offsets_.push_back(offset);
  hidden_.push_back(false);
  rooms_.push_back(shape.room);
  placements_.push_back({.offset = offset, .smooth = settings_.smooth || shape.smooth});
  table_of_.push_back(0);
  use_table(placements_.size() - 1, table_for(materials_of(robot), materials, robot.materials.empty()));
  render::Bounds rest = shape.box.moved(-shape.room.center);
  rest.low *= room_to_deform;
  rest.high *= room_to_deform;
  rest_.push_back(rest);
  mass_counts_.push_back(robot.masses.size());
  face_counts_.push_back(robot.faces.size());
  spring_counts_.push_back(robot.springs.size());
}

void GroupScene::set_bodies(render::Renderer& renderer) const { renderer.set_bodies(bodies_); }

}  // namespace mercury
