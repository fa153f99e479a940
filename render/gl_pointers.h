// SPDX-License-Identifier: Apache-2.0
// libepoxy's table of OpenGL functions, redirected for a context that libepoxy does not support.
#pragma once

#include <span>

namespace mercury::render {

struct GlPointer {
  const char* name;  // "glClear"
  void** pointer;    // where libepoxy keeps it
};

// Every function of epoxy/gl.h. The build generates the definition.
std::span<const GlPointer> gl_pointers();

// Sets each pointer to what `find` returns for its name, if anything, and keeps the previous pointers.
void override_gl_pointers(void (*(*find)(const char*))());
// Restores the previous pointers; does nothing if none were overridden.
void restore_gl_pointers();

}  // namespace mercury::render
