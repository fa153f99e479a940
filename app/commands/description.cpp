// SPDX-License-Identifier: Apache-2.0
#include "app/commands/description.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/base/messages.h"
#include "app/recording/configuration_json.h"

namespace mercury {

void print_heading(const std::string& text) { fmt::print("{}\n", printable(text)); }

void print_line(const std::string& what, const std::string& text) { fmt::print("  {:<12}{}\n", what, printable(text)); }

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
