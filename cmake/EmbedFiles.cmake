# SPDX-License-Identifier: Apache-2.0
# cmake -D FILES=A|B|... -D HEADER=FILE.h -D NAMESPACE=N -D FUNCTION=F -D OUTPUT=FILE.cpp -P EmbedFiles.cmake
# Embeds the files into the program by the assembler: a compiler would take seconds for arrays of this size. The header
# declares std::span<const EmbeddedFile> N::F().
string(REPLACE "|" ";" FILES "${FILES}")
set(number 0)
set(blobs "")
set(declarations "")
set(entries "")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  set(symbol mercury_embedded_${number})
  string(APPEND blobs "    \".balign 16\\n${symbol}:\\n.incbin \\\"${file}\\\"\\n${symbol}_end:\\n.byte 0\\n\"\n")
  string(APPEND declarations "extern \"C\" __attribute__((visibility(\"hidden\"))) const char ${symbol}[], ${symbol}_end[];\n")
  string(APPEND entries "    {\"${name}\", {${symbol}, static_cast<std::size_t>(${symbol}_end - ${symbol})}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Made at build time.
#include \"${HEADER}\"

__asm__(\".pushsection .rodata\\n\"
${blobs}    \".popsection\\n\");

${declarations}
namespace ${NAMESPACE} {

std::span<const EmbeddedFile> ${FUNCTION}() {
  static const EmbeddedFile files[] = {
${entries}  };
  return files;
}

}  // namespace ${NAMESPACE}
")
