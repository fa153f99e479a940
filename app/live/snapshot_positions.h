// SPDX-License-Identifier: Apache-2.0
// The positions of a snapshot: on the host, or on the GPU until somebody on the host asks for them.
#pragma once

#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "app/video/position_bridge.h"

namespace mercury {

// The physics thread sets them; afterwards every thread may read them.
class SnapshotPositions {
 public:
  std::size_t size() const { return size_; }  // number of masses
  // Positions on the host, to be written [m].
  std::span<Vec3> set_on_host(std::size_t masses);
  void set_on_device(std::unique_ptr<PositionSnapshot> positions, std::size_t masses);
  // Gives back the memory of the GPU.
  void release_device() { device_.reset(); }

  // Null = they are on the host.
  const PositionSnapshot* device() const { return device_.get(); }
  // The first call copies them from the GPU and waits for that. Throws DeviceError.
  std::span<const Vec3> host() const;

 private:
  std::size_t size_ = 0;
  std::unique_ptr<PositionSnapshot> device_;
  mutable std::mutex mutex_;
  mutable bool on_host_ = true;
  mutable std::vector<Vec3> host_;
};

}  // namespace mercury
