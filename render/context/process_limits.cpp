// SPDX-License-Identifier: Apache-2.0
#include "render/context/context_headless.h"

#include <pthread.h>
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
void require_memory(rlim_t threads) {
  const auto require = [](auto resource, rlim_t mebibytes, const char* what, const char* command) {
    rlimit limit{};
    if (getrlimit(resource, &limit) == 0 && limit.rlim_cur >> 20 < mebibytes)
      throw ContextError("drawing on the processor needs " + std::to_string(mebibytes) + " MiB of " + what +
                         ", the limit is " + std::to_string(limit.rlim_cur >> 20) + " MiB (" + command + ")");
  };
  require(RLIMIT_AS, 1024, "address space", "ulimit -v");  // drawing was right from 1.0e9 bytes on
  pthread_attr_t attributes;
  std::size_t stack = std::size_t{8} << 20;
  if (pthread_getattr_default_np(&attributes) == 0) {
    pthread_attr_getstacksize(&attributes, &stack);
    pthread_attr_destroy(&attributes);
  }
  // With 2 MiB of stack, from 155 MB on, with 8 MiB, from 195 MB on.
  require(RLIMIT_DATA, 160 + threads * (stack >> 20), "data and stacks", "ulimit -d");
}

// Mesa waits for ever for threads that it could not start, where `ulimit -u` leaves too few. As many as it starts, and
// some for the program, must start at the same time.
void require_threads(unsigned needed) {
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
  const unsigned threads = std::clamp(std::thread::hardware_concurrency(), 1u, 32u) + 8;
  require_memory(threads);
  require_threads(threads);
}

}  // namespace mercury::render
