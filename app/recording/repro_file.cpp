// SPDX-License-Identifier: Apache-2.0
// Repros as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/recording/configuration_json.h"
#include "app/recording/repro.h"
#include "mercury/error.h"
#include "mercury/number_text.h"
#include "mercury/robot_file.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format = "mercury-repro";
constexpr int version = 1;
constexpr std::int64_t max_steps = 1'000'000'000'000'000;

Json json_of(std::span<const Vec3> vectors) {
  Json list = Json::array();
  for (const Vec3 v : vectors) list.push_back(json_of(v));
  return list;
}

Json json_of(std::span<const Perturbation> perturbations) {
  Json list = Json::array();
  for (const Perturbation& perturbation : perturbations)
    list.push_back({{"mass", perturbation.mass},
                    {"target", json_of(perturbation.target)},
                    {"stiffness", shortest(perturbation.stiffness)}});
  return list;
}

// The materials that changed, as [id, stiffness, amplitude, frequency, phase], followed where they are needed by true
// or false for half waves, and by the relaxation time.
Json changes_of(std::span<const Material> before, std::span<const Material> after) {
  Json list = Json::array();
  for (std::size_t id = 0; id < after.size(); ++id)
    if (id >= before.size() || before[id] != after[id]) {
      list.push_back({id, shortest(after[id].stiffness), shortest(after[id].amplitude), shortest(after[id].frequency),
                      shortest(after[id].phase)});
      const bool relaxes = after[id].relaxation_time != 0;
      if (after[id].half_wave || relaxes) list.back().push_back(after[id].half_wave);
      if (relaxes) list.back().push_back(shortest(after[id].relaxation_time));
    }
  return list;
}

Json json_of(const ReproChange& change, std::vector<Material>& materials) {
  Json json{{"step", change.step}};
  if (change.configuration) json["configuration"] = json_of(*change.configuration);
  if (change.materials) {
    json["materials"] = changes_of(materials, *change.materials);
    materials = *change.materials;
  }
  if (change.perturbations) json["pulls"] = json_of(std::span<const Perturbation>(*change.perturbations));
  return json;
}

const Json& member(const Json& json, const char* name) {
  if (!json.is_object() || !json.contains(name)) throw InputError(fmt::format("\"{}\" is missing", name));
  return json[name];
}

double double_of(const Json& json) {
  if (!json.is_number()) throw InputError("a number is missing");
  return json.get<double>();
}

float number_of(const Json& json) { return static_cast<float>(double_of(json)); }

// Empty if it is missing or no text.
std::string text_of(const Json& json, const char* name) {
  return json.contains(name) && json[name].is_string() ? json[name].get<std::string>() : "";
}

Vec3 vector_of(const Json& json) {
  if (!json.is_array() || json.size() != 3) throw InputError("a list of three numbers is missing");
  return {number_of(json[0]), number_of(json[1]), number_of(json[2])};
}

std::vector<Vec3> vectors_of(const Json& json, std::size_t count) {
  if (!json.is_array() || json.size() != count) throw InputError(fmt::format("a list of {} places is missing", count));
  std::vector<Vec3> vectors;
  for (const Json& one : json) vectors.push_back(vector_of(one));
  return vectors;
}

std::int64_t step_of(const Json& json, std::int64_t least) {
  const auto step = json.is_number_integer() ? json.get<std::int64_t>() : -1;
  if (step < least || step > max_steps)
    throw InputError(fmt::format("{} is not accepted as a step here; give {} or more", json.dump(), least));
  return step;
}

std::vector<Perturbation> perturbations_of(const Json& json, const Robot& robot) {
  std::vector<Perturbation> perturbations;
  for (const Json& one : json) {
    const std::int64_t mass = step_of(member(one, "mass"), 0);
    if (mass >= static_cast<std::int64_t>(robot.masses.size()))
      throw InputError(fmt::format("mass {} is out of range, the robot has {}", mass, robot.masses.size()));
    perturbations.push_back({.mass = static_cast<std::uint16_t>(mass),
                             .target = vector_of(member(one, "target")),
                             .stiffness = number_of(member(one, "stiffness"))});
  }
  return perturbations;
}

void change_materials(const Json& json, std::vector<Material>& materials) {
  for (const Json& one : json) {
    if (!one.is_array() || one.size() < 5 || one.size() > 7)
      throw InputError("[id, stiffness, amplitude, frequency, phase] is missing");
    if (one.size() > 5 && !one[5].is_boolean()) throw InputError("true or false is missing for half_wave");
    const std::int64_t id = step_of(one[0], 0);
    if (id >= static_cast<std::int64_t>(materials.size())) throw InputError(fmt::format("there is no material {}", id));
    Material& material = materials[static_cast<std::size_t>(id)];
    material = {number_of(one[1]),
                number_of(one[2]),
                number_of(one[3]),
                number_of(one[4]),
                one.size() > 5 && one[5].get<bool>(),
                one.size() > 6 ? number_of(one[6]) : 0};
    validate(material, fmt::format("material {}", id));
  }
}

