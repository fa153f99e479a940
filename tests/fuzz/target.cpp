// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/target.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "mercury/error.h"

namespace mercury::fuzz {
namespace {

// Words of libraries, which say nothing to a user.
constexpr std::array foreign_words{"json.exception", "std::",   "basic_string", "vector::", "bad_alloc",
                                   "bad_optional",   "CLI::",   "toml::",       "H5E",      "filesystem error",
                                   "terminate",      "__throw", "stod",         "stoi"};

// "toml::" counts with a name behind it: a name of the input that ends in ':' may stand before the colon of a message.
bool names(const std::string& message, std::string_view word) {
  for (std::size_t at = message.find(word); at != std::string::npos; at = message.find(word, at + 1)) {
    const std::size_t next = at + word.size();
    if (!word.ends_with("::") || (next < message.size() && message[next] != ' ')) return true;
  }
  return false;
}

class ScratchFolder {
 public:
  ScratchFolder() {
    const bool memory = access("/dev/shm", W_OK) == 0;
    path_ =
        (memory ? std::string("/dev/shm") : std::filesystem::temp_directory_path().string()) + "/mercury-fuzz-XXXXXX";
    if (!mkdtemp(path_.data())) {
      std::perror(path_.c_str());
      std::_Exit(1);
    }
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// A message without what it quotes of the input.
std::string unquoted(const std::string& message) {
  std::string text;
  bool quoted = false;
  for (const char letter : message) {
    if (letter == '"') quoted = !quoted;
    if (!quoted) text += letter;
  }
  return text;
}

}  // namespace

std::span<const Target> targets() {
  static constexpr std::array all{
      Target{"robot_json", "robot", robot_json_seeds, check_robot_json},
      Target{"robot_cbor", "robot", robot_cbor_seeds, check_robot_cbor},
      Target{"origin", "robot", origin_seeds, check_origin},
      Target{"repro", "repro", repro_seeds, check_repro},
      Target{"recording", "recording", recording_seeds, check_recording},
      Target{"checkpoint", "recording", checkpoint_seeds, check_checkpoint},
      Target{"run_file", "run_file", run_file_seeds, check_run_file},
      Target{"journal", "journal", journal_seeds, check_journal},
      Target{"genome", "journal", genome_seeds, check_genome},
      Target{"configuration", "toml", configuration_file_seeds, check_configuration_file, true},
      Target{"camera", "camera", camera_seeds, check_camera},
      Target{"session", "toml", session_seeds, check_session},
      Target{"vxa", "vxa", vxa_seeds, check_vxa},
      Target{"vxd", "vxa", vxd_seeds, check_vxd},
      Target{"rsc", "vxa", rsc_seeds, check_rsc},
      Target{"evogym", "robot", evogym_seeds, check_evogym},
      Target{"npz", "history", npz_seeds, check_npz, true},
      Target{"history", "history", history_seeds, check_history},
      Target{"scene", "toml", scene_seeds, check_scene},
      Target{"result", "repro", result_seeds, check_result},
      Target{"keys", "keys", keys_seeds, check_keys}};
  return all;
}

const Target* find_target(std::string_view name) {
  for (const Target& target : targets())
    if (target.name == name) return &target;
  return nullptr;
}

std::string run(const Target& target, std::string_view input) {
  try {
    target.check(input);
    return {};
  } catch (const InputError& error) {
    const std::string message = error.what();
    require(!message.empty(), "an empty message");
    const std::size_t longest = target.name.starts_with("robot") ? 250 : 1000;
    require(message.size() < longest, "a long message: " + message.substr(0, 500));
    require(target.quotes ||
                std::ranges::none_of(unquoted(message), [](char letter) { return letter >= 0 && letter < ' '; }),
            "a message of more than one line: " + message.substr(0, 500));
    for (const char* word : foreign_words)
      require(!names(unquoted(message), word) || input.find(word) != std::string::npos,
              "a message with words of a library: " + message.substr(0, 500));
    return message;
  } catch (const std::exception& error) {
    fail(std::string("another exception: ") + error.what());
  }
}

void fail(const std::string& problem) {
  std::fprintf(stderr, "FAILED: %s\n", problem.c_str());
  std::abort();
}

const std::string& scratch_folder() {
  static const ScratchFolder folder;
  return folder.path();
}

std::string scratch_file(std::string_view content, const std::string& name) {
  std::string path = scratch_folder() + "/" + name;
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  require(!file.flush().fail(), "the scratch folder cannot be written");
  return path;
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace mercury::fuzz
