// SPDX-License-Identifier: Apache-2.0
// The options that shape random voxel robots.
#pragma once

#include <CLI/CLI.hpp>

#include "mercury/random_voxel.h"

namespace mercury {

class VoxelOptions {
 public:
  // Adds the options to a command. The object must outlive it.
  void add_to(CLI::App& command);

  // What was chosen. Throws InputError naming the option that cannot be used.
  RandomVoxelOptions chosen() const;

 private:
  RandomVoxelOptions options_;
};

}  // namespace mercury
