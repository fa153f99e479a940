// SPDX-License-Identifier: Apache-2.0
#include "app/commands/program.h"

#include <pthread.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <string_view>

#include "app/commands/command_list.h"
#include "mercury/error.h"
#include "mercury/host_memory.h"
#include "mercury/names.h"

namespace mercury {
namespace {

std::string limit_of_threads() {
  const std::string memory = memory_limit_text();
  pthread_attr_t attributes;
  std::size_t stack = 0;
  if (memory.empty() || pthread_getattr_default_np(&attributes) != 0)
    return "the number of processes is limited (ulimit -u)";
  pthread_attr_getstacksize(&attributes, &stack);
  pthread_attr_destroy(&attributes);
  return "each needs " + std::to_string(stack >> 10) + " KiB of stack (ulimit -s), the limit is " + memory;
}

}  // namespace

std::string error_text(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) || dynamic_cast<const std::length_error*>(&error))
    return no_memory_line();
  if (const auto* file = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    const std::string path = (file->path2().empty() ? file->path1() : file->path2()).string();
    return (path.empty() ? "" : path + ": ") + reason_of(file->code().value());
  }
  const std::string_view text = error.what();
  // Of the standard library, and of oneTBB: "pthread_create has failed: ...".
  if (text == "Resource temporarily unavailable" || text.starts_with("pthread_create has failed"))
    return "no thread could be started: " + limit_of_threads() + "; give more, or fewer --threads";
  // "[json.exception.type_error.302] type must be number"
  if (const std::size_t end = text.find("] "); text.starts_with("[json.exception.") && end != text.npos)
    return std::string(text.substr(end + 2));
  return std::string(text);
}

std::string with_suggestion(const std::string& message, const Command& command) {
  const std::size_t colon = message.find(": \"");
  if (colon == std::string::npos || message.find("did you mean") != std::string::npos) return message;
  const std::size_t begin = colon + 3, end = message.find("\" is n", begin);  // "is not", "is neither"
  if (end == std::string::npos) return message;
  const std::string name = message.substr(0, colon), value = message.substr(begin, end - begin);
  const std::optional<Option> option = name.starts_with("-") ? command.find_option(name) : std::nullopt;
  if (!option) return message;
  const std::vector<std::string> choices = description_of(*option).choices;
  const std::string word = value.substr(0, value.find(':'));
  return std::ranges::find(choices, word) == choices.end() ? message + suggestion(word, choices) : message;
}

}  // namespace mercury
