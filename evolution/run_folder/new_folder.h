// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "evolution/run_folder/journal.h"
#include "mercury/run_folder.h"

namespace mercury {

// Throws InputError unless make_run_folder() may use the folder: it is new or empty, or, with `force`, holds a run.
// Makes nothing.
void require_new_folder(const std::filesystem::path& folder, bool force);

// Makes the folder with run.toml, founders/ and an empty journal, which it returns locked. Throws InputError if the
// folder exists and is not empty; with `force`, the files of a run in it are removed first, unless another process
// writes there. Everything that can be refused is refused before that.
JournalWriter make_run_folder(const std::filesystem::path& folder, const RunSettings& settings, bool force);

}  // namespace mercury
