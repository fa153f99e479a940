// SPDX-License-Identifier: Apache-2.0
#include "app/scene/group_look.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "app/scene/appearance.h"

namespace mercury {
namespace {

constexpr std::size_t most_muscles = 8, most_others = 6;  // that have a swatch each
constexpr int wheel_colors = 24;

// The materials of own tables that share a name.
struct NamedMaterials {
  std::vector<std::pair<float, render::Color>> by_stiffness;
  std::set<long> phases;  // of muscles [degrees]
};
using ByName = std::map<std::string, NamedMaterials>;

void add_named(const Robot& robot, const RobotShape& shape, ByName& muscles, ByName& passive) {
  const std::vector<render::Color> colors = material_colors(robot.materials, false);
  for (std::size_t id = 1; id < robot.materials.size(); ++id) {
    if (!shape.materials[id]) continue;
    const Material& material = robot.materials[id];
    const bool moves = material.amplitude != 0;
    const bool has_name = id < robot.material_names.size() && !robot.material_names[id].empty();
    const std::string name = has_name ? robot.material_names[id] : moves ? "muscle" : "passive";
    NamedMaterials& named = (moves ? muscles : passive)[name];
    named.by_stiffness.emplace_back(material.stiffness, colors[id]);
    if (!moves) continue;
    const long degrees = std::lround(material.phase * 180 / std::numbers::pi_v<float>) % 360;
    named.phases.insert(degrees < 0 ? degrees + 360 : degrees);
  }
}

bool needs_wheel(const ByName& muscles, std::size_t default_muscles) {
  return muscles.size() + default_muscles > most_muscles ||
         std::ranges::any_of(muscles, [](const auto& named) { return named.second.phases.size() > 1; });
}

// Whether a name, as "muscle 1 + tissue", is of a mixture whose parts have names of their own here.
bool is_explained(std::string_view name, const ByName& muscles, const ByName& passive) {
  constexpr std::string_view joint = " + ";
  if (name.find(joint) == std::string_view::npos) return false;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find(joint, begin), name.size());
    const std::string part(name.substr(begin, end - begin));
    if (!muscles.contains(part) && !passive.contains(part)) return false;
    begin = end + joint.size();
  }
  return true;
}

void add_swatches(const ByName& named, std::size_t most, render::Legend& legend) {
  std::size_t count = 0;
  for (auto [name, materials] : named) {
    if (++count > most) continue;
    auto& all = materials.by_stiffness;
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
    std::ranges::nth_element(all, middle, {}, &std::pair<float, render::Color>::first);
    legend.swatches.emplace_back(middle->second, name);
  }
  if (count > most)
    legend.swatches.emplace_back(render::Color{0, 0, 0, 0}, "and " + std::to_string(count - most) + " more");
}

}  // namespace

render::Surroundings surroundings_of(const Environment& environment) {
  return has_ground(environment) && !has_water(environment) ? render::Surroundings::land : render::Surroundings::water;
}

render::Legend material_legend(std::span<const Robot* const> robots,
                               std::span<const std::shared_ptr<const RobotShape>> shapes) {
  std::array<bool, base_material_count + 1> used{};  // base materials of robots with the default table
  ByName muscles, passive;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!robots[i]->materials.empty()) {
      add_named(*robots[i], *shapes[i], muscles, passive);
      continue;
    }
    for (int id = 1; id < default_material_count; ++id) {
      if (!shapes[i]->materials[static_cast<std::size_t>(id)]) continue;
      const BasePair pair = base_materials_of(static_cast<MaterialId>(id));
      used[pair.first] = used[pair.second] = true;
    }
  }
  render::Legend legend{.title = "material"};
  const std::vector<render::Color> colors = material_colors(default_materials(), true);
  const auto is_muscle = [](std::size_t id) { return default_materials()[id].amplitude != 0; };
  std::size_t default_muscles = 0;
  for (std::size_t id = 1; id < used.size(); ++id) default_muscles += used[id] && is_muscle(id) ? 1 : 0;
  const bool wheel = needs_wheel(muscles, default_muscles);
  for (std::size_t id = 1; id < used.size(); ++id)
    if (used[id] && !(wheel && is_muscle(id)))
      legend.swatches.emplace_back(colors[id], default_material_name(static_cast<MaterialId>(id)));
  const ByName all_muscles = muscles;
  std::erase_if(muscles, [&](const auto& named) { return is_explained(named.first, all_muscles, passive); });
  if (wheel)
    for (int i = 0; i < wheel_colors; ++i)
      legend.wheel.push_back(
          render::muscle_color(2 * std::numbers::pi_v<float> * static_cast<float>(i) / wheel_colors, 0.5f));
  else
    add_swatches(muscles, most_muscles, legend);
  // Those with the name of a muscle are drawn as it.
  std::erase_if(passive, [&](const auto& named) {
    return all_muscles.contains(named.first) || is_explained(named.first, all_muscles, passive);
  });
  add_swatches(passive, most_others, legend);
  return legend;
}

}  // namespace mercury
