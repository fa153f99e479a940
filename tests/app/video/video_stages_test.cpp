// SPDX-License-Identifier: Apache-2.0
#include "app/video/video_stages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "app/scene/color_quantity.h"
#include "app/video/moment_sampler.h"
#include "app/video/video_pipeline.h"

namespace mercury::test {
namespace {

VideoTiming video(double rate, double speed) { return {.interval = speed / rate}; }

TEST(PlaceOfFrame, TenSecondsOfVideoAreTenSecondsOfSimulation) {
  const auto step = [](std::int64_t frame, const VideoTiming& timing, double dt) {
    const FramePlace place = place_of_frame(frame, timing, dt);
    EXPECT_FALSE(place.is_between_steps()) << frame;
    return place.step;
  };
  EXPECT_EQ(step(0, video(30, 1), 1e-3), 0);
  EXPECT_EQ(step(300, video(30, 1), 1e-3), 10000);
  EXPECT_EQ(step(300, video(30, 4), 1e-3), 40000);
  EXPECT_EQ(step(600, video(60, 1), 1e-3), 10000);
  EXPECT_EQ(step(0, {.start = 3}, 1e-3), 3000);
}

TEST(PlaceOfFrame, IsTheTimeOfTheFrame) {
  for (const double rate : {24.0, 25.0, 30.0, 30000.0 / 1001, 60.0})
    for (const double speed : {1.0, 0.001, 7.0})
      for (const double dt : {1e-3, 7e-4, 1.0 / 3})
        for (std::int64_t frame = 0; frame < 100000; frame += 997) {
          const FramePlace place = place_of_frame(frame, video(rate, speed), dt);
          const double time = (static_cast<double>(place.step) + place.share) * dt;
          EXPECT_GE(place.share, 0);
          EXPECT_LT(place.share, 1);
          EXPECT_NEAR(time, static_cast<double>(frame) * speed / rate, 2e-6 * dt);
        }
}

constexpr Vec3 velocity{0.3f, -0.2f, 0.1f};

// Nothing acts on it, and its springs are without stiffness: each of its masses moves on a straight line.
Simulation drifting(double dt) {
  Robot robot;
  robot.name = "drifting";
  robot.masses = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  robot.materials = {{}, {.stiffness = 0}};
  robot.springs = {{0, 1, 1, 1}, {0, 2, 1, 1}, {0, 3, 1, 1}};
  robot.faces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  robot.velocity.assign(robot.masses.size(), velocity);
  return Simulation({.dt = dt, .damping = 0, .environment = Environment{}, .device = {.kind = DeviceKind::cpu}},
                    std::vector{robot});
}

void expect_on_the_line(const std::vector<Vec3>& positions, double time, std::int64_t frame) {
  const auto way = static_cast<float>(time);
  EXPECT_NEAR(positions[0].x, way * velocity.x, 3e-6) << frame;
  EXPECT_NEAR(positions[0].y, way * velocity.y, 3e-6) << frame;
  EXPECT_NEAR(positions[0].z, way * velocity.z, 3e-6) << frame;
}

// Keeps the positions that are drawn.
class WatchedBridge final : public PositionBridge {
 public:
  std::unique_ptr<PositionSnapshot> take(const Simulation& simulation) override { return host_->take(simulation); }
  std::unique_ptr<PositionSnapshot> mix(const PositionSnapshot& earlier, const PositionSnapshot& later,
                                        float share) override {
    return host_->mix(earlier, later, share);
  }
  void show(const PositionSnapshot& snapshot, render::Renderer& renderer, render::Scene& scene) override {
    snapshot.read(0, drawn.emplace_back(renderer.mass_count()));
    host_->show(snapshot, renderer, scene);
  }
  std::vector<std::vector<Vec3>> drawn;

