// SPDX-License-Identifier: Apache-2.0
#include "render/patch_pass.h"

#include <vector>

#include "render/bindings.h"

namespace mercury::render {
namespace {

// The layout of shaders/patch.vert.
struct PatchRecord {
  Vector4 disc;   // center x, y; radius; unused
  Vector4 slide;  // x, y; unused
};

}  // namespace

PatchPass::PatchPass() : empty_(make_vertex_array()), program_({"patch.vert", "patch.frag"}, "") {}

void PatchPass::draw(std::span<const Patch> patches, const std::string& variant) {
  if (patches.empty()) return;
  std::vector<PatchRecord> records;
  records.reserve(patches.size());
  for (const Patch& patch : patches)
    records.push_back({{patch.center.x, patch.center.y, patch.radius, 0}, {patch.slide.x, patch.slide.y, 0, 0}});
  patches_.write(records);
  patches_.bind_storage(binding::first_free);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDepthMask(GL_FALSE);
  glDisable(GL_CULL_FACE);
  glUseProgram(program_.get(variant));
  glBindVertexArray(empty_.get());
  glDrawArrays(GL_TRIANGLES, 0, GLsizei(6 * patches.size()));
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace mercury::render
