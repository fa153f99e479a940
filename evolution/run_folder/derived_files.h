// SPDX-License-Identifier: Apache-2.0
// The files of a run folder that follow from run.toml and the journal. Each is written whole, so readers find the whole
// old file or the whole new one, and a file that is lost or damaged is made again.
#pragma once

#include <array>
#include <chrono>
#include <string_view>

#include "mercury/run_folder.h"

namespace mercury {

inline constexpr std::string_view lineage_name = "lineage.csv", generations_name = "generations.csv",
                                  progress_name = "progress.svg", champions_name = "best";
inline constexpr std::array derived_file_names{lineage_name, generations_name, progress_name};

class DerivedFiles {
 public:
  // Champions are written at once. The other files wait until 20 times as long has passed as writing them took.
  void write_now_and_then(const RunHistory& run);
  // Writes them all.
  void write(const RunHistory& run);

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point next_ = Clock::time_point::min();
};

}  // namespace mercury
