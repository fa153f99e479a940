// SPDX-License-Identifier: Apache-2.0
#include "app/live/snapshot_positions.h"

#include <utility>

namespace mercury {

std::span<Vec3> SnapshotPositions::set_on_host(std::size_t masses) {
  device_.reset();
  on_host_ = true;
  host_.resize(size_ = masses);
  return host_;
}

void SnapshotPositions::set_on_device(std::unique_ptr<PositionSnapshot> positions, std::size_t masses) {
  device_ = std::move(positions);
  on_host_ = false;
  size_ = masses;
}

std::span<const Vec3> SnapshotPositions::host() const {
  const std::lock_guard lock(mutex_);
  if (!on_host_) {
    host_.resize(size_);
    device_->read(host_);
    on_host_ = true;
  }
  return host_;
}

}  // namespace mercury
