// SPDX-License-Identifier: Apache-2.0
// Positions that stay on the GPU: the window's pictures, picks and figures are those of positions on the host. The
// cases of CUDA are skipped where no GPU both simulates and draws.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "app/live/scene_mouse.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_time.h"
#include "app/video/position_bridge.h"
#include "mercury/cuda_devices.h"
#include "mercury/random_voxel.h"
#include "render/context/context.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "tests/app/live/live_scene_setup.h"

namespace mercury {
namespace {

// Keeps positions where only show() and read() reach them, as a GPU does, so that machines without a GPU test the
// rest.
class PretendedDevice final : public PositionBridge {
 public:
  class Kept final : public PositionSnapshot {
   public:
    explicit Kept(const Simulation& simulation) : positions(simulation.mass_count()) {
      simulation.read_positions(positions);
    }
    void read(std::size_t first, std::span<Vec3> out) const override {
      std::ranges::copy(std::span(positions).subspan(first, out.size()), out.begin());
    }
    std::vector<Vec3> positions;
  };
  std::unique_ptr<PositionSnapshot> take(const Simulation& simulation) override {
    return std::make_unique<Kept>(simulation);
  }
  std::unique_ptr<PositionSnapshot> mix(const PositionSnapshot&, const PositionSnapshot&, float) override {
    throw std::logic_error("the window does not mix what is on the GPU");
  }
  void show(const PositionSnapshot& snapshot, render::Renderer&, render::Scene& scene) override {
    const std::vector<Vec3>& positions = dynamic_cast<const Kept&>(snapshot).positions;
    scene.positions = {&positions.data()->x, 3 * positions.size()};
  }
};

enum class Place { pretended, real };

class LiveSceneOnDevice : public testing::TestWithParam<Place> {
 protected:
  void SetUp() override {
    if (GetParam() == Place::real && cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device here";
    try {
      context_ = render::make_context({.cuda_device = GetParam() == Place::real ? 0 : -1});
    } catch (const render::ContextError& error) {
      GTEST_SKIP() << "no OpenGL here: " << error.what();
    }
    on_host_ = std::make_unique<LiveScene>(options());
    on_device_ = std::make_unique<LiveScene>(options());
    std::shared_ptr<PositionBridge> bridge = std::make_shared<PretendedDevice>();
    if (GetParam() == Place::real) {
      ChosenBridge chosen = choose_bridge(on_device_->cuda_device(), true);
      if (!chosen.on_device) GTEST_SKIP() << chosen.note;
      bridge = std::move(chosen.bridge);
    }
    on_device_->set_bridge(std::move(bridge));
  }

  static LiveSceneOptions options() {
    if (GetParam() == Place::pretended) return test::on_cpu();
    return {.configuration = {.device = {.kind = DeviceKind::cuda}}};
  }

  template <class Change>
  void both(Change change) {
    change(*on_host_);
    change(*on_device_);
    on_host_->wait_until_done();
    on_device_->wait_until_done();
  }

  render::Image picture_of(LiveScene& scene) {
    render::Renderer renderer(*context_, {.width = 320, .height = 180});
    DrawnScene& picture = scene.drawn();
    picture.set_bodies(renderer);
    picture.show_positions(renderer);
    renderer.draw(picture.scene(), camera_);
    return render::read(renderer);
  }

  std::unique_ptr<render::Context> context_;
  std::unique_ptr<LiveScene> on_host_, on_device_;
  render::Camera camera_ = render::Orbit{.target = {1, 0, 0}, .distance = 6}.camera();
};

INSTANTIATE_TEST_SUITE_P(All, LiveSceneOnDevice, testing::Values(Place::pretended, Place::real),
                         [](const auto& each) { return each.param == Place::real ? "cuda" : "pretended"; });

TEST_P(LiveSceneOnDevice, GivesTheSamePicturesBitForBit) {
  both([](LiveScene& scene) { test::make_robots(scene, 4); });
  for (int moment = 0; moment < 5; ++moment) {
    both([](LiveScene& scene) { scene.time().step(300); });
    ASSERT_TRUE(on_device_->drawn().positions_on_device());
    ASSERT_FALSE(on_host_->drawn().positions_on_device());
    EXPECT_EQ(picture_of(*on_device_).bytes, picture_of(*on_host_).bytes) << moment;
  }
}

TEST_P(LiveSceneOnDevice, FollowsRobotsThatComeAndGo) {
  for (int count = 1; count < 4; ++count) {
    both([&](LiveScene& scene) {
      test::make_robots(scene, static_cast<std::size_t>(count));
      scene.time().step(100);
    });
    EXPECT_EQ(picture_of(*on_device_).bytes, picture_of(*on_host_).bytes) << count;
  }
  both([](LiveScene& scene) {
    scene.robots().remove({test::ids_of(scene)[1]});
    scene.time().step(50);
  });
  EXPECT_EQ(picture_of(*on_device_).bytes, picture_of(*on_host_).bytes);
}

TEST_P(LiveSceneOnDevice, GivesPositionsToTheHostWhenAsked) {
  both([](LiveScene& scene) {
    test::make_robots(scene, 3);
    scene.time().step(500);
  });
  const std::shared_ptr<const Snapshot> early = on_device_->hold_snapshot();
  EXPECT_TRUE(std::ranges::equal(early->positions.host(), on_host_->snapshot().positions.host()));
  const auto expected = on_host_->hold_snapshot();
  both([](LiveScene& scene) { scene.time().step(500); });
  EXPECT_TRUE(std::ranges::equal(early->positions.host(), expected->positions.host()));
  EXPECT_FALSE(std::ranges::equal(on_device_->snapshot().positions.host(), expected->positions.host()));
}

TEST_P(LiveSceneOnDevice, PicksTheSameRobots) {
  both([](LiveScene& scene) {
    test::make_robots(scene, 4);
    scene.time().step(200);
  });
  const render::Bounds& target = on_host_->drawn().bounds()[2];
  const render::Vector3 eye = target.center() + render::Vector3(0, -5, 0);
  const render::Ray ray{.origin = eye, .direction = {0, 1, 0}};
  const auto from_device = on_device_->mouse().pick(ray), from_host = on_host_->mouse().pick(ray);
  ASSERT_EQ(from_device.has_value(), from_host.has_value());
  ASSERT_TRUE(from_host);
  EXPECT_EQ(from_device->index, from_host->index);
  EXPECT_EQ(from_device->mass, from_host->mass);
}

}  // namespace
}  // namespace mercury
