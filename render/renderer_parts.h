// SPDX-License-Identifier: Apache-2.0
// What a Renderer consists of, and how it draws one picture.
//
//   positions           each body's box; each face's normal; what the shadow map and the floor's light map cover; the
//                       plane that cuts each body; lists of the faces that turn toward the eye and toward the light
//   shadow map          depth, seen from the key light
//   prints              dents in the ground as a map
//   light on the floor  soft shadows on the floor as a map; under water, a tile of caustics
//   nearest surfaces    depth and face of the first surface in each pixel, one sample per pixel
//   occlusion           ambient occlusion of those surfaces, at half the picture's size
//   light on skins      how much light reaches those surfaces: soft shadows, caustics, occlusion
//   skins, springs and masses, surroundings
//                       linear light, 4 samples per pixel
//   finish              paths and particles; then glow, tone curve, average of the samples; then outlines of selected
//                       bodies, and text
//
// 1. What costs much per pixel is computed once per pixel, before the 4 samples are drawn.
// 2. No pass waits for an answer from the GPU. What depends on the positions stays there, in FrameBlock. Only labels
//    need the boxes on the CPU; they are read last, when the GPU has other work.
// 3. The CPU is at most two frames ahead of the GPU (Pace). Until then, what it wrote stays (StreamBuffer).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "render/passes/annotation_pass.h"
#include "render/passes/cut_passes.h"
#include "render/passes/ground_cover_pass.h"
#include "render/passes/lattice_pass.h"
#include "render/passes/light_pass.h"
#include "render/passes/outline_pass.h"
#include "render/passes/pass_timer.h"
#include "render/passes/print_pass.h"
#include "render/passes/quality.h"
#include "render/passes/scene_buffers.h"
#include "render/passes/screen_passes.h"
#include "render/passes/skin_passes.h"
#include "render/passes/visibility_passes.h"
#include "render/renderer.h"
#include "render/style.h"
#include "render/text/overlay.h"

namespace mercury::render {

// The passes that depend on quality; set_quality() builds them from scratch.
struct Passes {
  static std::string skin_defines(const QualitySettings& settings) {
    return settings.skin_defines() + (settings.front_light ? "#define FRONT_LIGHT\n" : "");
  }
  explicit Passes(const QualitySettings& settings)
      : skin(skin_defines(settings)), lattice(settings.skin_defines()), annotation(settings.defines()), light(settings),
        prints(settings), front(settings), occlusion(settings), mean(settings), finish(settings),
        backdrop("backdrop.frag"), beams("beams.frag") {}
  void resize(int width, int height) {
    front.resize(width, height);
    occlusion.resize(width, height);
    mean.resize(width, height);
    finish.resize(width, height);
  }
  SkinPass skin;
  LatticePass lattice;
  AnnotationPass annotation;
  LightPass light;
  PrintPass prints;
  FrontPass front;
  OcclusionPass occlusion;
  MeanPass mean;
  FinishPass finish;
  Fullscreen backdrop, beams;
};

// All color maps, one per row, from the middle of the first texel to the middle of the last.
Texture make_colormaps();

struct Renderer::Parts {
  int width = 0, height = 0;
  Quality quality = Quality::automatic;
  bool software = false;
  QualitySettings settings;
  Targets targets;
  Bodies bodies;
  StreamBuffer frame;
  SceneBuffers scene_buffers;
  Texture colormaps = make_colormaps();
  OverlayPass overlay;
  std::optional<Overlay> text;  // of the last picture
  float text_size = 0;
  std::optional<Passes> passes;
  std::shared_ptr<const BodyData> body_data;
  std::optional<FineSkinPass> fine;  // of these bodies; made when it is first needed
  bool is_fine = false;              // this picture shows it
  MixPass mix;
  BoundsPass bounds;
  FitPass fit;
  CutPass cut;
  PatchPass patches;
  GroundCoverPass ground_cover;
  SectionPass section;
  OutlinePass outline;
  GhostPass ghosts;
  PassTimer timer;
  Pace pace;
  std::string variant;  // lines of #define for this frame

  // The light of a picture, which the finish then shows. `noise`: see frame_block().
  void draw_light_of(const Scene& scene, const Camera& camera, const Style& style, float noise);
  // The mean of that through the camera's lens.
  void draw_through_lens(const Scene& scene, const Camera& camera, const Style& style);
  void prepare(const Scene& scene, const Camera& camera, const Style& style, float noise);
  template <typename Draw>
  void draw_sides(const Scene& scene, Draw draw_skins);
  void draw_light(const Scene& scene);
  const Bodies& drawn_bodies() const { return is_fine ? fine->bodies() : bodies; }
  SkinPass& skin() { return is_fine ? fine->skin() : passes->skin; }
  void choose_skin(const Scene& scene, bool takes_time);
  void draw_solid(const Scene& scene, const Camera& camera, const Style& style);
  void draw_beams() const;
};

}  // namespace mercury::render
