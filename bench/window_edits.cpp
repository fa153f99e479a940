// SPDX-License-Identifier: Apache-2.0
// Measures how long the frames of the window wait for an edit of a large scene, and the steps per second at unlimited
// speed: bench_window_edits [robots [side]].
//
// The robots are random voxel robots of side^3 voxels without air: side 10 has 1,331 masses and 14,230 springs. Prints
// per edit the longest time of the scene's work for one frame (LiveScene::frame() and uploading bodies to the
// renderer) and the time until a frame shows the edit.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <thread>
#include <utility>

#include "app/live/live_scene.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "mercury/random_voxel.h"
#include "mercury/stopwatch.h"
#include "render/context/context.h"
#include "render/renderer.h"

namespace {

using namespace mercury;

class Window {
 public:
  Window()
      : context_(render::make_context({.kind = render::ContextKind::automatic})),
        renderer_(*context_, {.width = 64, .height = 64}) {}

  // Returns the time that one frame waits [s].
  double frame(LiveScene& scene) {
    const double start = wall_now();
    scene.frame();
    DrawnScene& live = scene.drawn();
    if (bodies_ != live.bodies_revision()) {
      live.set_bodies(renderer_);
      bodies_ = live.bodies_revision();
    }
    return wall_now() - start;
  }

 private:
  std::unique_ptr<render::Context> context_;
  render::Renderer renderer_;
  std::uint64_t bodies_ = 0;
};

void measure(Window& window, LiveScene& scene, const char* name, const std::function<void()>& edit,
             const std::function<bool()>& seen) {
  const double begin = wall_now();
  edit();
  const double call = wall_now() - begin;
  double longest = 0;
  while (!seen() && wall_now() - begin < 60) {
    longest = std::max(longest, window.frame(scene));
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  longest = std::max(longest, window.frame(scene));
  std::printf("%-28s call %6.1f ms   longest frame %6.1f ms   seen after %7.1f ms\n", name, 1e3 * call, 1e3 * longest,
              1e3 * (wall_now() - begin));
}

// Measures steps per second while 60 frames per second are shown, and of the simulation alone.
void measure_speed(Window& window, LiveScene& scene) {
  constexpr double seconds = 4;
  std::vector<Robot> robots;
  for (const DocumentRobot& robot : scene.document().robots) robots.push_back(*robot.body.robot);
  scene.time().set_speed(unlimited_speed);
  scene.time().play();
  const auto playing = [&](double wanted) {
    const std::int64_t first = scene.snapshot().steps;
    std::int64_t frames = 0, seen = first;
    const double begin = wall_now();
    while (wall_now() - begin < wanted) {
      window.frame(scene);
      frames += scene.snapshot().steps != seen;
      seen = scene.snapshot().steps;
      std::this_thread::sleep_for(std::chrono::milliseconds(16));
    }
    const double spent = wall_now() - begin;
    return std::pair{static_cast<double>(scene.snapshot().steps - first) / spent, static_cast<double>(frames) / spent};
  };
  playing(1);  // until the interval of samples is constant
  const auto [in_window, frames] = playing(seconds);
  scene.time().pause();
  scene.wait_until_done();
  Simulation simulation(scene.document().configuration, robots);
  std::int64_t call = 1;
  double begin = wall_now(), spent = 0;
  std::int64_t first = 0;
  while (spent < seconds) {
    const double start = wall_now();
    simulation.step(call);
    if (wall_now() - start < 0.1) {  // calls are still too short
      call *= 2;
      begin = wall_now();
      first = simulation.steps();
    }
    spent = wall_now() - begin;
  }
  const double alone = static_cast<double>(simulation.steps() - first) / spent;
  std::printf("unlimited speed: %.4g steps/s with %.1f new frames/s; %.4g steps/s alone (%.0f %%)\n", in_window, frames,
              alone, 100 * in_window / alone);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 500;
  const int side = argc > 2 ? std::atoi(argv[2]) : 10;
  LiveScene scene({.configuration = {.device = {.kind = DeviceKind::automatic}}});
  Window window;
  const auto robots_are = [&](std::size_t wanted) {
    return [&scene, wanted] { return scene.snapshot().robots->size() == wanted; };
  };
  std::vector<Robot> robots;
  for (std::size_t i = 0; i < count; ++i)
    robots.push_back(
        random_voxel_robot({.smallest = {side, side, side}, .largest = {side, side, side}, .air = 0}, 1, i % 8));
  std::printf("%zu robots of %zu masses, %zu springs, on %s\n", count, robots[0].masses.size(),
              robots[0].springs.size(), scene.device_name().c_str());
  measure(
      window, scene, "add all", [&] { scene.robots().add(std::move(robots)); }, robots_are(count));
  const RobotId some = scene.robots().entries()[count / 2].id;
  measure(
      window, scene, "duplicate one", [&] { scene.robots().duplicate({some}); }, robots_are(count + 1));
  measure(
      window, scene, "remove one", [&] { scene.robots().remove({some}); }, robots_are(count));
  measure(
      window, scene, "undo that", [&] { scene.undo(); }, robots_are(count + 1));
  const RobotId first = scene.robots().entries()[0].id;
  measure(
      window, scene, "materials of one", [&] { scene.parameters().scale_materials({first}, {.stiffness = 1.5f}); },
      [&] { return scene.snapshot().robots->robots[0].materials != nullptr; });
  std::vector<RobotId> all;
  for (const RobotEntry& entry : scene.robots().entries()) all.push_back(entry.id);
  measure(
      window, scene, "materials of all", [&] { scene.parameters().scale_materials(all, {.stiffness = 2}); },
      [&] { return scene.snapshot().robots->robots.back().materials != nullptr; });
  measure(
      window, scene, "damping",
      [&] {
        Configuration configuration = scene.document().configuration;
        configuration.damping = 0.5;
        scene.parameters().set_configuration(configuration);
      },
      [&] { return scene.snapshot().configuration.damping == 0.5; });
  measure(
      window, scene, "reset", [&] { scene.time().reset(); }, [&] { return scene.snapshot().resets > 0; });
  double frame = 0;
  for (int i = 0; i < 20; ++i) frame += window.frame(scene) / 20;
  std::printf("a frame without edits %.2f ms\n", 1e3 * frame);
  measure_speed(window, scene);
  return 0;
}
