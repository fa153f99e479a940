// SPDX-License-Identifier: Apache-2.0
#include "app/scene/group_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <variant>

#include "app/scene/eigen_vec3.h"
#include "mercury/distance.h"
#include "mercury/origin.h"

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

// The height of the sand below a swimming group: lower than the group by half its height plus twice its tallest robot.
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

// The legend of materials: the base materials of the group's springs, alone or in pairs, for robots with the default
// table.
std::vector<std::pair<render::Color, std::string>> swatches_of(const Group& group) {
  std::array<bool, max_materials> springs_of{};  // by id
  for (std::size_t i = 0; i < group.robots.size(); ++i) {
    if (!group.robots[i]->materials.empty()) continue;
    for (std::size_t id = 0; id < springs_of.size(); ++id)
      springs_of[id] = springs_of[id] || group.shapes[i]->materials[id];
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

// In slow motion with enough digits that the last one changes visibly.
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

GroupScene::GroupScene(const Group& given, std::vector<Eigen::Vector3f> offsets, const ViewSettings& settings)
    : settings_(settings), scale_(settings), names_(given.names), environment_(given.environment) {
  Group group = given;
  if (group.shapes.empty())
    for (const Robot* robot : group.robots) group.shapes.push_back(shape_of(*robot));
  swatches_ = swatches_of(group);
  for (std::size_t i = 0; i < group.robots.size(); ++i)
    add(*group.robots[i], group.materials[i], *group.shapes[i], offsets.at(i));
  bodies_ = group.bodies ? group.bodies : bodies_of(group.shapes);
  restart(group.telemetry);
  place(group.telemetry);
  show_surroundings();
  place_floor();
}

void GroupScene::place_floor() {
  scene_.floor = scene_.surroundings == render::Surroundings::land ? 0 : sand_below(bounds_);
}

// The parts of the scene that depend only on the settings and the environment.
void GroupScene::show_surroundings() {
  const bool plain = settings_.plain || !tiles_.empty();
  scene_.surroundings = plain ? render::Surroundings::none : surroundings_of(environment_);
  scene_.flow = eigen(flow_of(environment_));
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
  const Table& table = tables_[table_of_[robot]];
  if (std::ranges::equal(table.materials, materials)) return;
  const std::vector<Material> own = table.own;
  const bool defaults = table.defaults;
  --tables_[table_of_[robot]].robots;
  use_table(robot, table_for(own, materials, defaults));
}

// A table with these materials: an existing one, or a free or new one filled with them.
std::size_t GroupScene::table_for(std::span<const Material> own, std::span<const Material> materials, bool defaults) {
  const auto same = [&](const Table& table) {
    return table.robots > 0 && table.defaults == defaults && std::ranges::equal(table.materials, materials) &&
           std::ranges::equal(table.own, own);
  };
  const auto free = [&](const Table& table) { return table.robots == 0 && table.own.size() == own.size(); };
  auto found = std::ranges::find_if(tables_, same);
  if (found != tables_.end()) return static_cast<std::size_t>(found - tables_.begin());
  found = std::ranges::find_if(tables_, free);
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
  scene_.texts = texts_;
  show_surroundings();
}

void GroupScene::mark(std::size_t robot, bool selected, bool hidden) {
  placements_[robot].selected = selected;
  placements_[robot].hidden = hidden;
}

void GroupScene::restart(std::span<const Telemetry> telemetry) {
  trails_.clear();
  for (const Telemetry& robot : telemetry) trails_.push_back({.start = robot.center_of_mass});
}

void GroupScene::add(const Robot& robot, std::span<const Material> materials, const RobotShape& shape,
                     const Eigen::Vector3f& offset) {
  smooth_.push_back(shape.smooth);
  placements_.push_back({.offset = offset, .smooth = settings_.smooth || shape.smooth});
  table_of_.push_back(0);
  use_table(placements_.size() - 1, table_for(materials_of(robot), materials, robot.materials.empty()));
  render::Bounds rest = shape.box.moved(-shape.center);
  rest.low *= room_to_deform;
  rest.high *= room_to_deform;
  rest_.push_back(rest);
  mass_counts_.push_back(robot.masses.size());
  face_counts_.push_back(robot.faces.size());
  spring_counts_.push_back(robot.springs.size());
}

void GroupScene::set_bodies(render::Renderer& renderer) const { renderer.set_bodies(bodies_); }

void GroupScene::update(double time, std::span<const Telemetry> telemetry, SceneDetails details) {
  for (const Table& table : tables_)
    set_activations(table.materials, time, std::span(materials_).subspan(table.first_material, table.materials.size()));
  scene_.materials = materials_;
  scene_.time = time;
  if (settings_.shown.clock) scene_.clock = clock_of(time, settings_.speed);
  place(telemetry);
  if (settings_.shown.path) lengthen_paths(telemetry);
  if (settings_.shown.labels || settings_.shown.captions) write_labels(telemetry);
  color(time, std::move(details));
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
    const bool moved = points.empty() || points[points.size() - 3] != now.x || points[points.size() - 2] != now.y ||
                       points.back() != now.z;
    if (!telemetry[i].exploded && moved) points.insert(points.end(), {now.x, now.y, now.z});
    if (points.size() > 3 * most_points) points.erase(points.begin(), points.begin() + 3);
    paths_.push_back({.body = static_cast<std::uint32_t>(i),
                      .points = points,
                      .color = render::category_color(static_cast<int>(i))});
  }
  scene_.paths = paths_;
}

void GroupScene::write_labels(std::span<const Telemetry> telemetry) {
  std::vector<float> distances;
  for (std::size_t i = 0; i < trails_.size(); ++i)
    distances.push_back(telemetry[i].exploded ? -1
                                              : static_cast<float>(distance_between(
                                                    trails_[i].start, telemetry[i].center_of_mass, environment_)));
  // No ranks before a robot has moved.
  const bool ranked = trails_.size() > 1 && *std::max_element(distances.begin(), distances.end()) > 1e-3f;
  labels_.clear();
  for (std::size_t i = 0; i < trails_.size(); ++i) {
    const auto rank = 1 + std::count_if(distances.begin(), distances.end(), [&](float d) { return d > distances[i]; });
    std::string text = names_[i];
    if (telemetry[i].exploded)
      text += fmt::format("\nexploded at {:.1f} s", telemetry[i].exploded_at);
    else if (settings_.shown.labels)
      text += fmt::format("\n{}{}", distance_text(distances[i]), ranked ? fmt::format("   #{}", rank) : "");
    labels_.push_back({static_cast<std::uint32_t>(i), text});
  }
  scene_.labels = labels_;
}

// Fits the scale to the values that are visible: those of robots that are neither hidden nor have exploded, and of what
// is shown of them.
void GroupScene::fit_scale(double time) {
  const render::Show& show = scene_.show;
  const ColorValues& values = details_.values;
  const bool on_springs = !values.spring.empty() && (show.springs && !show.skin);
  const bool on_faces = !values.face.empty() && !on_springs && (show.skin || values.mass.empty());
  const bool on_masses = !values.mass.empty() && !on_springs && !on_faces;
  const std::vector<float>& all = on_faces ? values.face : on_masses ? values.mass : values.spring;
  const std::vector<std::size_t>& counts = on_faces ? face_counts_ : on_masses ? mass_counts_ : spring_counts_;
  std::vector<bool> counted;
  std::vector<ValueRange> ranges;
  std::size_t first = 0;
  for (std::size_t i = 0; i < placements_.size(); ++i) {
    counted.push_back(!placements_[i].hidden && !placements_[i].faulty);
    if (counted.back() && counts[i] > 0) ranges.push_back({first, counts[i]});
    first += counts[i];
  }
  if (all.size() != first) ranges.clear();
  const bool others = counted != counted_ || show.skin != counted_show_.skin || show.springs != counted_show_.springs;
  counted_ = std::move(counted);
  counted_show_ = show;
  scale_.fit(time, sample(all, ranges), others);
}

void GroupScene::color(double time, SceneDetails details) {
  details_ = std::move(details);
  fit_scale(time);
  scene_.face_values = details_.values.face;
  scene_.mass_values = details_.values.mass;
  scene_.spring_values = details_.values.spring;
  scene_.scale = scale_.scale();
  scene_.arrows = details_.arrows;
  scene_.caption = settings_.caption;
  if (!scene_.caption.empty() && !details_.arrow_key.empty()) scene_.caption += "\n";
  scene_.caption += details_.arrow_key;
  if (settings_.board) scene_.legend = settings_.board->legend;
  if (settings_.board || !settings_.shown.legend) return;
  scene_.legend = settings_.color->has_values()
                      ? scale_.legend()
                      : render::Legend{.title = std::string(settings_.color->key), .swatches = swatches_};
}

}  // namespace mercury
