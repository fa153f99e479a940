// SPDX-License-Identifier: Apache-2.0
#include "app/window/toolkit/embedded.h"

#include "mercury/origin.h"
#include "mercury/robot_file.h"

namespace mercury::window {

std::string_view embedded_file(std::string_view name) {
  for (const EmbeddedFile& file : embedded_files())
    if (file.name == name) return file.contents;
  return {};
}

std::vector<Robot> sample_robots(std::string_view environment) {
  std::vector<Robot> robots;
  for (const EmbeddedFile& file : embedded_files()) {
    const std::optional<RobotFormat> format = find_robot_format(file.name);
    if (!format) continue;
    Robot robot = parse_robot(file.contents, *format);
    if (environment.empty() || environment_of(robot) == environment) robots.push_back(std::move(robot));
  }
  return robots;
}

}  // namespace mercury::window
