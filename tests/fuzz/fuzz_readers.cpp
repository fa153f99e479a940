// SPDX-License-Identifier: Apache-2.0
// libFuzzer's entry points: fuzz_readers --target=NAME [options of libFuzzer] [FOLDER...]
//
//     --target=NAME     what to fuzz
//     --list            prints the names of all targets with their dictionaries, and ends
//     --seeds=FOLDER    writes the seeds of the target there, and ends
//
// Does nothing as root: it becomes the user nobody first.
#include <grp.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>

#include "tests/fuzz/target.h"

namespace mercury::fuzz {
namespace {

const Target* target = nullptr;

void drop_privileges() {
  if (geteuid() != 0 && getuid() != 0) return;
  constexpr unsigned nobody = 65534;
  if (setgroups(0, nullptr) != 0 || setresgid(nobody, nobody, nobody) != 0 || setresuid(nobody, nobody, nobody) != 0)
    fail("runs as root and cannot become the user nobody");
  prctl(PR_SET_DUMPABLE, 1);  // for /proc/self, which sanitizers read
}

[[noreturn]] void list() {
  for (const Target& known : targets())
    std::printf("%s %s\n", std::string(known.name).c_str(), std::string(known.dictionary).c_str());
  std::exit(0);
}

[[noreturn]] void write_seeds(const std::string& folder) {
  const std::vector<std::string> seeds = target->seeds();
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    std::ofstream file(folder + "/seed-" + std::to_string(i), std::ios::binary);
    file.write(seeds[i].data(), static_cast<std::streamsize>(seeds[i].size()));
    require(!file.flush().fail(), folder + " cannot be written");
  }
  std::exit(0);
}

}  // namespace
}  // namespace mercury::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments);
extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
  using namespace mercury::fuzz;
  drop_privileges();
  std::string seeds;
  for (int i = 1; i < *count; ++i) {
    const std::string_view argument = (*arguments)[i];
    if (argument == "--list") list();
    if (argument.starts_with("--target=")) target = find_target(argument.substr(9));
    if (argument.starts_with("--seeds=")) seeds = argument.substr(8);
  }
  if (!target) fail("give --target=NAME; --list lists them");
  if (!seeds.empty()) write_seeds(seeds);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mercury::fuzz::run(*mercury::fuzz::target, {reinterpret_cast<const char*>(data), size});
  return 0;
}

// HDF5 loses memory over damaged files.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; }
