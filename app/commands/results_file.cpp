// SPDX-License-Identifier: Apache-2.0
#include "app/commands/results_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include "app/base/interrupt.h"
#include "app/base/messages.h"
#include "app/base/standard_streams.h"
#include "robots/file/whole_file.h"

namespace mercury {
namespace {

bool is_named_pipe(const std::string& file) {
  struct stat status {};
  return ::stat(file.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
}

// A named pipe, open while an object of this class lives. Opening it would block until somebody reads, and Ctrl-C would
// not end that; so this asks again and again.
class PipeWithReader {
 public:
  explicit PipeWithReader(const std::string& file) {
    while (true) {
      descriptor_ = ::open(file.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
      if (descriptor_ >= 0 || errno != ENXIO) return;
      throw_if_interrupted();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  ~PipeWithReader() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  PipeWithReader(const PipeWithReader&) = delete;
  PipeWithReader& operator=(const PipeWithReader&) = delete;

 private:
  int descriptor_ = -1;
};

// A terminal would obey control characters in the names of robots; files and pipes get every byte.
void print_results(std::string_view content) {
  if (isatty(STDOUT_FILENO) == 0) return fmt::print("{}", content);
  while (!content.empty()) {
    const std::string_view line = content.substr(0, content.find('\n'));
    fmt::print("{}\n", printable(line, 8 * line.size()));
    content.remove_prefix(std::min(content.size(), line.size() + 1));
  }
}

}  // namespace

void write_results(const std::string& file, std::string_view content) {
  if (is_standard_output(file)) {
    print_results(content);
    return;
  }
  flush_results_so_far();  // what was printed so far is not lost if this takes long, or fails
  std::optional<PipeWithReader> pipe;
  if (is_named_pipe(file)) pipe.emplace(file);
  write_whole_file(file, content);
}

}  // namespace mercury
