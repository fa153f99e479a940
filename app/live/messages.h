// SPDX-License-Identifier: Apache-2.0
// Messages for the user, from any part of the window.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace mercury {

enum class Severity { note, warning, error };

struct Message {
  Severity severity = Severity::note;
  std::string text;  // one line
};

// Thread-safe: any thread adds messages, the window takes them.
class Messages {
 public:
  void add(Severity severity, std::string text) {
    for (char& letter : text)
      if (letter == '\n' || letter == '\r') letter = ' ';
    const std::lock_guard lock(mutex_);
    if (messages_.size() < most) messages_.push_back({severity, std::move(text)});
  }
  std::vector<Message> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(messages_, {});
  }

 private:
  static constexpr std::size_t most =
      1000;  // a folder of unreadable files must not fill the memory; later messages are dropped
  std::mutex mutex_;
  std::vector<Message> messages_;
};

}  // namespace mercury
