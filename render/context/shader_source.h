// SPDX-License-Identifier: Apache-2.0
// The files of shaders/, without OpenGL.
#pragma once

#include <span>
#include <string_view>

namespace mercury::render {

// A file of shaders/, embedded at build time.
struct ShaderSource {
  std::string_view name;  // "skin.frag"
  std::string_view text;
};

std::span<const ShaderSource> shader_sources();

}  // namespace mercury::render
