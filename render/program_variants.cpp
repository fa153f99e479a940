// SPDX-License-Identifier: Apache-2.0
#include "render/program_variants.h"

#include <utility>

namespace mercury::render {

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

}  // namespace mercury::render
