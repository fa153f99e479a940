// SPDX-License-Identifier: Apache-2.0
#include "app/base/interrupt.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <atomic>

#include "app/base/child_process.h"
#include "app/base/output_files.h"

namespace mercury {
namespace {

constexpr int slots = 64;  // unfinished files that a second signal removes, at most

std::atomic<int> first_signal = 0;
// The signal handler reads these. It may use only lock-free atomics and async-signal-safe functions such as unlink().
std::array<std::atomic<const char*>, slots> unfinished{};
std::atomic<unsigned> file_count = 0;  // for unique names

static_assert(std::atomic<const char*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void on_signal(int number) {
  if (int none = 0; first_signal.compare_exchange_strong(none, number)) return;
  kill_children();
  for (auto& slot : unfinished)
    if (const char* path = slot.load()) unlink(path);
  _exit(128 + number);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
}

bool interrupted() { return stop_signal() != 0; }

int stop_signal() { return first_signal.load(std::memory_order_relaxed); }

void throw_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

UnfinishedFile::UnfinishedFile(const std::filesystem::path& target) : target_(follow_links(target)), path_(target_) {
  path_ += fmt::format(".{}-{}.part", getpid(), file_count.fetch_add(1));
  for (int slot = 0; slot < slots && slot_ < 0; ++slot) {
    const char* empty = nullptr;
    if (unfinished[static_cast<std::size_t>(slot)].compare_exchange_strong(empty, path_.c_str())) slot_ = slot;
  }
}

UnfinishedFile::~UnfinishedFile() {
  if (!path_.empty()) unlink(path_.c_str());
  if (slot_ >= 0) unfinished[static_cast<std::size_t>(slot_)] = nullptr;
}

void UnfinishedFile::keep() {
  std::filesystem::rename(path_, target_);
  if (slot_ >= 0) unfinished[static_cast<std::size_t>(slot_)] = nullptr;
  slot_ = -1;
  path_.clear();
}

}  // namespace mercury
