# SPDX-License-Identifier: Apache-2.0
# cmake -D HEADER=epoxy/gl_generated.h -D OUTPUT=FILE.cpp -P EmbedGlPointers.cmake
# Lists every function pointer that libepoxy's header declares.
file(STRINGS ${HEADER} declarations REGEX "EPOXY_CALLSPEC \\*epoxy_gl")
set(entries "")
foreach(declaration IN LISTS declarations)
  string(REGEX REPLACE ".*\\*epoxy_(gl[A-Za-z0-9_]+)\\).*" "\\1" name "${declaration}")
  string(APPEND entries "    {\"${name}\", reinterpret_cast<void**>(&epoxy_${name})},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made from libepoxy's header at build time.
#include <epoxy/gl.h>

#include \"render/context/context_headless.h\"

namespace mercury::render {
namespace {

const GlPointer pointers[] = {
${entries}};

}  // namespace

std::span<const GlPointer> gl_pointers() { return pointers; }

}  // namespace mercury::render
")
