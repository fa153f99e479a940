// SPDX-License-Identifier: Apache-2.0
#include "mercury/origin.h"

#include <nlohmann/json.hpp>

namespace mercury {
namespace {

std::string text_of(const Robot& robot, const char* key) {
  if (robot.origin.empty()) return {};
  // Keeps this key of the outermost object only; a tree of all weights of a network would be large.
  const auto keep = [&](int depth, nlohmann::json::parse_event_t event, nlohmann::json& value) {
    return event != nlohmann::json::parse_event_t::key || depth != 1 || value == key;
  };
  const auto origin = nlohmann::json::parse(robot.origin, keep, false);
  const auto found = origin.is_object() ? origin.find(key) : origin.end();
  return found != origin.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace

std::string kind_of(const Robot& robot) { return text_of(robot, "kind"); }
std::string environment_of(const Robot& robot) { return text_of(robot, "environment"); }

}  // namespace mercury
