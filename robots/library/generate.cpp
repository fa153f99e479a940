// SPDX-License-Identifier: Apache-2.0
// Writes the sample robots: generate_library FOLDER
#include <cstdio>
#include <exception>
#include <filesystem>

#include "mercury/robot_file.h"
#include "robots/library/designs.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: generate_library FOLDER\n");
    return 2;
  }
  try {
    for (const mercury::Robot& robot : mercury::library::all_robots())
      mercury::save_robot(std::filesystem::path(argv[1]) / (robot.name + ".json"), robot);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "generate_library: %s\n", error.what());
    return 1;
  }
  return 0;
}