 private:
  std::unique_ptr<PositionBridge> host_ = make_host_bridge();
};

class CountingWriter final : public FrameWriter {
 public:
  void write(const render::Image&) override { ++frames; }
  void finish() override {}
  std::string description() const override { return "nothing"; }
  int frames = 0;
};

TEST(VideoStages, RobotsOfConstantVelocityAreOnTheirLineInEachFrame) {
  std::optional<OffscreenRenderer> offscreen;
  try {
    offscreen.emplace(make_offscreen_renderer(render::ContextKind::automatic, {64, 36}, render::Quality::low));
  } catch (const render::ContextError& error) {
    GTEST_SKIP() << "no OpenGL here: " << error.what();
  }
  struct Case {
    double rate, speed, seconds;
    std::vector<double> dt;  // of the sides
  };
  // The second shows several frames per step, the third begins between two steps.
  for (const Case& one : {Case{30, 1, 1, {1e-3, 7e-3}}, Case{30, 0.01, 0.005, {1e-3}}, Case{24, 3, 1, {0.05}}}) {
    VideoTiming timing = video_timing(one.seconds, one.speed, one.rate);
    timing.start = one.dt.size() == 1 ? 0.0105 : 0;
    std::vector<Simulation> simulations;
    std::vector<WatchedBridge> bridges(one.dt.size());
    std::vector<std::unique_ptr<GroupDrawing>> drawings;
    for (const double dt : one.dt) simulations.push_back(drifting(dt));
    CountingWriter writer;
    VideoParts parts{.sides = {},
                     .writer = writer,
                     .pixels = render::PixelFormat::rgb,
                     .combine = [](std::span<const render::Image> sides, render::Image& into) { into = sides[0]; }};
    for (std::size_t i = 0; i < simulations.size(); ++i) {
      drawings.push_back(std::make_unique<GroupDrawing>(simulations[i], ViewSettings{}, 16.0f / 9));
      drawings.back()->set_bodies(offscreen->renderer);
      parts.sides.push_back({simulations[i], bridges[i], *drawings.back(), offscreen->renderer});
    }
    run_video_stages(parts, timing, true);
    const auto frames = std::llround(one.seconds * one.rate / one.speed);
    EXPECT_EQ(writer.frames, frames);
    for (const WatchedBridge& bridge : bridges) {
      ASSERT_EQ(bridge.drawn.size(), static_cast<std::size_t>(frames));
      for (std::int64_t frame = 0; frame < frames; ++frame)
        expect_on_the_line(bridge.drawn[static_cast<std::size_t>(frame)],
                           timing.start + static_cast<double>(frame) * one.speed / one.rate, frame);
    }
  }
}

// A robot that falls freely is at n g dt^2 (n + 1) / 2 below its start after n steps, with the speed n g dt.
TEST(MomentSampler, MixesPlacesAndTakesColorsOfTheNearerStep) {
  constexpr double dt = 1e-3, g = 10;
  Simulation simulation = drifting(dt);
  Configuration falling = simulation.configuration();
  falling.environment.gravity = {0, 0, -static_cast<float>(g)};
  Robot robot = simulation.robot(0);
  robot.velocity.clear();
  simulation = Simulation(falling, std::vector{robot});
  GroupDrawing drawing(simulation, {.color = &color_quantity("speed")}, 1);
  const auto bridge = make_host_bridge();
  MomentSampler sampler(simulation, drawing, *bridge, false);
  const auto height = [](double n) { return -n * (n + 1) / 2 * g * dt * dt; };
  const auto take = [&](FramePlace place) {
    int observed = 0;
    for (; const auto step = sampler.next_step(place); ++observed) {
      simulation.step(*step - simulation.steps());
      sampler.observe(place);
    }
    EXPECT_EQ(observed, place.is_between_steps() ? 2 : 1);
    return sampler.moment(place);
  };
  struct Case {
    std::int64_t step;
    float share;
    double nearer;
  };
  for (const auto& [step, share, nearer] :
       {Case{0, 0, 0}, Case{33, 0.25f, 33}, Case{66, 0.75f, 67}, Case{100, 0, 100}}) {
    const auto n = static_cast<double>(step);
    const FrameSnapshot snapshot = take({.step = step, .share = share});
    const double fallen = (1 - share) * height(n) + share * height(n + 1);
    std::vector<Vec3> positions(4);
    snapshot.positions->read(0, positions);
    EXPECT_NEAR(snapshot.time, (n + share) * dt, 1e-9);
    EXPECT_NEAR(positions[0].z, fallen, 1e-7) << step;
    EXPECT_NEAR(snapshot.telemetry[0].center_of_mass.z, 0.25 + fallen, 1e-6) << step;
    ASSERT_EQ(snapshot.details.values.mass.size(), 4u) << step;
    EXPECT_NEAR(snapshot.details.values.mass[0], nearer * g * dt, 1e-5) << step;
  }
}

}  // namespace
}  // namespace mercury::test
