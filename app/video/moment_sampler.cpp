// SPDX-License-Identifier: Apache-2.0
#include "app/video/moment_sampler.h"

#include <utility>

namespace mercury {

std::optional<std::int64_t> MomentSampler::next_step(const FramePlace& place) const {
  if (step_ != place.step) {
    const std::optional<std::int64_t> look = drawing_.next_look();
    return look && *look < place.step ? *look : place.step;
  }
  if (place.is_between_steps() && !share_ && !later_) return place.step + 1;
  return std::nullopt;
}

// Colors and arrows are those of the nearer step, so the other one does not compute them.
void MomentSampler::observe(const FramePlace& place) {
  if (step_ != place.step && simulation_.steps() < place.step) return drawing_.look();
  if (share_) *share_ = place.share;
  if (step_ == place.step) {
    later_ = drawing_.take(bridge_, dense_ || place.share >= 0.5f);
    return;
  }
  later_.reset();
  earlier_ = drawing_.take(bridge_, dense_ || share_ || place.share < 0.5f, share_ ? place.share : 0);
  step_ = simulation_.steps();
}

FrameSnapshot MomentSampler::moment(const FramePlace& place) {
  if (place.is_between_steps() && !share_) return GroupDrawing::between(earlier_, *later_, place.share, bridge_);
  step_.reset();
  return std::move(earlier_);
}

}  // namespace mercury
