// SPDX-License-Identifier: Apache-2.0
#include "evolution/run_folder/derived_files.h"

#include "evolution/run_folder/champions.h"
#include "evolution/run_folder/progress_plot.h"
#include "evolution/run_folder/tables.h"
#include "robots/whole_file.h"

namespace mercury {

void DerivedFiles::write_now_and_then(const RunHistory& run) {
  write_champions(run);
  if (Clock::now() >= next_) write(run);
}

void DerivedFiles::write(const RunHistory& run) {
  constexpr int pauses = 20;  // as long as the writing, so that it takes at most a 21st part of the time
  const Clock::time_point start = Clock::now();
  write_champions(run);
  write_lineage(run);
  write_generations(run);
  write_whole_file(run.folder() / progress_name, progress_plot(run));
  const Clock::time_point end = Clock::now();
  next_ = end + pauses * (end - start);
}

}  // namespace mercury
