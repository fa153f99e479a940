// SPDX-License-Identifier: Apache-2.0
// Runs the real program as a child process.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <source_location>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/base/child_process.h"
#include "mercury/host_memory.h"
#include "tests/folder.h"
#include "tests/nap.h"

namespace mercury::test {

using Arguments = std::vector<std::string>;

inline Arguments joined(Arguments first, const Arguments& second, const Arguments& third = {}) {
  for (const Arguments* more : {&second, &third}) first.insert(first.end(), more->begin(), more->end());
  return first;
}

struct Outcome {
  int status = -1;       // exit status; 128 + n when killed by signal n
  std::string output;    // standard output
  std::string messages;  // standard error
};

inline void PrintTo(const Outcome& outcome, std::ostream* out) {
  *out << "status " << outcome.status << "\n" << outcome.output << outcome.messages;
}

// A program that ends with this status and one line of messages: "mercury: " and `line`, a text or a matcher. What
// refuses its input (status 2) prints nothing else.
MATCHER_P2(Ends, status, line,
           "ends with status " + testing::PrintToString(status) + " and a line that " +
               testing::DescribeMatcher<std::string>(line)) {
  const std::string begin = "mercury: ";
  const auto& messages = arg.messages;
  return arg.status == status && (status != 2 || arg.output.empty()) && messages.starts_with(begin) &&
         messages.find('\n') + 1 == messages.size() &&
         testing::ExplainMatchResult(line, messages.substr(begin.size(), messages.size() - begin.size() - 1),
                                     result_listener);
}

inline Outcome outcome_of(ChildProcess& child) {
  const int status = child.finish();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), child.output(), child.messages()};
}

inline Outcome run_program(const std::string& program, const std::vector<std::string>& arguments) {
  ChildProcess child(program, arguments);
  return outcome_of(child);
}

inline Outcome mercury(const std::vector<std::string>& arguments) { return run_program(MERCURY_PROGRAM, arguments); }

// The program at work: a line of progress shows that it has begun.
inline std::unique_ptr<ChildProcess> working_mercury(const std::vector<std::string>& arguments) {
  setenv("MERCURY_PROGRESS_SECONDS", "0.5", 1);
  auto child = std::make_unique<ChildProcess>(MERCURY_PROGRAM, arguments);
  unsetenv("MERCURY_PROGRESS_SECONDS");
  while (child->running() && child->messages().empty()) nap();
  return child;
}

// The outcome of a program that must succeed; ends the test if it did not.
inline Outcome succeeded(const Outcome& outcome, const std::source_location& where = std::source_location::current()) {
  if (outcome.status != 0)
    throw std::runtime_error(std::string(where.file_name()) + ":" + std::to_string(where.line()) + ": " +
                             testing::PrintToString(outcome));
  return outcome;
}

// The programs and children of a test that get no memory end with other results than expected.
class FolderTest : public TestWithFolder {
 protected:
  ~FolderTest() override {
    if (HasFailure()) std::cerr << "The machine has " << available_host_memory() / 1'000'000 << " MB of memory left.\n";
  }
};

// The first stream of a video as ffprobe describes it; frames are counted by decoding them ("nb_read_frames").
inline nlohmann::json probe(const std::string& path) {
  const std::string text = output_of("ffprobe", {"-v", "error", "-count_frames", "-show_streams", "-of", "json", path});
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded() || json.value("streams", nlohmann::json::array()).empty()) return nlohmann::json::object();
  return json["streams"][0];
}

}  // namespace mercury::test
