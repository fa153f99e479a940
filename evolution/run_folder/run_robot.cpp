// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/run_robot.h"

#include <filesystem>
#include <string>

namespace mercury {

Robot run_robot(const RunHistory& run, std::uint64_t id) {
  const std::filesystem::path folder = std::filesystem::absolute(run.folder()).lexically_normal();
  const std::filesystem::path name = folder.has_filename() ? folder.filename() : folder.parent_path().filename();
  return run.genome(id)->grow(name.string() + "-" + std::to_string(id));
}

}  // namespace mercury
