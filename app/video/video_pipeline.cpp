// SPDX-License-Identifier: Apache-2.0
#include "app/video/video_pipeline.h"

#include <algorithm>
#include <utility>

#include "app/scene/scene_details.h"
#include "app/scene/side_difference.h"
#include "app/video/figure.h"
#include "app/video/group_drawing.h"
#include "app/video/picture_memory.h"
#include "app/video/side_by_side.h"
#include "mercury/host_memory.h"

namespace mercury {
namespace {

float aspect_of(const render::Renderer& renderer) {
  return static_cast<float>(renderer.width()) / static_cast<float>(renderer.height());
}

// What the sides are, above each: titles, or its own settings where two differ.
std::vector<ViewSettings> settings_of_sides(const ViewSettings& settings, std::span<const FilmedGroup> groups) {
  std::vector<ViewSettings> sides;
  if (groups.size() == 1) return {settings};
  const auto on_land = [](const Configuration& one) { return has_ground(one.environment); };
  const Configuration& first = groups.front().simulation.configuration();
  for (const FilmedGroup& group : groups) {
    ViewSettings& side =
        sides.emplace_back(sides.empty() ? settings : known_in(settings, group.simulation.configuration().environment));
    // Robots on land stand in rows on the ground, and beside them those in water do, too.
    if (on_land(first) && !on_land(group.simulation.configuration())) side.camera.mode = CameraMode::top;
    if (!group.title.empty()) side.caption += (side.caption.empty() ? "" : "\n") + group.title;
  }
  if (groups.size() != 2) return sides;
  const auto [left, right] = differences(first, groups[1].simulation.configuration());
  for (std::size_t i = 0; i < 2; ++i)
    if (const std::string& text = i == 0 ? left : right; !text.empty())
      sides[i].caption += (sides[i].caption.empty() ? "" : "\n") + text;
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
  std::shared_ptr<Simulation> simulation;
  std::optional<render::Renderer> own;  // of one of several groups
  render::Renderer& renderer;
  GroupDrawing drawing;
  ChosenBridge bridge;
  std::shared_ptr<float> share;

  Side(FilmedGroup& group, OffscreenRenderer& offscreen, std::optional<PictureSize> size, const ViewSettings& settings)
      : simulation(std::make_shared<Simulation>(std::move(group.simulation))), own(renderer_of(offscreen, size)),
        renderer(own ? *own : offscreen.renderer), drawing(*simulation, settings, aspect_of(renderer), group.names),
        // A figure is drawn twice from the same positions.
        bridge(choose_bridge(simulation->cuda_device(), settings.interop && !settings.flat_backdrop)),
        share(group.share) {
    drawing.set_bodies(renderer);
  }

  // The same group in another way.
  Side(Side& other, const ViewSettings& settings, std::span<const std::string> names)
      : simulation(other.simulation), renderer(other.renderer),
        drawing(*simulation, settings, aspect_of(renderer), names), bridge(choose_bridge(-1, false)),
        share(other.share) {}

  static std::optional<render::Renderer> renderer_of(OffscreenRenderer& offscreen, std::optional<PictureSize> size) {
    if (!size) return std::nullopt;
    const render::Quality quality = offscreen.renderer.quality();
    return render::Renderer(*offscreen.context, {.width = size->width, .height = size->height, .quality = quality});
  }
};

VideoPipeline::VideoPipeline(OffscreenRenderer& offscreen, std::vector<FilmedGroup> groups,
                             const ViewSettings& settings)
    : groups_(groups.size()), background_(settings.background) {
  const std::vector<PictureSize> sizes =
      columns_of({offscreen.renderer.width(), offscreen.renderer.height()}, static_cast<int>(groups_));
  std::vector<ViewSettings> of_groups = settings_of_sides(settings, groups);
  const auto show = [&](std::size_t group) {
    // One clock on the left and one legend on the right. The cameras have left room for both.
    Shown shown = of_groups[group].shown;
    shown.clock = shown.clock && group == 0;
    shown.legend = shown.legend && group + 1 == groups_;
    sides_.back()->drawing.set_shown(shown);
  };
  for (std::size_t i = 0; i < groups_; ++i) {
    if (background_) of_groups[i].flat_backdrop = figure_backdrops[0];
    // Which low quality does not draw.
    if (offscreen.renderer.quality() == render::Quality::low) of_groups[i].footprints = false;
    const std::optional<PictureSize> size = groups_ > 1 ? std::optional(sizes[i]) : std::nullopt;
    sides_.push_back(std::make_unique<Side>(groups[i], offscreen, size, of_groups[i]));
    if (groups_ > 1) show(i);
  }
  for (std::size_t i = 0; background_ && i < groups_; ++i) {
    of_groups[i].flat_backdrop = figure_backdrops[1];
    sides_.push_back(std::make_unique<Side>(*sides_[i], of_groups[i], groups[i].names));
    if (groups_ > 1) show(i);
  }
}

void VideoPipeline::combine(std::span<const render::Image> parts, render::Image& into) {
  if (!background_) return join(parts, into);
  for (std::size_t i = 0; i < backdrops_.size(); ++i) join(parts.subspan(i * groups_, groups_), backdrops_.at(i));
  into = matted(backdrops_, *background_);
}

VideoPipeline::~VideoPipeline() = default;

const Simulation& VideoPipeline::simulation() const { return *sides_.front()->simulation; }

bool VideoPipeline::positions_on_device() const {
  return std::ranges::all_of(sides_, [](const auto& side) { return side->bridge.on_device; });
}

const std::string& VideoPipeline::bridge_note() const { return sides_.front()->bridge.note; }

VideoResult VideoPipeline::run(FrameWriter& writer, render::PixelFormat pixels, const VideoTiming& timing, bool quiet,
                               VideoControl* control) {
  VideoParts parts{
      .sides = {},
      .writer = writer,
      .pixels = pixels,
      .combine = [this](std::span<const render::Image> sides, render::Image& into) { combine(sides, into); }};
  for (const auto& side : sides_)
    parts.sides.push_back({*side->simulation, *side->bridge.bridge, side->drawing, side->renderer, side->share.get()});
  return run_video_stages(parts, timing, quiet, control);
}

}  // namespace mercury
