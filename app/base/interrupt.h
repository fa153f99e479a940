// SPDX-License-Identifier: Apache-2.0
// Ctrl-C, kill and a closed terminal: work in progress ends in an orderly way.
//
//   first signal    sets a flag; loops that ask interrupted() stop and finish their files. Work that has not stopped
//                   after half a second is ended, unless there are UnsavedResults.
//   second signal   ends the program at once
//
// Where the program is ended, child processes are killed and unfinished files are removed.
#pragma once

#include <exception>
#include <filesystem>

namespace mercury {

// Installs the handlers of SIGINT, SIGTERM and SIGHUP. A signal that was ignored when the program started (nohup) stays
// ignored. With `patient`, work is never ended after a first signal: for processes that somebody else ends.
void catch_interrupts(bool patient = false);

// True once a signal has arrived.
bool interrupted();
// The number of the first signal; 0 = none has arrived.
int stop_signal();

// The user stopped the work.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "stopped"; }
};
// Throws Interrupted once a signal has arrived: for work that leaves nothing to finish.
void throw_if_interrupted();

// Results that an end would lose. From begin() to the destructor, a first signal waits for the work to stop by itself.
class UnsavedResults {
 public:
  UnsavedResults() = default;
  ~UnsavedResults();
  UnsavedResults(const UnsavedResults&) = delete;
  UnsavedResults& operator=(const UnsavedResults&) = delete;
  void begin();  // may be called again

 private:
  bool begun_ = false;
};

// A file under a temporary name until it is complete. It is removed if the program ends earlier, by an exception or by
// a second signal.
class UnfinishedFile {
 public:
  // Chooses path(): in the folder of `target`, links followed, with its name and this process's id. Does not create the
  // file.
  explicit UnfinishedFile(const std::filesystem::path& target);
  ~UnfinishedFile();  // removes the file unless keep() was called
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Gives the file its name, and replaces the one that had it from the beginning: publish() of mercury/file_links.h.
  void keep();

 private:
  void release();
  std::filesystem::path target_, path_;
  bool replaces_;  // the target existed from the beginning
  int slot_ = -1;
};

}  // namespace mercury
