// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <system_error>

#include "evolution/run_folder/champion_checks.h"
#include "evolution/run_folder/derived_files.h"
#include "evolution/run_folder/journal.h"
#include "evolution/run_folder/run_file.h"
#include "mercury/error.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

void remove_file(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) fail(path, error.value());
}

// Removes the files of a folder that have names such as "0012-000345.json", and the folder if nothing is left.
void remove_numbered_robots(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == ".json" && stem.find_first_not_of("0123456789-") == std::string::npos)
      remove_file(entry.path());
  }
  if (!error && fs::is_empty(folder, error)) remove_file(folder);
}

void remove_run(const fs::path& folder) {
  remove_file(folder / run_file_name);  // first: a run that is half removed is no run
  remove_numbered_robots(folder / founders_name);
  remove_numbered_robots(folder / champions_name);
  for (const std::string_view name : derived_file_names) remove_file(folder / name);
  remove_file(folder / checks_name);
  remove_file(folder / journal_name);
}

// What a process leaves that was killed while it made a folder: a journal without a record, founders, but no settings.
bool is_unfinished(const fs::path& folder) {
  if (is_run_folder(folder)) return false;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool is_journal =
        name == journal_name && entry.is_regular_file(error) && entry.file_size(error) <= journal_header_size;
    // ".run.toml..." is a temporary name (robots/file/whole_file.h).
    if (!is_journal && name != founders_name && name.find(run_file_name) != 1) return false;
  }
  return !error && fs::exists(folder / journal_name, error);
}

// Locks the journal of a run that is to be replaced, if it has one.
std::optional<JournalWriter> lock_of(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder / journal_name, error)) return std::nullopt;
  return JournalWriter::open(folder / journal_name);
}

void write_settings(const fs::path& folder, const RunFileTexts& texts) {
  if (!texts.founders.empty()) make_folder(folder / founders_name);
  for (std::size_t i = 0; i < texts.founders.size(); ++i)
    write_whole_file(folder / founders_name / founder_file_name(i), texts.founders[i]);
  write_whole_file(folder / run_file_name, texts.run);  // last: now it is a run
  sync_folder(folder);
}

}  // namespace

void require_new_folder(const fs::path& folder, bool force) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error)) throw InputError(folder.string(), "is a file; give a new folder");
  if ((force && is_run_folder(folder)) || is_unfinished(folder)) return;
  const bool is_empty = fs::directory_iterator(folder, error) == fs::directory_iterator();
  if (error) fail(folder, error.value());
  if (!is_empty)
    throw InputError(folder.string(), is_run_folder(folder)
                                          ? "holds a run; give --resume to go on with it or --force to replace it"
                                          : "is not empty; give a new folder");
}

JournalWriter make_run_folder(const fs::path& folder, const RunSettings& settings, bool force) {
  const RunFileTexts texts = run_file_texts(settings);
  const RunFile file = parse_run_file(folder, texts);
  require_new_folder(folder, force);
  make_folder(folder);
  if ((force && is_run_folder(folder)) || is_unfinished(folder)) {
    const std::optional<JournalWriter> lock = lock_of(folder);
    remove_run(folder);
  }
  JournalWriter journal = JournalWriter::create(folder / journal_name, file.fingerprint);
  try {
    write_settings(folder, texts);
  } catch (...) {
    remove_run(folder);
    throw;
  }
  return journal;
}

}  // namespace mercury
