// SPDX-License-Identifier: Apache-2.0
#include "app/base/interrupt.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <string_view>

#include "app/base/child_process.h"
#include "mercury/file_links.h"

namespace mercury {
namespace {

constexpr itimerval time_to_stop{.it_interval = {}, .it_value = {.tv_sec = 0, .tv_usec = 500'000}};
constexpr int slots = 64;  // unfinished files that a second signal removes, at most

std::atomic<int> first_signal = 0;
std::atomic<int> unsaved_results = 0;
std::atomic<bool> waits_for_work = false;
// The signal handler reads these. It may use only lock-free atomics and async-signal-safe functions such as unlink().
std::array<std::atomic<const char*>, slots> unfinished{};
std::atomic<unsigned> file_count = 0;  // for unique names

static_assert(std::atomic<const char*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

// On a line of its own, since a progress bar may stand on the current one.
void write_message(std::string_view text) {
  if (!isatty(STDERR_FILENO)) text.remove_prefix(1);
  const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
  static_cast<void>(ignored);
}

[[noreturn]] void end_at_once(int number) {
  kill_children();
  for (auto& slot : unfinished)
    if (const char* path = slot.load()) unlink(path);
  _exit(128 + number);
}

void on_signal(int number) {
  if (int none = 0; !first_signal.compare_exchange_strong(none, number)) end_at_once(number);
  if (!waits_for_work) setitimer(ITIMER_REAL, &time_to_stop, nullptr);
}

void on_time_over(int) {
  if (unsaved_results > 0) {
    write_message("\nmercury: stopping, to keep the results so far; another signal drops them\n");
  } else {
    write_message("\nmercury: stopped\n");
    end_at_once(first_signal);
  }
}

}  // namespace

void catch_interrupts(bool patient) {
  waits_for_work = patient;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
  action.sa_handler = on_time_over;
  sigaction(SIGALRM, &action, nullptr);
  // A write beyond `ulimit -f` fails with EFBIG and is reported like a full disk. Children get the signal as before,
  // since handlers, unlike SIG_IGN, are not inherited.
  action.sa_handler = [](int) {};
  sigaction(SIGXFSZ, &action, nullptr);
}

bool interrupted() { return stop_signal() != 0; }

int stop_signal() { return first_signal.load(std::memory_order_relaxed); }

void throw_if_interrupted() {
  if (interrupted()) throw Interrupted();
}

void UnsavedResults::begin() {
  if (!begun_) ++unsaved_results;
  begun_ = true;
}

UnsavedResults::~UnsavedResults() {
  if (begun_) --unsaved_results;
}

UnfinishedFile::UnfinishedFile(const std::filesystem::path& target)
    : target_(follow_links(target)), path_(target_), replaces_(std::filesystem::exists(target)) {
  path_ += fmt::format(".{}-{}.part", getpid(), file_count.fetch_add(1));
  for (int slot = 0; slot < slots && slot_ < 0; ++slot) {
    const char* empty = nullptr;
    if (unfinished[static_cast<std::size_t>(slot)].compare_exchange_strong(empty, path_.c_str())) slot_ = slot;
  }
}

UnfinishedFile::~UnfinishedFile() {
  if (!path_.empty()) unlink(path_.c_str());
  release();
}

void UnfinishedFile::release() {
  if (slot_ >= 0) unfinished[static_cast<std::size_t>(slot_)] = nullptr;
  slot_ = -1;
  path_.clear();
}

void UnfinishedFile::keep() {
  try {
    publish(path_, target_, replaces_);
  } catch (const NameTaken&) {
    release();
    throw;
  }
  release();
}

}  // namespace mercury
