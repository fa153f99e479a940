// SPDX-License-Identifier: Apache-2.0
#include "app/recording/configuration_json.h"

#include <charconv>
#include <string>

#include "app/recording/trajectory_layout.h"
#include "mercury/error.h"

namespace mercury {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(Vec3 v) { return Json::array({shortest(v.x), shortest(v.y), shortest(v.z)}); }

void add(Json& json, const Ocean& ocean) {
  json["density"] = shortest(ocean.density);
  json["drag_coefficient"] = shortest(ocean.drag_coefficient);
  json["lift_coefficient"] = shortest(ocean.lift_coefficient);
  json["flow"] = json_of(ocean.flow);
}

void add(Json& json, const OceanSimple& ocean) {
  json["point_drag"] = shortest(ocean.point_drag);
  json["flow"] = json_of(ocean.flow);
}

void add(Json& json, const Land& land) {
  json["friction"] = shortest(land.friction);
  json["self_collision"] = land.self_collision;
  json["contact_stiffness"] = shortest(land.contact_stiffness);
}

// A parameter of an environment from its member of a document.
struct Reader {
  const Json& json;
  void operator()(const std::string& name, float& value) const {
    if (json.contains(name)) value = static_cast<float>(number(name, json[name]));
  }
  void operator()(const std::string& name, bool& value) const {
    if (!json.contains(name)) return;
    if (!json[name].is_boolean()) throw InputError(name, "is not true or false");
    value = json[name].get<bool>();
  }
  void operator()(const std::string& name, Vec3& value) const {
    if (!json.contains(name)) return;
    const Json& list = json[name];
    if (!list.is_array() || list.size() != 3) throw InputError(name, "is not a list of three numbers");
    value = {static_cast<float>(number(name, list[0])), static_cast<float>(number(name, list[1])),
             static_cast<float>(number(name, list[2]))};
  }
  static double number(const std::string& name, const Json& value) {
    if (!value.is_number()) throw InputError(name, "is not a number");
    return value.get<double>();
  }
};

}  // namespace

double shortest(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double number = value;
  std::from_chars(text, end, number);
  return static_cast<float>(number) == value ? number : static_cast<double>(value);
}

Configuration configuration_from(const Json& json) {
  if (!json.is_object()) throw InputError("the configuration is not an object");
  const auto text = [&](const char* name, const std::string& otherwise) {
    if (!json.contains(name)) return otherwise;
    if (!json[name].is_string()) throw InputError(name, "is not a text");
    return json[name].get<std::string>();
  };
  Configuration configuration;
  configuration.device = device_named(text("device", "auto"));
  if (json.contains("threads"))
    configuration.device.threads = static_cast<int>(Reader::number("threads", json["threads"]));
  configuration.solver = solver_named(text("solver", "force"));
  configuration.environment = environment_named(text("environment", "ocean"));
  if (json.contains("dt")) configuration.dt = Reader::number("dt", json["dt"]);
  if (json.contains("damping")) configuration.damping = Reader::number("damping", json["damping"]);
  std::visit([&](auto& environment) { visit_parameters(environment, Reader{json}); }, configuration.environment);
  validate(configuration);
  return configuration;
}

nlohmann::ordered_json json_of(const Configuration& configuration) {
  Json json{{"device", name_of(configuration.device)}, {"threads", configuration.device.threads},
            {"solver", name_of(configuration.solver)}, {"dt", configuration.dt},
            {"damping", configuration.damping},        {"environment", name_of(configuration.environment)}};
  std::visit([&](const auto& environment) { add(json, environment); }, configuration.environment);
  json["gravity"] = json_of(gravity_of(configuration.environment));
  json["stiffness_scale"] = shortest(stiffness_scale_of(configuration.environment));
  return json;
}

}  // namespace mercury
