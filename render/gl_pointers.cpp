// SPDX-License-Identifier: Apache-2.0
#include "render/gl_pointers.h"

#include <vector>

namespace mercury::render {
namespace {

std::vector<void*>& saved() {
  static std::vector<void*> pointers;
  return pointers;
}

}  // namespace

void override_gl_pointers(void (*(*find)(const char*))()) {
  if (!saved().empty()) return;
  for (const GlPointer& entry : gl_pointers()) {
    saved().push_back(*entry.pointer);
    if (const auto function = find(entry.name)) *entry.pointer = reinterpret_cast<void*>(function);
  }
}

void restore_gl_pointers() {
  for (std::size_t i = 0; i < saved().size(); ++i) *gl_pointers()[i].pointer = saved()[i];
  saved().clear();
}

}  // namespace mercury::render
