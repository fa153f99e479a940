// SPDX-License-Identifier: Apache-2.0
// The files that a command is about to write, checked before its work begins: nobody loses a file, or hours of work
// to a name that cannot be used.
//
//   new name         is written; missing folders are made
//   existing file    is replaced with --force, or if the user agrees on the terminal; never if it is write-protected,
//                    or one that the command reads
//   device, pipe     is written directly; "-" and "/dev/stdout" stand for standard output
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/csv.h"

namespace mercury {

// "-" and "/dev/stdout" stand for standard output.
bool is_standard_output(std::string_view file);

class OutputFiles {
 public:
  // `force`: existing files may be replaced. `may_ask`: otherwise the user is asked, if there is a terminal.
  explicit OutputFiles(bool force, bool may_ask = true) : force_(force), may_ask_(may_ask) {}

  // What the command reads, and therefore must not write. A folder stands for the robot files in it and in the folders
  // inside it. Names that do not exist are passed over.
  void add_input(const std::filesystem::path& input) { inputs_.push_back(input); }
  // A file that is written from its start to its end: it may be a device, a pipe or standard output.
  // `inside`: the folder where the program, not the user, gave the file its name; empty = none. Links must not lead
  // from there to somewhere else. Likewise below.
  void add_stream(const std::string& option, const std::string& file, const std::filesystem::path& inside = {});
  // A file that is not, such as a video: the encoder goes back in it.
  void add_file(const std::string& option, const std::string& file, const std::filesystem::path& inside = {});
  // A folder whose files have names of their own.
  void add_folder(const std::string& option, const std::string& folder);
  // A folder that is filled, and must be new or empty.
  void add_new_folder(const std::string& option, const std::string& folder, const std::filesystem::path& inside = {});

  // Throws InputError that begins with the option for the first output that cannot be written, and for one that exists
  // unless it may be replaced. Writes and creates nothing; notes which names are free, so that files of other programs
  // that have them at the end are kept, see publish(). Returns whether existing files may be replaced.
  bool check() const;
  // Makes the missing folders of all outputs. Throws InputError.
  void make_folders() const;

 private:
  enum class Kind { stream, file, folder, new_folder };
  struct Output {
    std::string option, name;
    Kind kind;
    std::filesystem::path target;  // without links
    std::filesystem::path inside;
    bool is_folder() const { return kind == Kind::folder || kind == Kind::new_folder; }
  };
  void add(const std::string& option, const std::string& name, Kind kind, const std::filesystem::path& inside = {});
  void require_usable(const Output& output) const;
  void require_no_input() const;
  void require_distinct() const;
  void require_replaceable(const std::vector<const Output*>& existing) const;

  std::vector<Output> outputs_;
  std::vector<std::filesystem::path> inputs_;
  bool force_, may_ask_;
};

// Calls write(), which writes the file. Returns the name that it has: where another program has taken it in the
// meantime, another one, which a warning says (NameTaken).
std::filesystem::path name_given(const std::filesystem::path& file, const std::function<void()>& write);

// Numbers in tables of CSV, whose texts are mercury/csv.h's, and bytes in texts.

// The shortest text that reads back as this number; empty if it is not finite, which programs read as missing.
std::string csv_number(double value);

// In base64 (RFC 4648).
std::string base64(std::string_view bytes);

}  // namespace mercury
