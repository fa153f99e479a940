// SPDX-License-Identifier: Apache-2.0
// States of the CUDA backend on their way from and to the host and the program's arrays.
#include <algorithm>
#include <numeric>
#include <utility>

#include "mercury/parallel.h"
#include "sim/cuda/backend.h"

namespace mercury::cuda {

void CudaBackend::read(std::size_t robot, std::span<Vec3> positions, std::span<Vec3> velocities) const {
  settle();
  class_of(robot).read(places_[robot].number, positions, velocities);
}

void CudaBackend::write(std::size_t robot, std::span<const Vec3> positions, std::span<const Vec3> velocities) {
  begin_change();
  class_of(robot).write(places_[robot].number, positions, velocities);
}

// A run of consecutive places at a time.
void CudaBackend::put_at_rest(std::span<const Robot* const> robots, std::size_t first, std::span<const float> lifts) {
  begin_change();
  std::vector<std::size_t> order(lifts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto place = [&](std::size_t k) { return places_[first + order[k]]; };
  std::ranges::sort(order, {},
                    [&](std::size_t i) { return std::pair(places_[first + i].size_class, places_[first + i].number); });
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    std::vector<const Robot*> run;
    std::vector<float> run_lifts;
    for (end = begin; end < order.size() && place(end).size_class == place(begin).size_class &&
                      place(end).number == place(begin).number + (end - begin);
         ++end) {
      run.push_back(robots[order[end]]);
      run_lifts.push_back(lifts[order[end]]);
    }
    owned_->classes[place(begin).size_class].put_at_rest(place(begin).number, run, run_lifts);
  }
}

void CudaBackend::put_at_rest_in_stream(std::span<const Robot* const> robots, std::span<const float> lifts,
                                        const std::uint8_t* mask, const PublishedArrays& arrays, void* cuda_stream) {
  if (places_.empty()) return;
  use_device();
  report_valid_ = report_expected_ = copy_valid_ = false;
  const float* const rest = rest_positions(robots, lifts);
  const cudaStream_t stream = enter(cuda_stream);
  put_masked_at_rest(views(), places_.size(), rest, mask, stream);
  publish_states(views(), places_.size(), arrays, stream);
  leave(stream);
}

void CudaBackend::read_positions(std::span<Vec3> out) const { read_all(field_x, out); }
void CudaBackend::read_velocities(std::span<Vec3> out) const { read_all(field_v, out); }

void CudaBackend::read_all(Field first_field, std::span<Vec3> out) const {
  settle();
  parallel_tasks(0, classes().size(), [&](std::size_t c) {
    use_device();
    classes()[c].read_all(first_field, out);
  });
}

bool CudaBackend::copy_positions(float* device_out) const {
  if (places_.empty() || (copy_valid_ && positions_copy_.get() == device_out)) return false;
  use_device();
  const cudaStream_t stream = enter(nullptr);
  publish_states(views(), places_.size(), {.positions = device_out}, stream);
  leave(stream);
  return true;
}

void CudaBackend::copy_positions_with_steps(std::shared_ptr<float> device_out) const {
  positions_copy_ = std::move(device_out);
  copy_valid_ = false;
}

std::shared_ptr<void> CudaBackend::allocate_shared(std::size_t bytes) const {
  use_device();
  return allocate_to_share(bytes);
}

// A program may still write to an array in a stream of its own.
void CudaBackend::copy_shared(void* to, const void* from, std::size_t bytes) const {
  use_device();
  check(cudaDeviceSynchronize(), "waiting for the device");
  check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, cudaStreamLegacy), "copying a shared array");
  check(cudaStreamSynchronize(cudaStreamLegacy), "copying a shared array");
}

void CudaBackend::publish(std::span<const Robot* const>, const PublishedArrays& arrays) const {
  if (places_.empty()) return;
  use_device();
  const cudaStream_t stream = enter(nullptr);
  publish_states(views(), places_.size(), arrays, stream);
  leave(stream);
  settle();
}

RobotStatus CudaBackend::status(std::size_t robot) const {
  settle();
  return status_of(class_of(robot).status(places_[robot].number));
}

std::vector<RobotStatus> CudaBackend::statuses() const {
  settle();
  std::vector<std::vector<DeviceStatus>> of_class;
  for (const auto& robots : classes()) of_class.push_back(robots->statuses());
  std::vector<RobotStatus> all;
  for (const Place place : places_) all.push_back(status_of(of_class[place.size_class][place.number]));
  return all;
}

void CudaBackend::set_status(std::size_t robot, const RobotStatus& status) {
  begin_change();
  class_of(robot).set_status(places_[robot].number, {status.exploded_step, status.bad_mass});
}

const RobotView* CudaBackend::views() const {
  if (!views_valid_) {
    std::vector<RobotView> all;
    all.reserve(places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) all.push_back(class_of(i).robot_view(places_[i].number));
    if (owned_->views.size() < all.size()) owned_->views = DeviceArray<RobotView>(all.size());
    owned_->views.write(0, all, main().get());
    views_valid_ = true;
  }
  return owned_->views.data();
}

const float* CudaBackend::rest_positions(std::span<const Robot* const> robots, std::span<const float> lifts) {
  if (!rest_valid_) {
    settle();
    std::vector<float> all;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const std::vector<Vec3> velocities = start_velocities(*robots[i]);
      for (std::size_t mass = 0; mass < velocities.size(); ++mass) {
        const Vec3 x = at_rest(robots[i]->masses[mass], lifts[i]), v = velocities[mass];
        all.insert(all.end(), {x.x, x.y, x.z, v.x, v.y, v.z});
      }
    }
    if (owned_->rest.size() < all.size()) owned_->rest = DeviceArray<float>(all.size());
    owned_->rest.write(0, all, main().get());
    rest_valid_ = true;
  }
  return owned_->rest.data();
}

}  // namespace mercury::cuda
