// SPDX-License-Identifier: Apache-2.0
// Writes the sample robots: generate_library FOLDER, such as robots/library. Those for the paper's physics come into
// paper/.
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
    const std::filesystem::path folder = argv[1];
    for (const mercury::Robot& robot : mercury::library::animals())
      mercury::save_robot(folder / (robot.name + ".json"), robot);
    for (const mercury::Robot& robot : mercury::library::all_robots())
      mercury::save_robot(folder / "paper" / (robot.name + ".json"), robot);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "generate_library: %s\n", error.what());
    return 1;
  }
  return 0;
}
