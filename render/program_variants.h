// SPDX-License-Identifier: Apache-2.0
// One program in several variants, each compiled when it is first needed.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "render/gl_objects.h"

namespace mercury::render {

// Decisions that hold for a whole picture are made by #define in the shader's text and not by branches, because Mesa's
// software renderer executes both sides of every branch.
class ProgramVariants {
 public:
  // `defines`: for all variants.
  ProgramVariants(std::initializer_list<std::string_view> shaders, std::string defines);
  // The program with these additional lines of #define.
  GLuint get(const std::string& defines) const;

 private:
  std::vector<std::string_view> shaders_;
  std::string defines_;
  mutable std::map<std::string, Program> programs_;
};

// "#define NAME value\n"
std::string define(std::string_view name, int value);

}  // namespace mercury::render
