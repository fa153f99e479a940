// SPDX-License-Identifier: Apache-2.0
#include "app/window/frame_report.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/base/messages.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"

namespace mercury::window {
namespace {

constexpr double interval = 0.05;       // between frames that are written [s]
constexpr std::size_t max_robots = 20;  // whose positions are written

// The centers of the robots in the last frame, in window coordinates.
std::vector<std::array<float, 2>> places(LiveScene& scene, const ShownView& shown) {
  const ViewportArea& area = shown.area;
  std::vector<std::array<float, 2>> places;
  if (shown.drawn == 0) return places;
  for (const render::Bounds& box : scene.drawn().bounds()) {
    if (places.size() == max_robots) break;
    const render::Vector3 p =
        shown.camera.project(box.center(), static_cast<int>(area.width()), static_cast<int>(area.height()));
    places.push_back({area.low.x + p.x, area.low.y + p.y});
  }
  return places;
}

// What the second side shows, or null.
nlohmann::json second_of(const Snapshot& snapshot) {
  if (!snapshot.second) return nullptr;
  const Configuration& configuration = snapshot.second->configuration;
  return {{"steps", snapshot.second->steps},
          {"time", snapshot.second->time},
          {"solver", name_of(configuration.solver)},
          {"environment", name_of(configuration.environment)}};
}

std::array<float, 3> target_of(const Environment& environment) {
  return {environment.target.x, environment.target.y, environment.target.z};
}

// GPU time of each part of a view [ms].
nlohmann::json passes_of(const render::Renderer& renderer) {
  nlohmann::json passes = nlohmann::json::object();
  for (const render::PassTime& pass : renderer.times()) passes[pass.name] = pass.milliseconds;
  return passes;
}

}  // namespace

void FrameReport::write_gl_messages(PanelContext& context) {
  for (const std::string& message : context.window.gl_context().take_messages()) {
    context.log.write("gl", {{"text", message}});
    warn(fmt::format("OpenGL: {}", message));
  }
}

void FrameReport::write_robots(PanelContext& context) {
  if (context.scene.robots().count() == robots_) return;
  robots_ = context.scene.robots().count();
  std::vector<std::string> names;
  for (const DocumentRobot& robot : context.scene.document().robots) names.push_back(robot.body.name);
  context.log.write("robots", {{"count", robots_}, {"names", names}});
}

void FrameReport::write(PanelContext& context, const ShownView& shown, const FrameTimes& cost, double dt) {
  EventLog& log = context.log;
  log.end_frame();
  write_gl_messages(context);
  if (frames_++ == 0) log.write("ready", {{"seconds", seconds()}, {"context", context.window.gl_context().describe()}});
  if (!log) return;
  write_robots(context);
  // Also write as soon as all input has been handled.
  const bool caught_up = !context.window.input().has_backlog() && context.window.input().taken() != input_;
  if (seconds() - written_at_ < interval && !caught_up) return;
  input_ = context.window.input().taken();
  written_at_ = seconds();
  LiveScene& scene = context.scene;
  const TimelineState& timeline = scene.snapshot().timeline;
  log.write("frame", {{"number", frames_},
                      {"where", places(scene, shown)},
                      {"eye", {shown.camera.eye.x, shown.camera.eye.y, shown.camera.eye.z}},
                      {"distance", context.camera.orbit().distance},
                      {"azimuth", context.camera.orbit().azimuth},
                      {"elevation", context.camera.orbit().elevation},
                      {"layout", name_of(scene.view().layout)},
                      {"input", input_},
                      {"steps", scene.snapshot().steps},
                      {"time", scene.snapshot().time},
                      {"shown", shown.time},
                      {"playing", scene.time().playing() || scene.snapshot().playing},  // until the last step is shown
                      {"timeline",
                       {{"begin", timeline.begin},
                        {"head", timeline.head},
                        {"viewing", timeline.viewing},
                        {"recording", timeline.recording},
                        {"seeking", timeline.seeking},
                        {"looping", timeline.looping},
                        {"bookmarks", scene.time().bookmarks()},
                        {"budget", timeline.budget}}},
                      {"second", second_of(scene.snapshot())},
                      {"ghosts", scene.drawn().scene().ghosts.size()},
                      {"cursor", context.cursor.time ? nlohmann::json(*context.cursor.time) : nlohmann::json()},
                      {"selected", scene.selection().robots().size()},
                      {"attached", scene.mouse().attachments().size()},
                      {"panels", context.preferences.panels},
                      {"text", context.preferences.text_scale},
                      {"color", scene.view().color->key},
                      {"scale", {scene.drawn().scene().scale.low, scene.drawn().scene().scale.high}},
                      {"cut", scene.view().cut ? scene.view().cut->percent : -1},
                      {"target", target_of(scene.document().configuration.environment)},
                      {"theme", scene.view().theme == render::Theme::dark ? "dark" : "light"},
                      {"camera", name_of(context.camera.mode())},
                      {"on_device", scene.drawn().positions_on_device()},
                      {"speed", scene.snapshot().achieved_speed},
                      {"drawn", shown.drawn},
                      {"presented", shown.presented},
                      {"clock", seconds()},
                      {"seconds", dt},
                      {"cost",
                       {{"scene", cost.scene},
                        {"thumbnails", cost.thumbnails},
                        {"mouse", cost.mouse},
                        {"panels", cost.panels},
                        {"positions", cost.positions},
                        {"view", cost.drawn},
                        {"waiting", cost.waiting},
                        {"present", cost.present}}},
                      {"passes", passes_of(context.viewport.renderer())}});
}

}  // namespace mercury::window
