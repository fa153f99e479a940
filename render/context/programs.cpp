// SPDX-License-Identifier: Apache-2.0
#include "render/context/programs.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace mercury::render {
namespace {

std::string_view source(std::string_view name) {
  for (const ShaderSource& candidate : shader_sources())
    if (candidate.name == name) return candidate.text;
  throw std::out_of_range("no shader is named " + std::string(name));
}

void append(std::string_view name, std::string& text, std::vector<std::string_view>& included) {
  if (std::find(included.begin(), included.end(), name) != included.end()) return;
  included.push_back(name);
  const std::string_view file = source(name);
  constexpr std::string_view directive = "#include \"";
  for (std::size_t begin = 0; begin < file.size();) {
    const std::size_t end = std::min(file.find('\n', begin), file.size());
    const std::string_view line = file.substr(begin, end - begin);
    if (line.starts_with(directive))
      append(line.substr(directive.size(), line.rfind('"') - directive.size()), text, included);
    else
      text.append(line).append("\n");
    begin = end + 1;
  }
}

}  // namespace

ProgramVariants::ProgramVariants(std::initializer_list<std::string_view> shaders, std::string defines)
    : shaders_(shaders), defines_(std::move(defines)) {}

GLuint ProgramVariants::get(const std::string& defines) const {
  const auto found = programs_.find(defines);
  if (found != programs_.end()) return found->second.get();
  return programs_.emplace(defines, make_program(shaders_, defines_ + defines)).first->second.get();
}

std::string define(std::string_view name, int value) {
  return "#define " + std::string(name) + " " + std::to_string(value) + "\n";
}

std::string shader_text(std::string_view name, const std::string& defines) {
  std::string text = "#version 450 core\n" + defines;
  std::vector<std::string_view> included;
  append(name, text, included);
  return text;
}

}  // namespace mercury::render
