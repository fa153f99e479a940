// SPDX-License-Identifier: Apache-2.0
#include "app/recording/configuration_json.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "mercury/error.h"
#include "mercury/number_text.h"

namespace mercury {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(float value) { return shortest(value); }
Json json_of(double value) { return value; }
Json json_of(int value) { return value; }
Json json_of(bool value) { return value; }

double number_from(const std::string& name, const Json& json) {
  if (!json.is_number()) throw InputError(name, "is not a number");
  return json.get<double>();
}

void read(const std::string& name, const Json& json, double& value) { value = number_from(name, json); }
void read(const std::string& name, const Json& json, float& value) {
  value = static_cast<float>(number_from(name, json));
}
void read(const std::string& name, const Json& json, int& value) {
  const double number = number_from(name, json);
  if (!(std::abs(number) <= std::numeric_limits<int>::max())) throw InputError(name, "is out of range");
  value = static_cast<int>(number);
}
void read(const std::string& name, const Json& json, bool& value) {
  if (!json.is_boolean()) throw InputError(name, "is not true or false");
  value = json.get<bool>();
}
void read(const std::string& name, const Json& json, Vec3& value) {
  if (!json.is_array() || json.size() != 3) throw InputError(name, "is not a list of three numbers");
  read(name, json[0], value.x);
  read(name, json[1], value.y);
  read(name, json[2], value.z);
}

template <class Struct>
void write_parameters(Json& json, const Struct& values) {
  for_each_parameter(
      values, [&](const auto& parameter, const auto& value) { json[std::string(parameter.name)] = json_of(value); });
}

template <class Struct>
void read_parameters(const Json& json, Struct& values) {
  for_each_parameter(values, [&](const auto& parameter, auto& value) {
    const std::string name(parameter.name);
    if (json.contains(name)) read(name, json[name], value);
  });
}

}  // namespace

Json json_of(Vec3 v) { return Json::array({shortest(v.x), shortest(v.y), shortest(v.z)}); }

Configuration configuration_from(const Json& json) {
  if (!json.is_object()) throw InputError("the configuration is not an object");
  const auto text = [&](const char* name, const std::string& otherwise) {
    if (!json.contains(name)) return otherwise;
    if (!json[name].is_string()) throw InputError(name, "is not a text");
    return json[name].get<std::string>();
  };
  Configuration configuration;
  configuration.device = device_named(text("device", "auto"));
  configuration.solver = solver_named(text("solver", "force"));
  configuration.environment = environment_named(text("environment", "ocean"));
  read_parameters(json, configuration.device);
  read_parameters(json, configuration);
  read_parameters(json, configuration.environment);
  validate(configuration);
  return configuration;
}

nlohmann::ordered_json json_of(const Configuration& configuration) {
  Json json;
  json["device"] = name_of(configuration.device);
  write_parameters(json, configuration.device);
  json["solver"] = name_of(configuration.solver);
  write_parameters(json, configuration);
  json["environment"] = name_of(configuration.environment);
  write_parameters(json, configuration.environment);
  return json;
}

std::string environment_text(const Configuration& configuration) {
  std::string text(name_of(configuration.environment));
  const nlohmann::ordered_json json = json_of(configuration);
  for (auto item = std::next(json.find("environment")); item != json.end(); ++item)
    text += fmt::format(", {} {}", item.key(), item.value().dump());
  return text;
}

std::string solver_text(const Configuration& configuration) {
  return fmt::format("{}, dt {} s, damping {} 1/s", name_of(configuration.solver), configuration.dt,
                     configuration.damping);
}

}  // namespace mercury
