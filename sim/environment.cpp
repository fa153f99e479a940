// SPDX-License-Identifier: Apache-2.0
#include "mercury/environment.h"

#include <algorithm>
#include <string>
#include <utility>

#include "mercury/error.h"

namespace mercury {
namespace {

// Calls visit(Part{}) with each kind of a part.
template <class Choice, class Visit>
void for_each_kind(const Choice&, const Visit& visit) {
  [&]<std::size_t... i>(std::index_sequence<i...>) { (visit(std::variant_alternative_t<i, Choice>{}), ...); }
  (std::make_index_sequence<std::variant_size_v<Choice>>{});
}

// The name of every combination of parts, with an environment that has them.
const std::vector<std::pair<std::string, Environment>>& combinations() {
  static const auto all = [] {
    std::vector<std::pair<std::string, Environment>> made;
    const Environment none;
    for_each_kind(none.water, [&](const auto& water) {
      for_each_kind(none.ground, [&](const auto& ground) {
        for (const bool contacts : {false, true}) {
          std::string name(water.name);
          if (!ground.name.empty()) name.append("+").append(ground.name);
          Environment environment{.water = water, .ground = ground};
          if (contacts) {
            name.append("+").append(Contacts::name);
            environment.contacts.emplace();
          }
          made.emplace_back(std::move(name), environment);
        }
      });
    });
    return made;
  }();
  return all;
}

// Sets the kind of a part that has this name, unless it is there. Returns false if none has.
template <class Choice>
bool choose(Choice& choice, std::string_view name) {
  bool known = false;
  for_each_kind(choice, [&](const auto& kind) {
    if (kind.name != name) return;
    if (!std::holds_alternative<std::decay_t<decltype(kind)>>(choice)) choice = kind;
    known = true;
  });
  return known;
}

bool add_part(Environment& environment, std::string_view name) {
  if (name.empty()) return false;
  if (name != Contacts::name) return choose(environment.ground, name);
  if (!environment.contacts) environment.contacts.emplace();
  return true;
}

}  // namespace

std::vector<std::string_view> environment_names() {
  std::vector<std::string_view> names;
  for (const EnvironmentPreset& preset : environment_presets) names.push_back(preset.name);
  return names;
}

std::string_view name_of(const Environment& environment) {
  for (const EnvironmentPreset& preset : environment_presets)
    if (same_parts(preset.environment, environment)) return preset.name;
  const auto found = std::ranges::find_if(
      combinations(), [&](const auto& combination) { return same_parts(combination.second, environment); });
  return found->first;
}

namespace {

std::optional<Environment> find_environment(std::string_view name) {
  std::size_t end = name.find('+');
  const std::string_view base = name.substr(0, end);
  Environment environment;
  const auto preset = std::ranges::find(environment_presets, base, &EnvironmentPreset::name);
  bool known = preset != environment_presets.end();
  if (known)
    environment = preset->environment;
  else
    known = choose(environment.water, base);
  while (known && end != std::string_view::npos) {
    const std::size_t begin = end + 1;
    end = name.find('+', begin);
    known = add_part(environment, name.substr(begin, end == std::string_view::npos ? end : end - begin));
  }
  return known ? std::optional(environment) : std::nullopt;
}

}  // namespace

bool is_environment(std::string_view name) { return find_environment(name).has_value(); }

Environment environment_named(std::string_view name) {
  if (const auto found = find_environment(name)) return *found;
  const bool combined = name.find('+') != std::string_view::npos;
  std::vector<std::string_view> names = environment_names();
  if (combined) names.push_back(NoWater::name);
  std::string accepted;
  for (std::size_t i = 0; i < names.size(); ++i)
    accepted.append(i == 0 ? "" : i + 1 < names.size() ? ", " : " or ").append(names[i]);
  if (combined) accepted.append(", followed by +ground or +contacts or both");
  throw ParameterError("environment", "\"" + std::string(name) + "\" is not an environment; give " + accepted);
}

Vec3 flow_of(const Environment& environment) {
  return std::visit(
      [](const auto& water) {
        if constexpr (requires { water.flow; })
          return water.flow;
        else
          return Vec3{};
      },
      environment.water);
}

}  // namespace mercury
