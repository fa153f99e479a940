// SPDX-License-Identifier: Apache-2.0
// What fuzzers do with the readers of files. Two programs run them: fuzz_readers (libFuzzer,
// tests/fuzz/fuzz_readers.cpp) and tests_fuzz, a short fixed number of runs among the tests.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mercury::fuzz {

struct Target {
  std::string_view name;        // "robot_json"
  std::string_view dictionary;  // in tests/fuzz/dictionaries, without ".dict"
  std::vector<std::string> (*seeds)();
  // Reads the input. Throws InputError if the reader refuses it; calls fail() if the reader breaks a promise, such as
  // that what is read can be written and reads back the same. Any other exception is a failure too.
  void (*check)(std::string_view input);
  bool quotes = false;  // messages may hold line ends of the input, which the program escapes
};

std::span<const Target> targets();
// Null if there is none.
const Target* find_target(std::string_view name);

// Calls check(), and fail() for errors that a user should not see. Returns why the input was refused; empty = it was
// read.
std::string run(const Target& target, std::string_view input);

// Prints a line and aborts.
[[noreturn]] void fail(const std::string& problem);
inline void require(bool holds, const std::string& problem) {
  if (!holds) fail(problem);
}

// A file of this process that readers open by its path, with the given content and a name that ends in `name`.
std::string scratch_file(std::string_view content, const std::string& name);
// The folder of such files, removed when the process ends. In the memory of the machine if possible.
const std::string& scratch_folder();
std::string content_of(const std::string& path);

void check_robot_json(std::string_view input);
void check_robot_cbor(std::string_view input);
void check_origin(std::string_view input);
void check_repro(std::string_view input);
void check_recording(std::string_view input);
void check_checkpoint(std::string_view input);
void check_run_file(std::string_view input);
void check_journal(std::string_view input);
void check_genome(std::string_view input);
void check_configuration_file(std::string_view input);
void check_camera(std::string_view input);
void check_session(std::string_view input);
void check_vxa(std::string_view input);
void check_vxd(std::string_view input);
void check_rsc(std::string_view input);
void check_evogym(std::string_view input);
void check_npz(std::string_view input);
void check_history(std::string_view input);
void check_scene(std::string_view input);
void check_result(std::string_view input);
void check_keys(std::string_view input);

std::vector<std::string> robot_json_seeds();
std::vector<std::string> robot_cbor_seeds();
std::vector<std::string> origin_seeds();
std::vector<std::string> repro_seeds();
std::vector<std::string> recording_seeds();
std::vector<std::string> checkpoint_seeds();
std::vector<std::string> run_file_seeds();
std::vector<std::string> journal_seeds();
std::vector<std::string> genome_seeds();
std::vector<std::string> configuration_file_seeds();
std::vector<std::string> camera_seeds();
std::vector<std::string> session_seeds();
std::vector<std::string> vxa_seeds();
std::vector<std::string> vxd_seeds();
std::vector<std::string> rsc_seeds();
std::vector<std::string> evogym_seeds();
std::vector<std::string> npz_seeds();
std::vector<std::string> history_seeds();
std::vector<std::string> scene_seeds();
std::vector<std::string> result_seeds();
std::vector<std::string> keys_seeds();

}  // namespace mercury::fuzz
