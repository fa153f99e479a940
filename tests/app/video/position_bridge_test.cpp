// SPDX-License-Identifier: Apache-2.0
#include "app/video/position_bridge.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/scene/group_scene.h"
#include "app/video/video_pipeline.h"
#include "mercury/cuda_devices.h"
#include "mercury/random_voxel.h"
#include "mercury/simulation.h"
#include "render/readback.h"

namespace mercury::test {
namespace {

// Some swimming robots, and a renderer with their bodies.
class PositionBridgeTest : public testing::Test {
 protected:
  void set_up(DeviceKind device) {
    try {
      context_ = render::make_context({.cuda_device = device == DeviceKind::cuda ? 0 : -1});
    } catch (const render::ContextError& error) {
      GTEST_SKIP() << "no OpenGL here: " << error.what();
    }
    context_->take_messages();
    simulation_.emplace(Configuration{.device = {.kind = device}}, random_voxel_robots({}, 1, 5));
    renderer_.emplace(*context_, render::RendererOptions{.width = 320, .height = 180});
    offsets_.resize(simulation_->size());
    for (std::size_t i = 0; i < offsets_.size(); ++i) offsets_[i] = {1.0f * static_cast<float>(i), 0, 0};
    scene_.emplace(*simulation_, offsets_, ViewSettings{});
    scene_->set_bodies(*renderer_);
  }
  void TearDown() override {
    if (!context_) return;
    for (const std::string& message : context_->take_messages()) ADD_FAILURE() << "OpenGL says: " << message;
    renderer_.reset();
  }

  render::Image picture(PositionBridge& bridge, const PositionSnapshot& snapshot) {
    bridge.show(snapshot, *renderer_, scene_->scene());
    renderer_->draw(scene_->scene(), render::Orbit{.target = {2, 0, 0}, .distance = 8}.camera());
    return render::read(*renderer_);
  }

  std::unique_ptr<render::Context> context_;
  std::optional<Simulation> simulation_;
  std::optional<render::Renderer> renderer_;
  std::optional<GroupScene> scene_;
  std::vector<render::Vector3> offsets_;
};

TEST_F(PositionBridgeTest, HostSnapshotsKeepTheirPositions) {
  ASSERT_NO_FATAL_FAILURE(set_up(DeviceKind::cpu));
  if (IsSkipped()) return;
  const auto bridge = make_host_bridge();
  simulation_->step(200);
  const auto early = bridge->take(*simulation_);
  const render::Image before = picture(*bridge, *early);
  simulation_->step(800);
  const auto late = bridge->take(*simulation_);
  EXPECT_NE(picture(*bridge, *late).bytes, before.bytes);
  EXPECT_EQ(picture(*bridge, *early).bytes, before.bytes);
}

TEST_F(PositionBridgeTest, MixedSnapshotsLieOnTheLineBetweenTheTwo) {
  ASSERT_NO_FATAL_FAILURE(set_up(DeviceKind::cpu));
  if (IsSkipped()) return;
  const auto bridge = make_host_bridge();
  const auto read = [&](const PositionSnapshot& snapshot) {
    std::vector<Vec3> positions(simulation_->mass_count());
    snapshot.read(0, positions);
    return positions;
  };
  simulation_->step(200);
  const auto early = bridge->take(*simulation_);
  simulation_->step(200);
  const auto late = bridge->take(*simulation_);
  const auto mixed = bridge->mix(*early, *late, 0.25f);
  const std::vector<Vec3> first = read(*early), last = read(*late), between = read(*mixed);
  for (std::size_t i = 0; i < between.size(); ++i) {
    EXPECT_NEAR(between[i].x, 0.75f * first[i].x + 0.25f * last[i].x, 1e-6f);
    EXPECT_NEAR(between[i].z, 0.75f * first[i].z + 0.25f * last[i].z, 1e-6f);
  }
}

TEST_F(PositionBridgeTest, CpuSimulationsUseTheHostBridgeWithoutANote) {
  ASSERT_NO_FATAL_FAILURE(set_up(DeviceKind::cpu));
  if (IsSkipped()) return;
  const ChosenBridge chosen = choose_bridge(simulation_->cuda_device(), true);
  EXPECT_FALSE(chosen.on_device);
  EXPECT_EQ(chosen.note, "");
  EXPECT_THROW(make_cuda_bridge(simulation_->cuda_device()), NoInterop);
}

TEST_F(PositionBridgeTest, BothBridgesGiveTheSamePictureBitForBit) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device here";
  ASSERT_NO_FATAL_FAILURE(set_up(DeviceKind::cuda));
  if (IsSkipped()) return;
  const ChosenBridge device = choose_bridge(simulation_->cuda_device(), true);
  if (!device.on_device) GTEST_SKIP() << device.note;
  const ChosenBridge host = choose_bridge(simulation_->cuda_device(), false);
  EXPECT_FALSE(host.on_device);
  EXPECT_EQ(host.note, "");
  for (int moment = 0; moment < 4; ++moment) {
    simulation_->step(250);
    const auto on_device = device.bridge->take(*simulation_), on_host = host.bridge->take(*simulation_);
    simulation_->step(50);  // changes neither snapshot
    const render::Image drawn = picture(*device.bridge, *on_device);
    EXPECT_EQ(drawn.bytes, picture(*host.bridge, *on_host).bytes) << moment;
    const auto later_on_device = device.bridge->take(*simulation_), later_on_host = host.bridge->take(*simulation_);
    simulation_->step(50);
    const auto mixed_on_device = device.bridge->mix(*on_device, *later_on_device, 0.3f),
               mixed_on_host = host.bridge->mix(*on_host, *later_on_host, 0.3f);
    const render::Image mixed = picture(*device.bridge, *mixed_on_device);
    EXPECT_EQ(mixed.bytes, picture(*host.bridge, *mixed_on_host).bytes) << moment;
    EXPECT_NE(mixed.bytes, drawn.bytes) << moment;
    std::vector<Vec3> read_from_device(simulation_->mass_count()), read_from_host(simulation_->mass_count());
    mixed_on_device->read(0, read_from_device);
    mixed_on_host->read(0, read_from_host);
    EXPECT_EQ(read_from_device, read_from_host) << moment;
  }
}

TEST_F(PositionBridgeTest, SnapshotsFromAnotherThreadAreShownInOrder) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device here";
  ASSERT_NO_FATAL_FAILURE(set_up(DeviceKind::cuda));
  if (IsSkipped()) return;
  const ChosenBridge device = choose_bridge(simulation_->cuda_device(), true);
  if (!device.on_device) GTEST_SKIP() << device.note;
  const auto host = make_host_bridge();
  std::vector<std::unique_ptr<PositionSnapshot>> on_device, on_host;
  std::thread([&] {
    for (int moment = 0; moment < 6; ++moment) {
      simulation_->step(100);
      on_device.push_back(device.bridge->take(*simulation_));
      on_host.push_back(host->take(*simulation_));
    }
  }).join();
  for (std::size_t moment = 0; moment < on_device.size(); ++moment) {
    const render::Image drawn = picture(*device.bridge, *on_device[moment]);
    EXPECT_EQ(drawn.bytes, picture(*host, *on_host[moment]).bytes) << moment;
  }
}

}  // namespace
}  // namespace mercury::test
