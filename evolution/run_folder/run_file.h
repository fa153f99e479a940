// SPDX-License-Identifier: Apache-2.0
// The file run.toml of a run folder, with the robots in founders/ that it names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mercury/run_folder.h"

namespace mercury {

inline constexpr int run_file_version = 2;  // version 1 has no jitter
inline constexpr std::string_view run_file_name = "run.toml", founders_name = "founders";

struct RunFile {
  RunSettings settings;
  // What the values of individuals in the journal are, in their order. Newer programs may know other quantities.
  std::vector<std::string> quantities;
  std::vector<std::string> founder_files;  // in founders/
  // Of everything that decides about the lineage, founders included. Comments, spaces, `generations`, `device`,
  // `threads` and the program's version do not count, so they may change.
  std::uint64_t fingerprint = 0;
};

// Throws InputError in one line with file and line for text that is no run.toml: unknown or missing keys, wrong types,
// values out of range, a newer version.
RunFile read_run_file(const std::filesystem::path& folder);

// The texts of a new run. Every number reads back bit for bit.
struct RunFileTexts {
  std::string run;                    // run.toml
  std::vector<std::string> founders;  // founders/0000.json, ...
};
RunFileTexts run_file_texts(const RunSettings& settings);
// "0000.json"
std::string founder_file_name(std::size_t index);
// What read_run_file() gives for these texts in a folder; `folder` is for messages.
RunFile parse_run_file(const std::filesystem::path& folder, const RunFileTexts& texts);

// The text of run.toml with another number of generations; nothing else changes. Throws InputError as read_run_file.
std::string with_generations(const std::filesystem::path& path, const std::string& text, int generations);

}  // namespace mercury
