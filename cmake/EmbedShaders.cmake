# SPDX-License-Identifier: Apache-2.0
# cmake -D FOLDER=shaders -D OUTPUT=FILE.cpp -P EmbedShaders.cmake
# Turns every file of the folder into a raw string of the program.
file(GLOB files RELATIVE ${FOLDER} ${FOLDER}/*.vert ${FOLDER}/*.frag ${FOLDER}/*.comp ${FOLDER}/*.glsl)
list(SORT files)
set(entries "")
foreach(name IN LISTS files)
  file(READ ${FOLDER}/${name} text)
  string(APPEND entries "    {\"${name}\", R\"shader(${text})shader\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made from shaders/ at build time.
#include \"render/context/shader_source.h\"

namespace mercury::render {
namespace {

const ShaderSource sources[] = {
${entries}};

}  // namespace

std::span<const ShaderSource> shader_sources() { return sources; }

}  // namespace mercury::render
")
