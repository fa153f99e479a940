// SPDX-License-Identifier: Apache-2.0
#include "render/gl_failure.h"

#include <epoxy/gl.h>

#include "render/context.h"

namespace mercury::render {

void throw_if_gl_failed() {
  constexpr int most_flags = 16;  // a lost context reports its loss without end
  bool out_of_memory = false;
  for (int i = 0; i < most_flags; ++i) {
    const GLenum error = glGetError();
    if (error == GL_CONTEXT_LOST) throw ContextError("the GPU was reset while it drew");
    if (error == GL_OUT_OF_MEMORY) out_of_memory = true;
    if (error == GL_NO_ERROR) break;
  }
  if (out_of_memory)
    throw ContextError("the GPU has no memory left to draw with: make the picture smaller or free some memory");
}

}  // namespace mercury::render
