// SPDX-License-Identifier: Apache-2.0
// Everything that a video of a group needs, put together.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/scene/view_settings.h"
#include "app/video/group_drawing.h"
#include "app/video/video_stages.h"
#include "render/context.h"
#include "render/renderer.h"

namespace mercury {

// An OpenGL context without a window, and a renderer in it.
struct OffscreenRenderer {
  std::unique_ptr<render::Context> context;
  render::Renderer renderer;
};
// `cuda_device`: draws on the GPU with that CUDA ordinal, if there is a choice; -1 = any. Throws render::ContextError
// when no context is available, ParameterError("size", ...) when pictures of this size do not fit into memory.
OffscreenRenderer make_offscreen_renderer(render::ContextKind kind, PictureSize size, render::Quality quality,
                                          int cuda_device = -1);

// Simulates, draws and encodes a group of robots: owns the simulation and what is drawn of it, and refers to the
// renderer.
class VideoPipeline {
 public:
  // `names`: one per robot, shown instead of its own; empty = its own. Throws InputError for a setting that does not
  // suit the robots or their environment.
  VideoPipeline(OffscreenRenderer& offscreen, Simulation simulation, const ViewSettings& settings,
                std::span<const std::string> names = {});

  const Simulation& simulation() const { return simulation_; }
  // Whether positions go from the simulation to the picture without leaving the GPU.
  bool positions_on_card() const { return bridge_.on_card; }
  // Why they pass through the host although a GPU simulates; empty if there is nothing to say.
  const std::string& bridge_note() const { return bridge_.note; }
  // See run_video_stages().
  VideoResult run(FrameWriter& writer, render::PixelFormat pixels, const VideoTiming& timing, bool quiet,
                  VideoControl* control = nullptr);

 private:
  OffscreenRenderer& offscreen_;
  Simulation simulation_;
  GroupDrawing drawing_;
  ChosenBridge bridge_;
};

}  // namespace mercury
