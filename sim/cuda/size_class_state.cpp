// SPDX-License-Identifier: Apache-2.0
// States and statuses of a size class on their way from and to the host.

#include <algorithm>

#include "mercury/parallel.h"
#include "sim/cuda/size_class.h"

namespace mercury::cuda {
namespace {

// Of pinned memory for states on their way. Always the same size, so that the memory is used again; and not large,
// since all classes read at once and pinned memory takes long to make.
constexpr std::size_t portion_bytes = std::size_t{1} << 20;

}  // namespace

void SizeClass::read(std::uint32_t place, std::span<Vec3> positions, std::span<Vec3> velocities) const {
  const SlotOrder& order = order_of(place);
  std::vector<float> state(sizes_.state());
  state_.read(place, state, urgent_->get());
  for (std::uint32_t i = 0; i < positions.size(); ++i) positions[i] = vector_at(state, order.slot_of(i), field_x);
  for (std::uint32_t i = 0; i < velocities.size(); ++i) velocities[i] = vector_at(state, order.slot_of(i), field_v);
}

void SizeClass::write(std::uint32_t place, std::span<const Vec3> positions, std::span<const Vec3> velocities) {
  const SlotOrder& order = order_of(place);
  std::vector<float> state(sizes_.state());
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    put_vector(state, order.slot_of(i), field_x, positions[i]);
    put_vector(state, order.slot_of(i), field_v, velocities[i]);
  }
  state_.write(place, state, urgent_->get());
}

void SizeClass::put_at_rest(std::uint32_t first_place, std::span<const Robot* const> robots,
                            std::span<const float> lifts) {
  const std::size_t stride = sizes_.state(), most = std::max<std::size_t>(1, portion_bytes / (4 * stride));
  const PinnedBuffer memory(std::max(portion_bytes, 4 * stride));
  for (std::size_t first = 0; first < robots.size(); first += most) {
    const std::size_t count = std::min(most, robots.size() - first);
    const std::span states(reinterpret_cast<float*>(memory.data()), count * stride);
    parallel_for(0, count, [&](std::size_t k) {
      const auto place = first_place + static_cast<std::uint32_t>(first + k);
      fill_state(states.subspan(k * stride, stride), *robots[first + k], order_of(place), lifts[first + k]);
    });
    state_.write(first_place + first, states, urgent_->get());
  }
  statuses_.write(first_place, std::vector<DeviceStatus>(robots.size(), DeviceStatus{-1, no_mass}), urgent_->get());
}

void SizeClass::read_all(Field first_field, std::span<Vec3> out) const {
  if (size() == 0) return;
  const std::size_t stride = sizes_.state(), most = std::max<std::size_t>(1, portion_bytes / (4 * stride));
  const PinnedBuffer memory(std::max(portion_bytes, 4 * stride));
  for (std::size_t first = 0; first < size(); first += most) {
    const std::size_t count = std::min(most, size() - first);
    const std::span states(reinterpret_cast<float*>(memory.data()), count * stride);
    state_.read(first, states, urgent_->get());
    parallel_for(0, count, [&](std::size_t k) {
      const SlotOrder& order = order_of(static_cast<std::uint32_t>(first + k));
      Vec3* const to = &out[first_mass_[first + k]];
      for (std::uint32_t mass = 0; mass < headers_[first + k].masses; ++mass)
        to[mass] = vector_at(states.subspan(k * stride, stride), order.slot_of(mass), first_field);
    });
  }
}

DeviceStatus SizeClass::status(std::uint32_t place) const {
  DeviceStatus status{};
  statuses_.read(place, std::span(&status, 1), urgent_->get());
  return status;
}
std::vector<DeviceStatus> SizeClass::statuses() const {
  std::vector<DeviceStatus> all(size());
  statuses_.read(0, all, urgent_->get());
  return all;
}
void SizeClass::set_status(std::uint32_t place, DeviceStatus status) {
  statuses_.write(place, std::span(&status, 1), urgent_->get());
}

RobotView SizeClass::robot_view(std::uint32_t place) const {
  return {state_.chunk(place),
          masses_.chunk(place),
          point_masses_.size() > 0 ? point_masses_.data() + place * sizes_.slots() : nullptr,
          statuses_.chunk(place),
          first_mass_[place],
          headers_[place].masses,
          headers_[place].mass};
}

}  // namespace mercury::cuda
