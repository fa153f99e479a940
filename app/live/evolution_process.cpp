// SPDX-License-Identifier: Apache-2.0
#include "app/live/evolution_process.h"

#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>

#include <cerrno>
#include <chrono>
#include <system_error>
#include <thread>

#include "app/live/command_text.h"

namespace mercury {
namespace {

namespace fs = std::filesystem;

constexpr auto most_patience = std::chrono::seconds(10);  // with a process that was asked to stop

// The last line that has text. Lines of progress end with a carriage return.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n ");
  if (end == std::string::npos) return {};
  const std::size_t before = text.find_last_of("\r\n", end);
  return text.substr(before == std::string::npos ? 0 : before + 1,
                     end - (before == std::string::npos ? 0 : before + 1) + 1);
}

}  // namespace

std::vector<std::string> evolve_arguments(const EvolveRequest& request, const Configuration& configuration,
                                          const fs::path& founders) {
  std::vector<std::string> words{"evolve", request.folder.string()};
  const auto add = [&](const std::string& option, const std::string& value) {
    words.push_back(value.empty() ? option : fmt::format("{}={}", option, value));
  };
  add("--from", founders.string());
  add("--algorithm", request.algorithm);
  add("--genes", request.genes);
  add("--objective", request.objective);
  add("--population", std::to_string(request.population));
  add("--generations", std::to_string(request.generations));
  add("--seconds", fmt::format("{}", request.seconds));
  add("--quiet", "");
  for (const auto& [option, value] : options_of(configuration)) add(option, value);
  return words;
}

fs::path this_program() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path("mercury") : program;
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "mercury-XXXXXX").string();
  if (!mkdtemp(name.data())) throw std::system_error(errno, std::generic_category(), name);
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

EvolutionProcess::~EvolutionProcess() {
  stop();
  const auto begin = std::chrono::steady_clock::now();
  while (running() && std::chrono::steady_clock::now() - begin < most_patience)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

// SIGTERM does what SIGINT does (app/base/interrupt.h), and is not ignored in jobs of shell scripts.
void EvolutionProcess::stop() {
  if (!std::exchange(stopped_, true)) process_.signal(SIGTERM);
}

std::string EvolutionProcess::failure() {
  const int status = process_.finish();
  if (status == 0 || stopped_) return {};
  std::string line = last_line(process_.messages());
  if (line.starts_with("mercury: ")) line.erase(0, 9);
  return line.empty() ? "mercury evolve " + describe_exit(status) : line;
}

}  // namespace mercury