std::vector<ReproChange> changes_from(const Json& json, const Repro& repro) {
  const auto own = materials_of(repro.robot);
  std::vector<Material> materials(own.begin(), own.end());
  std::vector<ReproChange> changes;
  std::int64_t least = repro.clock.step;
  for (const Json& one : json) {
    ReproChange change{.step = least = step_of(member(one, "step"), least)};
    if (one.contains("configuration")) change.configuration = configuration_from(one["configuration"]);
    if (one.contains("materials")) {
      change_materials(one["materials"], materials);
      change.materials = materials;
    }
    if (one.contains("pulls")) change.perturbations = perturbations_of(one["pulls"], repro.robot);
    changes.push_back(std::move(change));
  }
  return changes;
}

Repro repro_from(const Json& json) {
  if (!json.is_object() || text_of(json, "format") != format)
    throw InputError("is not a repro: its format is not \"mercury-repro\"");
  if (member(json, "version") != version)
    throw InputError(fmt::format("is of version {}, this program reads {}", json["version"].dump(), version));
  Repro repro;
  try {
    repro.robot = parse_robot(member(json, "robot").dump(), RobotFormat::json);
  } catch (const InputError& error) {
    throw InputError("/robot", error.what());
  }
  repro.configuration = configuration_from(member(json, "configuration"));
  const Json& start = member(json, "start");
  repro.clock = {.dt = repro.configuration.dt,
                 .base_time = double_of(member(start, "base_time")),
                 .base_step = step_of(member(start, "base_step"), 0)};
  repro.clock.step = step_of(member(start, "step"), repro.clock.base_step);
  repro.state.positions = vectors_of(member(start, "positions"), repro.robot.masses.size());
  repro.state.velocities = vectors_of(member(start, "velocities"), repro.robot.masses.size());
  repro.perturbations = perturbations_of(member(start, "pulls"), repro.robot);
  repro.changes = changes_from(member(json, "changes"), repro);
  const Json& exploded = member(json, "exploded");
  repro.exploded_at = double_of(member(exploded, "time"));
  if (exploded.contains("first_bad_spring"))
    repro.culprit_spring = static_cast<std::uint32_t>(step_of(exploded["first_bad_spring"], 0));
  repro.last_step = step_of(member(exploded, "last_step"), repro.clock.step);
  repro.device_name = text_of(json, "device_name");
  return repro;
}

}  // namespace

std::string serialize_repro(const Repro& repro) {
  Json json{{"format", format}, {"version", version}};
  json["exploded"] = {{"time", repro.exploded_at}, {"last_step", repro.last_step}};
  if (repro.culprit_spring != no_spring) json["exploded"]["first_bad_spring"] = repro.culprit_spring;
  json["device_name"] = repro.device_name;
  json["configuration"] = json_of(repro.configuration);
  json["start"] = {{"step", repro.clock.step},
                   {"base_step", repro.clock.base_step},
                   {"base_time", repro.clock.base_time},
                   {"pulls", json_of(std::span<const Perturbation>(repro.perturbations))},
                   {"positions", json_of(std::span<const Vec3>(repro.state.positions))},
                   {"velocities", json_of(std::span<const Vec3>(repro.state.velocities))}};
  const auto own = materials_of(repro.robot);
  std::vector<Material> materials(own.begin(), own.end());
  json["changes"] = Json::array();
  // Changes of one step are of different kinds and do not depend on each other, so the document has them in one order.
  std::vector<ReproChange> changes = repro.changes;
  std::ranges::stable_sort(changes, {}, [](const ReproChange& c) {
    return std::pair(c.step, c.configuration ? 2 : c.perturbations ? 1 : 0);
  });
  for (const ReproChange& change : changes) json["changes"].push_back(json_of(change, materials));
  json["robot"] = Json::parse(serialize_robot(repro.robot, RobotFormat::json));
  return json.dump() + "\n";
}

Repro parse_repro(std::string_view document) {
  const Json json = Json::parse(document, nullptr, false);
  if (json.is_discarded()) throw InputError("is not a repro: not valid JSON");
  return repro_from(json);
}

Repro load_repro(const std::filesystem::path& path) {
  try {
    return parse_repro(read_whole_file(path));
  } catch (const InputError& error) {
    const std::string text = error.what();
    if (text.starts_with(path.string())) throw;
    throw InputError(path.string(), text);
  }
}

}  // namespace mercury
