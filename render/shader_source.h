// SPDX-License-Identifier: Apache-2.0
// The shaders of shaders/, embedded at build time.
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

// The text of one shader: #version first, then `defines`, each line #include "file" replaced by that file, once.
// Throws std::out_of_range for a name that is not there.
std::string shader_text(std::string_view name, const std::string& defines = "");

}  // namespace mercury::render
