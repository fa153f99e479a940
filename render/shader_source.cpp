// SPDX-License-Identifier: Apache-2.0
#include "render/shader_source.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

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

std::string shader_text(std::string_view name, const std::string& defines) {
  std::string text = "#version 450 core\n" + defines;
  std::vector<std::string_view> included;
  append(name, text, included);
  return text;
}

}  // namespace mercury::render
