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

// A group of robots in a video.
struct FilmedGroup {
  Simulation simulation;
  std::vector<std::string> names = {};  // one per robot, shown instead of its own; empty = its own
  std::string title = {};               // above it, if there are several
  std::shared_ptr<float> share = {};    // of playback()
};

// Simulates, draws and encodes groups of robots, from left to right: owns the simulations and what is drawn of them,
// and refers to the renderer.
class VideoPipeline {
 public:
  // At least one group. Two without titles are the same robots under different settings, which is written above them.
  // With a background in the settings, frames are figures (matted()). Throws InputError for a setting that does not
  // suit the robots or their environment, ParameterError("size", ...) for frames too narrow for the groups.
  VideoPipeline(OffscreenRenderer& offscreen, std::vector<FilmedGroup> groups, const ViewSettings& settings);
  ~VideoPipeline();
  VideoPipeline(const VideoPipeline&) = delete;
  VideoPipeline& operator=(const VideoPipeline&) = delete;

  const Simulation& simulation() const;  // the first
  // Whether positions go from the simulation to the frame without leaving the GPU.
  bool positions_on_device() const;
  // Why they pass through the host although a GPU simulates; empty if there is nothing to say.
  const std::string& bridge_note() const;
  // The last frame over each of figure_backdrops, if there is a background.
  const std::array<render::Image, 2>& backdrops() const { return backdrops_; }
  // See run_video_stages(). `pixels`: of what is drawn; rgb for figures.
  VideoResult run(FrameWriter& writer, render::PixelFormat pixels, const VideoTiming& timing, bool quiet,
                  VideoControl* control = nullptr);

 private:
  struct Side;
  void combine(std::span<const render::Image> parts, render::Image& into);

  std::size_t groups_;
  std::vector<std::unique_ptr<Side>> sides_;  // one per group, and for figures another one over the second backdrop
  std::optional<render::Color> background_;
  std::array<render::Image, 2> backdrops_;
};

}  // namespace mercury
