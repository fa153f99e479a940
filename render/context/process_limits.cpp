// SPDX-License-Identifier: Apache-2.0
#include "render/context/process_limits.h"

#include <sys/resource.h>

#include <algorithm>
#include <future>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "render/context/context.h"

namespace mercury::render {
namespace {

// Mesa and the compiler in it do not check what they allocate: they crash or hang where `ulimit -v` leaves too little.
void require_address_space() {
  constexpr rlim_t needed = rlim_t{1} << 30;  // drawing was right from 1.0e9 bytes on
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur < needed)
    throw ContextError("drawing on the processor needs 1 GiB of address space, the limit is " +
                       std::to_string(limit.rlim_cur >> 20) + " MiB (ulimit -v)");
}

// Mesa waits for ever for threads that it could not start, where `ulimit -u` leaves too few. As many as it starts, and
// some for the program, must start at the same time.
void require_threads() {
  const unsigned needed = std::clamp(std::thread::hardware_concurrency(), 1u, 32u) + 8;
  std::promise<void> end;
  const std::shared_future<void> ended = end.get_future().share();
  std::vector<std::thread> threads;
  bool all = true;
  try {
    while (threads.size() < needed) threads.emplace_back([ended] { ended.wait(); });
  } catch (const std::system_error&) {
    all = false;
  }
  end.set_value();
  const std::size_t started = threads.size();
  for (std::thread& thread : threads) thread.join();
  if (!all)
    throw ContextError("drawing on the processor needs " + std::to_string(needed) + " threads, " +
                       std::to_string(started) + " could be started: the number of processes is limited (ulimit -u)");
}

}  // namespace

void require_room_to_draw() {
  require_address_space();
  require_threads();
}

}  // namespace mercury::render
