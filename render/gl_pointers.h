// SPDX-License-Identifier: Apache-2.0
// libepoxy's table of OpenGL functions, pointed elsewhere for a context that libepoxy does not know.
#pragma once

#include <span>

namespace mercury::render {

struct GlPointer {
  const char* name;  // "glClear"
  void** pointer;    // where libepoxy keeps it
};

// Every function of epoxy/gl.h; the definition is generated at build time.
std::span<const GlPointer> gl_pointers();

// Points each function that `find` knows at what it returns, and remembers what was there.
void override_gl_pointers(void (*(*find)(const char*))());
// Undoes it; nothing if nothing was overridden.
void restore_gl_pointers();

}  // namespace mercury::render
