// SPDX-License-Identifier: Apache-2.0
#include "app/window/frame_report.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mercury::window {
namespace {

constexpr double pause = 0.2;            // between frames that are told of [s]
constexpr std::size_t most_places = 20;  // of robots

// The middles of the robots, in the window.
std::vector<std::array<float, 2>> places(LiveScene& scene, const ShownPicture& picture) {
  const PictureArea& area = picture.area;
  std::vector<std::array<float, 2>> places;
  for (const render::Bounds& box : scene.picture().bounds()) {
    if (places.size() == most_places) break;
    const Eigen::Vector3f p =
        picture.camera.project(box.center(), static_cast<int>(area.width()), static_cast<int>(area.height()));
    places.push_back({area.low.x + p.x(), area.low.y + p.y()});
  }
  return places;
}

}  // namespace

void FrameReport::tell_complaints(Desk& desk, Window& window) {
  for (const std::string& complaint : window.context().take_messages()) {
    desk.observations.tell("gl", {{"text", complaint}});
    fmt::print(stderr, "mercury: OpenGL: {}\n", complaint);
  }
}

void FrameReport::tell_robots(Desk& desk) {
  const std::vector<RobotEntry> entries = desk.scene.entries();
  if (entries.size() == robots_) return;
  robots_ = entries.size();
  std::vector<std::string> names;
  for (const RobotEntry& entry : entries) names.push_back(entry.name);
  desk.observations.tell("robots", {{"count", robots_}, {"names", names}});
}

void FrameReport::tell(Desk& desk, Window& window, const ShownPicture& picture, const FrameCost& cost, double dt) {
  Observations& observations = desk.observations;
  observations.end_frame();
  tell_complaints(desk, window);
  if (frames_++ == 0) observations.tell("ready", {{"seconds", seconds()}, {"context", window.context().describe()}});
  if (!observations) return;
  tell_robots(desk);
  // When all that was pressed was taken, too.
  const bool caught_up = !window.input().behind() && window.input().taken() != input_;
  if (seconds() - told_ < pause && !caught_up) return;
  input_ = window.input().taken();
  told_ = seconds();
  LiveScene& scene = desk.scene;
  observations.tell("frame", {{"number", frames_},
                              {"where", places(scene, picture)},
                              {"distance", desk.camera.orbit().distance},
                              {"azimuth", desk.camera.orbit().azimuth},
                              {"input", input_},
                              {"steps", scene.moment().steps},
                              {"time", scene.moment().time},
                              {"shown", picture.time},
                              {"playing", scene.playing()},
                              {"selected", scene.selection().size()},
                              {"panels", desk.preferences.panels},
                              {"color", name_of(scene.view().color)},
                              {"theme", scene.view().theme == render::Theme::dark ? "dark" : "light"},
                              {"camera", name_of(desk.camera.mode())},
                              {"seconds", dt},
                              {"picture", cost.picture}});
}

}  // namespace mercury::window
