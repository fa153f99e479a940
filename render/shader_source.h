// SPDX-License-Identifier: Apache-2.0
// The files of shaders/, embedded at build time.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mercury::render {

struct ShaderSource {
  std::string_view name;  // "skin.frag"
  std::string_view text;
};

std::span<const ShaderSource> shader_sources();

// The text of one shader: #version, `defines`, then the file, with each #include "file" replaced by that file at its
// first occurrence. Throws std::out_of_range for an unknown name.
std::string shader_text(std::string_view name, const std::string& defines = "");

}  // namespace mercury::render
