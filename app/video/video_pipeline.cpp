// SPDX-License-Identifier: Apache-2.0
#include "app/video/video_pipeline.h"

#include <utility>

#include "app/video/picture_memory.h"
#include "mercury/host_memory.h"

namespace mercury {
namespace {

float aspect_of(const render::Renderer& renderer) {
  return static_cast<float>(renderer.width()) / static_cast<float>(renderer.height());
}

}  // namespace

OffscreenRenderer make_offscreen_renderer(render::ContextKind kind, PictureSize size, render::Quality quality,
                                          int cuda_device) {
  auto context = render::make_context({.kind = kind, .cuda_device = cuda_device, .debug = false});
  require_memory_for_pictures(size, context->is_software(), usable_host_memory());
  render::Renderer renderer(*context, {.width = size.width, .height = size.height, .quality = quality});
  return {std::move(context), std::move(renderer)};
}

VideoPipeline::VideoPipeline(OffscreenRenderer& offscreen, Simulation simulation, const ViewSettings& settings,
                             std::span<const std::string> names)
    : offscreen_(offscreen), simulation_(std::move(simulation)),
      drawing_(simulation_, settings, aspect_of(offscreen.renderer), names) {
  drawing_.set_bodies(offscreen.renderer);
  bridge_ = choose_bridge(simulation_.cuda_device(), settings.interop);
}

VideoResult VideoPipeline::run(FrameWriter& writer, render::PixelFormat pixels, const VideoTiming& timing, bool quiet,
                               VideoControl* control) {
  return run_video_stages({simulation_, *bridge_.bridge, drawing_, offscreen_.renderer, writer, pixels}, timing, quiet,
                          control);
}

}  // namespace mercury
