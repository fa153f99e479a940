// SPDX-License-Identifier: Apache-2.0
#include "app/video/group_drawing.h"

#include <algorithm>
#include <utility>

#include "app/base/frame_places.h"
#include "app/scene/group_layout.h"
#include "app/scene/group_motion.h"

namespace mercury {
namespace {

constexpr int lens_samples = 128;  // enough for blur of a tenth of the picture's height

bool on_land(const Simulation& simulation) { return has_ground(simulation.configuration().environment); }

std::vector<std::string> names_of(const Simulation& simulation) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < simulation.size(); ++i) names.push_back(simulation.robot(i).name);
  return names;
}

GroupPlacement placement_of(const Simulation& simulation, const ViewSettings& settings, float aspect) {
  std::vector<render::Bounds> bounds;
  for (std::size_t i = 0; i < simulation.size(); ++i) bounds.push_back(rest_bounds(simulation.robot(i)));
  const bool land = on_land(simulation);
  if (settings.board) {
    // The simulation sets robots down on the floor.
    for (render::Bounds& robot : bounds)
      if (land && !robot.empty()) robot = robot.moved({0, 0, -robot.low.z});
    return place_on_board(*settings.board, bounds, settings.camera, aspect, settings.theme);
  }
  std::vector<Room> rooms;
  for (std::size_t i = 0; i < simulation.size(); ++i) rooms.push_back(room_of(simulation.robot(i)));
  return {.offsets = group_offsets(bounds, rooms, settings, simulation.configuration().environment, aspect),
          .camera = settings.camera};
}

// The edges of the picture where text is written and no robot should be, as shares of its sides.
render::Insets free_edges(const ViewSettings& settings) {
  render::Insets free;
  if (settings.hero) free.left = 0.12f;  // the robot is to the right of the middle
  if (settings.shown.legend) free.right = 0.1f;
  if (settings.shown.labels || settings.shown.captions) free.top = 0.07f;
  if (settings.shown.clock || settings.shown.scale_bar) free.bottom = 0.03f;
  return free;
}

}  // namespace

void interpolate_centers(std::span<const Telemetry> earlier, std::span<const Telemetry> later, float share,
                         std::span<Telemetry> telemetry) {
  for (std::size_t i = 0; i < telemetry.size(); ++i)
    telemetry[i].center_of_mass = interpolated(earlier[i].center_of_mass, later[i].center_of_mass, share);
}

GroupDrawing::GroupDrawing(const Simulation& simulation, const ViewSettings& settings, float aspect,
                           std::span<const std::string> names)
    : simulation_(simulation), settings_(settings), placement_(placement_of(simulation, settings, aspect)),
      scene_(simulation, placement_.offsets, settings),
      camera_(placement_.camera, {.aspect = aspect, .free = free_edges(settings), .on_ground = on_land(simulation)},
              names_of(simulation)),
      details_(simulation, settings) {
  for (std::size_t i = 0; i < names.size(); ++i) scene_.set_name(i, names[i]);
  if (settings.board) scene_.set_background(placement_.tiles, placement_.texts);
}

FrameSnapshot GroupDrawing::take(PositionBridge& bridge, bool with_details, float share) {
  FrameSnapshot snapshot{.time = simulation_.time() + share * static_cast<double>(simulation_.configuration().dt),
                         .telemetry = simulation_.telemetry()};
  if (with_details) snapshot.details = details_.observe(snapshot.telemetry);
  snapshot.positions = bridge.take(simulation_);
  return snapshot;
}

FrameSnapshot GroupDrawing::between(const FrameSnapshot& earlier, const FrameSnapshot& later, float share,
                                    PositionBridge& bridge) {
  const FrameSnapshot& nearer = share < 0.5f ? earlier : later;
  FrameSnapshot between{.time = earlier.time + share * (later.time - earlier.time),
                        .positions = bridge.mix(*earlier.positions, *later.positions, share),
                        .telemetry = nearer.telemetry,
                        .details = nearer.details};
  for (std::size_t i = 0; i < between.telemetry.size(); ++i)
    if (later.telemetry[i].exploded) between.telemetry[i] = later.telemetry[i];
  interpolate_centers(earlier.telemetry, later.telemetry, share, between.telemetry);
  return between;
}

void GroupDrawing::draw(FrameSnapshot& snapshot, PositionBridge& bridge, render::Renderer& renderer, double elapsed) {
  show(snapshot, bridge, renderer);
  renderer.draw(scene(), camera(camera_boxes(), elapsed));
}

render::Camera GroupDrawing::camera(std::span<const render::Bounds> boxes, double elapsed) {
  render::Camera camera = camera_.at(boxes, elapsed);
  if (settings_.aperture == 0) return camera;
  const float distance = (camera.target - camera.eye).norm();
  // What is sharp of a robot begins with its nearer half.
  const float nearer = settings_.hero && !boxes.empty() ? 0.3f * boxes.front().radius() : 0;
  camera.lens.focus = std::max(0.1f * distance, distance - nearer);
  camera.lens.radius = 0.5f * settings_.aperture * camera.lens.focus;
  camera.lens.samples = lens_samples;
  return camera;
}

void GroupDrawing::show(FrameSnapshot& snapshot, PositionBridge& bridge, render::Renderer& renderer) {
  scene_.update(snapshot.time, snapshot.telemetry, std::move(snapshot.details));
  bridge.show(*snapshot.positions, renderer, scene_.scene());
}

void GroupDrawing::set_shown(const Shown& shown) {
  settings_.shown = shown;
  scene_.set_settings(settings_);
}

void GroupDrawing::share_scale(GroupDrawing& other) {
  const render::Scale& scale = other.scene().scale;
  if (settings_.color != other.settings_.color || !settings_.color->has_values() || !(scale.low < scale.high)) return;
  settings_.scale = std::pair(scale.low, scale.high);
  scene_.set_settings(settings_);
}

}  // namespace mercury
