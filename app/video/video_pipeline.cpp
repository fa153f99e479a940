// SPDX-License-Identifier: Apache-2.0
#include "app/video/video_pipeline.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "app/scene/scene_details.h"
#include "app/scene/side_difference.h"
#include "app/video/group_drawing.h"
#include "app/video/picture_memory.h"
#include "app/video/side_by_side.h"
#include "mercury/host_memory.h"

namespace mercury {
namespace {

float aspect_of(const render::Renderer& renderer) {
  return static_cast<float>(renderer.width()) / static_cast<float>(renderer.height());
}

// What the sides of a comparison are, above each: its own settings where they differ.
using SideSettings = std::array<ViewSettings, 2>;
SideSettings settings_of_sides(const ViewSettings& settings, const Configuration& first, const Configuration& second,
                               const std::array<std::string, 2>& titles) {
  const auto on_land = [](const Configuration& one) { return has_ground(one.environment); };
  SideSettings sides{settings, known_in(settings, second.environment)};
  const auto [title, second_title] = differences(first, second);
  const auto add = [](ViewSettings& side, const std::string& text) {
    side.caption += (side.caption.empty() || text.empty() ? "" : "\n") + text;
  };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    add(sides.at(i), titles.at(i));
    add(sides.at(i), i == 0 ? title : second_title);
  }
  // Robots on land stand in rows on the ground, and beside them those in water do, too.
  if (on_land(first) && !on_land(second)) sides[1].camera.mode = CameraMode::top;
  return sides;
}

}  // namespace

OffscreenRenderer make_offscreen_renderer(render::ContextKind kind, PictureSize size, render::Quality quality,
                                          int cuda_device) {
  auto context = render::make_context({.kind = kind, .cuda_device = cuda_device, .debug = false});
  require_memory_for_pictures(size, context->is_software(), usable_host_memory());
  render::Renderer renderer(*context, {.width = size.width, .height = size.height, .quality = quality});
  return {std::move(context), std::move(renderer)};
}

struct VideoPipeline::Side {
  Simulation simulation;
  std::optional<render::Renderer> own;  // of one of two sides
  render::Renderer& renderer;
  GroupDrawing drawing;
  ChosenBridge bridge;

  Side(Simulation simulated, OffscreenRenderer& offscreen, std::optional<PictureSize> size,
       const ViewSettings& settings, std::span<const std::string> names)
      : simulation(std::move(simulated)), own(renderer_of(offscreen, size)), renderer(own ? *own : offscreen.renderer),
        drawing(simulation, settings, aspect_of(renderer), names),
        bridge(choose_bridge(simulation.cuda_device(), settings.interop)) {
    drawing.set_bodies(renderer);
  }

  static std::optional<render::Renderer> renderer_of(OffscreenRenderer& offscreen, std::optional<PictureSize> size) {
    if (!size) return std::nullopt;
    const render::Quality quality = offscreen.renderer.quality();
    return render::Renderer(*offscreen.context, {.width = size->width, .height = size->height, .quality = quality});
  }
};

VideoPipeline::VideoPipeline(OffscreenRenderer& offscreen, Simulation simulation, const ViewSettings& settings,
                             std::span<const std::string> names, std::optional<Simulation> second,
                             const std::array<std::string, 2>& titles) {
  if (!second) {
    sides_.push_back(std::make_unique<Side>(std::move(simulation), offscreen, std::nullopt, settings, names));
    return;
  }
  const auto sizes = halves_of({offscreen.renderer.width(), offscreen.renderer.height()});
  const SideSettings of_sides =
      settings_of_sides(settings, simulation.configuration(), second->configuration(), titles);
  sides_.push_back(std::make_unique<Side>(std::move(simulation), offscreen, sizes[0], of_sides[0], names));
  sides_.push_back(std::make_unique<Side>(std::move(*second), offscreen, sizes[1], of_sides[1], names));
  // One clock on the left and one legend on the right. The cameras have left room for both.
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    Shown shown = of_sides[i].shown;
    (i == 0 ? shown.legend : shown.clock) = false;
    sides_[i]->drawing.set_shown(shown);
  }
}

VideoPipeline::~VideoPipeline() = default;

const Simulation& VideoPipeline::simulation() const { return sides_.front()->simulation; }

bool VideoPipeline::positions_on_device() const {
  return std::ranges::all_of(sides_, [](const auto& side) { return side->bridge.on_device; });
}

const std::string& VideoPipeline::bridge_note() const { return sides_.front()->bridge.note; }

VideoResult VideoPipeline::run(FrameWriter& writer, render::PixelFormat pixels, const VideoTiming& timing, bool quiet,
                               VideoControl* control) {
  VideoParts parts{.sides = {}, .writer = writer, .pixels = pixels};
  for (const auto& side : sides_)
    parts.sides.push_back({side->simulation, *side->bridge.bridge, side->drawing, side->renderer});
  return run_video_stages(parts, timing, quiet, control);
}

}  // namespace mercury
