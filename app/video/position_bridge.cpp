// SPDX-License-Identifier: Apache-2.0
#include "app/video/position_bridge.h"

#include <algorithm>
#include <mutex>

#include "app/base/frame_places.h"

namespace mercury {
namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(float), "positions are passed on as plain floats");

// Memory of finished snapshots; the next ones use it again.
class HostPool {
 public:
  std::vector<Vec3> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return {};
    std::vector<Vec3> positions = std::move(free_.back());
    free_.pop_back();
    return positions;
  }
  void put(std::vector<Vec3> positions) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(positions));
  }

 private:
  std::mutex mutex_;
  std::vector<std::vector<Vec3>> free_;
};

class HostSnapshot final : public PositionSnapshot {
 public:
  HostSnapshot(std::shared_ptr<HostPool> pool, const Simulation& simulation)
      : pool_(std::move(pool)), positions_(pool_->take()) {
    positions_.resize(simulation.mass_count());
    simulation.read_positions(positions_);
  }
  HostSnapshot(std::shared_ptr<HostPool> pool, const HostSnapshot& earlier, const HostSnapshot& later, float share)
      : pool_(std::move(pool)), positions_(pool_->take()) {
    positions_ = earlier.positions_;
    interpolate(positions_, later.positions_, share);
  }
  ~HostSnapshot() override { pool_->put(std::move(positions_)); }

  void read(std::size_t first, std::span<Vec3> out) const override {
    std::ranges::copy(std::span(positions_).subspan(first, out.size()), out.begin());
  }
  std::span<const float> floats() const { return {&positions_.data()->x, 3 * positions_.size()}; }

 private:
  std::shared_ptr<HostPool> pool_;
  std::vector<Vec3> positions_;
};

class HostBridge final : public PositionBridge {
 public:
  std::unique_ptr<PositionSnapshot> take(const Simulation& simulation) override {
    return std::make_unique<HostSnapshot>(pool_, simulation);
  }
  std::unique_ptr<PositionSnapshot> mix(const PositionSnapshot& earlier, const PositionSnapshot& later,
                                        float share) override {
    return std::make_unique<HostSnapshot>(pool_, dynamic_cast<const HostSnapshot&>(earlier),
                                          dynamic_cast<const HostSnapshot&>(later), share);
  }
  void show(const PositionSnapshot& snapshot, render::Renderer&, render::Scene& scene) override {
    scene.positions = dynamic_cast<const HostSnapshot&>(snapshot).floats();
  }

 private:
  std::shared_ptr<HostPool> pool_ = std::make_shared<HostPool>();
};

}  // namespace

std::unique_ptr<PositionBridge> make_host_bridge() { return std::make_unique<HostBridge>(); }

ChosenBridge choose_bridge(int cuda_device, bool interop) {
  if (!interop || cuda_device < 0) return {.bridge = make_host_bridge()};
  try {
    return {.bridge = make_cuda_bridge(cuda_device), .on_device = true};
  } catch (const std::runtime_error& error) {  // NoInterop, or the GPU has no memory left
    return {.bridge = make_host_bridge(),
            .note = std::string("positions are copied through the host: ") + error.what()};
  }
}

}  // namespace mercury
