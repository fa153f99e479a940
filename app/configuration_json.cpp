#include "app/configuration_json.h"

#include <charconv>

namespace mercury {
namespace {

using Json = nlohmann::ordered_json;

// The shortest decimal that gives this float again: 0.2, not 0.20000000298023224.
double shortest(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double number = value;
  std::from_chars(text, end, number);
  return number;
}

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

}  // namespace

nlohmann::ordered_json json_of(const Configuration& configuration) {
  Json json{{"device", name_of(configuration.device)},
            {"threads", configuration.device.threads},
            {"solver", name_of(configuration.solver)},
            {"dt", configuration.dt},
            {"damping", configuration.damping},
            {"environment", name_of(configuration.environment)}};
  std::visit([&](const auto& environment) { add(json, environment); }, configuration.environment);
  json["gravity"] = json_of(gravity_of(configuration.environment));
  json["stiffness_scale"] = shortest(stiffness_scale_of(configuration.environment));
  return json;
}

}  // namespace mercury
