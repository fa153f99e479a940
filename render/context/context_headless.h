// SPDX-License-Identifier: Apache-2.0
// Contexts without a window, and what drawing on the processor needs.
#pragma once

#include <memory>
#include <span>

#include "render/context/context.h"

namespace mercury::render {

// In the order in which make_context() tries them. All throw ContextError.
std::unique_ptr<Context> make_egl_gpu_context(const ContextOptions& options);
std::unique_ptr<Context> make_egl_mesa_context(const ContextOptions& options);
std::unique_ptr<Context> make_osmesa_context(const ContextOptions& options);

// libepoxy's table of OpenGL functions, redirected for a context that libepoxy does not support.
struct GlPointer {
  const char* name;  // "glClear"
  void** pointer;    // where libepoxy keeps it
};

// Every function of epoxy/gl.h. The build generates the definition.
std::span<const GlPointer> gl_pointers();

// Limits of the process that end drawing on the processor by a crash or make it wait for ever.

// Throws ContextError if too little memory (ulimit -v, ulimit -d) or too few threads (ulimit -u) are left for Mesa.
void require_room_to_draw();

}  // namespace mercury::render
