// SPDX-License-Identifier: Apache-2.0
#include "app/video/video_pipeline.h"

#include <variant>

#include "app/scene/group_layout.h"

namespace mercury {
namespace {

bool on_land(const Simulation& simulation) {
  return std::holds_alternative<Land>(simulation.configuration().environment);
}

std::vector<std::string> names_of(const Simulation& simulation) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < simulation.size(); ++i) names.push_back(simulation.robot(i).name);
  return names;
}

float aspect_of(const render::Renderer& renderer) {
  return static_cast<float>(renderer.width()) / static_cast<float>(renderer.height());
}

GroupPlacement placement_of(const Simulation& simulation, const ViewSettings& settings, float aspect) {
  std::vector<render::Bounds> bounds;
  for (std::size_t i = 0; i < simulation.size(); ++i) bounds.push_back(rest_bounds(simulation.robot(i)));
  const bool land = on_land(simulation);
  if (settings.board) {
    // The simulation sets robots down on the floor.
    for (render::Bounds& robot : bounds)
      if (land && !robot.empty()) robot = robot.moved({0, 0, -robot.low.z()});
    return place_on_board(*settings.board, bounds, settings.camera, aspect, settings.theme);
  }
  // From straight above, robots that swim are laid out as if on the ground.
  const bool flat = land || settings.camera.mode == CameraMode::top;
  return {.offsets = grid_layout(bounds, {.layout = settings.layout,
                                          .grid = settings.grid,
                                          .aspect = aspect,
                                          .view = direction_of(settings.camera, land),
                                          .on_ground = flat}),
          .camera = settings.camera};
}

// The edges of the picture where text is written and no robot should be, as shares of its sides.
render::Insets free_edges(const ViewSettings& settings) {
  render::Insets free;
  if (settings.shown.legend) free.right = 0.1f;
  if (settings.shown.labels || settings.shown.captions) free.top = 0.07f;
  if (settings.shown.clock || settings.shown.scale_bar) free.bottom = 0.03f;
  return free;
}

}  // namespace

OffscreenRenderer make_offscreen_renderer(render::ContextKind kind, PictureSize size, render::Quality quality,
                                          int cuda_device) {
  auto context = render::make_context({.kind = kind, .cuda_device = cuda_device, .debug = false});
  render::Renderer renderer(*context, {.width = size.width, .height = size.height, .quality = quality});
  return {std::move(context), std::move(renderer)};
}

VideoPipeline::VideoPipeline(OffscreenRenderer& offscreen, Simulation simulation, const ViewSettings& settings,
                             std::span<const std::string> names)
    : offscreen_(offscreen), simulation_(std::move(simulation)),
      placement_(placement_of(simulation_, settings, aspect_of(offscreen.renderer))),
      scene_(simulation_, placement_.offsets, settings),
      camera_(
          placement_.camera,
          {.aspect = aspect_of(offscreen.renderer), .free = free_edges(settings), .on_ground = on_land(simulation_)},
          names_of(simulation_)),
      details_(simulation_, settings) {
  for (std::size_t i = 0; i < names.size(); ++i) scene_.set_name(i, names[i]);
  if (settings.board) scene_.set_background(placement_.tiles, placement_.texts);
  scene_.set_bodies(offscreen.renderer);
  bridge_ = choose_bridge(simulation_, offscreen.renderer, settings.interop);
}

VideoResult VideoPipeline::run(FrameWriter& writer, render::PixelFormat pixels, const VideoTiming& timing, bool quiet,
                               VideoControl* control) {
  return run_video_stages(
      {simulation_, *bridge_.bridge, details_, scene_, camera_, offscreen_.renderer, writer, pixels}, timing, quiet,
      control);
}

}  // namespace mercury
