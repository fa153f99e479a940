// SPDX-License-Identifier: Apache-2.0
// The shaders' text, and programs in several variants, each compiled when it is first needed.
#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "render/context/gl_objects.h"
#include "render/context/shader_source.h"

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

// The text of one shader: #version, `defines`, then the file, with each #include "file" replaced by that file at its
// first occurrence. Throws std::out_of_range for an unknown name.
std::string shader_text(std::string_view name, const std::string& defines = "");

}  // namespace mercury::render
