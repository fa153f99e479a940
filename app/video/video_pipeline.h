// SPDX-License-Identifier: Apache-2.0
// Everything that a video of a group needs, put together.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/scene/view_settings.h"
#include "app/video/video_stages.h"
#include "render/context/context.h"
#include "render/renderer.h"

namespace mercury {

// An OpenGL context without a window, and a renderer in it.
struct OffscreenRenderer {
  std::unique_ptr<render::Context> context;
  render::Renderer renderer;
};
// `cuda_device`: draws on the GPU with that CUDA ordinal, if there is a choice; -1 = any. Throws render::ContextError
// when no context is available, ParameterError("size", ...) when frames of this size do not fit into memory.
OffscreenRenderer make_offscreen_renderer(render::ContextKind kind, PictureSize size, render::Quality quality,
                                          int cuda_device = -1);

// Simulates, draws and encodes a group of robots: owns the simulation and what is drawn of it, and refers to the
// renderer.
class VideoPipeline {
 public:
  // `names`: one per robot, shown instead of its own; empty = its own. `second`: the same robots under other settings,
  // as settings.compare says, or others; the frame then has two sides, with `titles` above them. Throws InputError for
  // a setting that does not suit the robots or their environment, ParameterError("size", ...) for frames too narrow for
  // two sides.
  VideoPipeline(OffscreenRenderer& offscreen, Simulation simulation, const ViewSettings& settings,
                std::span<const std::string> names = {}, std::optional<Simulation> second = {},
                const std::array<std::string, 2>& titles = {});
  ~VideoPipeline();
  VideoPipeline(const VideoPipeline&) = delete;
  VideoPipeline& operator=(const VideoPipeline&) = delete;

  const Simulation& simulation() const;  // the first
  // Whether positions go from the simulation to the frame without leaving the GPU.
  bool positions_on_device() const;
  // Why they pass through the host although a GPU simulates; empty if there is nothing to say.
  const std::string& bridge_note() const;
  // See run_video_stages().
  VideoResult run(FrameWriter& writer, render::PixelFormat pixels, const VideoTiming& timing, bool quiet,
                  VideoControl* control = nullptr);

 private:
  struct Side;
  std::vector<std::unique_ptr<Side>> sides_;
};

}  // namespace mercury
