// SPDX-License-Identifier: Apache-2.0
#include "bench/published_kernel.cuh"

#include <algorithm>
#include <cmath>

#include "sim/cuda/memory.h"

namespace mercury::published {
namespace {

using cuda::check;
using cuda::DeviceArray;

constexpr float dt = 1e-3f, half_density = 500, drag_coefficient = 1, lift_coefficient = 0.2f, damping = 0.1f;
constexpr unsigned threads = 1024;

// Each robot has a chunk of each buffer, sized by the largest robot (paper, II.D).
struct Buffers {
  float3 *positions, *velocities;
  const Spring* springs;
  const Face* faces;
  const uint3* counts;  // masses, springs, faces of each robot
  const Material* materials;
  unsigned mass_stride, spring_stride, face_stride;
};

__device__ float3 operator+(float3 a, float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
__device__ float3 operator-(float3 a, float3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
__device__ float3 operator*(float s, float3 a) { return {s * a.x, s * a.y, s * a.z}; }
__device__ float inner(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
__device__ float3 outer(float3 a, float3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
__device__ void add(float3& sum, float3 value) {
  atomicAdd(&sum.x, value.x);
  atomicAdd(&sum.y, value.y);
  atomicAdd(&sum.z, value.z);
}

__global__ void step(Buffers buffers, float time) {
  extern __shared__ float3 memory[];
  const uint3 count = buffers.counts[blockIdx.x];
  float3 *x = memory, *v = x + buffers.mass_stride, *force = v + buffers.mass_stride;
  float3* global_x = buffers.positions + std::size_t{blockIdx.x} * buffers.mass_stride;
  float3* global_v = buffers.velocities + std::size_t{blockIdx.x} * buffers.mass_stride;
  for (unsigned i = threadIdx.x; i < count.x; i += blockDim.x) {
    x[i] = global_x[i];
    v[i] = global_v[i];
    force[i] = {0, 0, 0};
  }
  __syncthreads();
  const Face* faces = buffers.faces + std::size_t{blockIdx.x} * buffers.face_stride;
  for (unsigned f = threadIdx.x; f < count.z; f += blockDim.x) {
    const Face face = faces[f];
    const float3 u = (-1.0f / 3) * (v[face.a] + v[face.b] + v[face.c]);
    const float3 area_normal = 0.5f * outer(x[face.b] - x[face.a], x[face.c] - x[face.a]);
    const float flux = inner(area_normal, u);
    const float3 third =
        (half_density / 3) * ((drag_coefficient - lift_coefficient) * fabsf(flux) * u +
                              (flux < 0 ? -lift_coefficient : lift_coefficient) * inner(u, u) * area_normal);
    add(force[face.a], third);
    add(force[face.b], third);
    add(force[face.c], third);
  }
  const Spring* springs = buffers.springs + std::size_t{blockIdx.x} * buffers.spring_stride;
  for (unsigned s = threadIdx.x; s < count.y; s += blockDim.x) {
    const Spring spring = springs[s];
    const Material material = buffers.materials[spring.material];
    const float length =
        spring.rest_length * (1 + material.amplitude * sinf(material.frequency * time + material.phase));
    const float3 d = x[spring.b] - x[spring.a];
    const float distance = sqrtf(inner(d, d));
    const float3 pull = (material.stiffness * (distance - length) / distance) * d;
    add(force[spring.a], pull);
    add(force[spring.b], -1.0f * pull);
  }
  __syncthreads();
  const float zeta = expf(-damping * dt);
  for (unsigned i = threadIdx.x; i < count.x; i += blockDim.x) {
    const float3 moved = v[i] + dt * force[i];
    global_x[i] = x[i] + dt * moved;
    global_v[i] = zeta * moved;
  }
}

class Batch {
 public:
  explicit Batch(std::span<const Robot> robots) : robots_(robots.size()) {
    std::vector<uint3> counts;
    for (const Robot& robot : robots) {
      counts.push_back({static_cast<unsigned>(robot.masses.size()), static_cast<unsigned>(robot.springs.size()),
                        static_cast<unsigned>(robot.faces.size())});
      buffers_.mass_stride = std::max(buffers_.mass_stride, counts.back().x);
      buffers_.spring_stride = std::max(buffers_.spring_stride, counts.back().y);
      buffers_.face_stride = std::max(buffers_.face_stride, counts.back().z);
    }
    positions_ = DeviceArray<float3>(robots_ * buffers_.mass_stride);
    velocities_ = DeviceArray<float3>(robots_ * buffers_.mass_stride);
    springs_ = DeviceArray<Spring>(robots_ * buffers_.spring_stride);
    faces_ = DeviceArray<Face>(robots_ * buffers_.face_stride);
    counts_ = DeviceArray<uint3>(robots_);
    materials_ = DeviceArray<Material>(default_materials().size());
    for (std::size_t i = 0; i < robots_; ++i) {
      std::vector<float3> masses;
      for (const Vec3 m : robots[i].masses) masses.push_back({m.x, m.y, m.z});
      positions_.write(i * buffers_.mass_stride, masses, cudaStreamLegacy);
      springs_.write(i * buffers_.spring_stride, robots[i].springs, cudaStreamLegacy);
      faces_.write(i * buffers_.face_stride, robots[i].faces, cudaStreamLegacy);
    }
    counts_.write(0, counts, cudaStreamLegacy);
    materials_.write(0, default_materials(), cudaStreamLegacy);
    buffers_.positions = positions_.data();
    buffers_.velocities = velocities_.data();
    buffers_.springs = springs_.data();
    buffers_.faces = faces_.data();
    buffers_.counts = counts_.data();
    buffers_.materials = materials_.data();
    bytes_ = 3 * sizeof(float3) * buffers_.mass_stride;
    check(cudaFuncSetAttribute(step, cudaFuncAttributeMaxDynamicSharedMemorySize, static_cast<int>(bytes_)),
          "reserving shared memory for the published kernel");
  }

  void advance(long long steps) {
    for (long long n = 0; n < steps; ++n, ++done_)
      step<<<static_cast<unsigned>(robots_), threads, bytes_>>>(buffers_, static_cast<float>(done_) * dt);
    check(cudaGetLastError(), "starting the published kernel");
  }

  std::vector<Vec3> positions(std::size_t masses) const {
    std::vector<float3> raw(masses);
    positions_.read(0, raw, cudaStreamLegacy);
    std::vector<Vec3> result;
    for (const float3 x : raw) result.push_back({x.x, x.y, x.z});
    return result;
  }

 private:
  std::size_t robots_, bytes_ = 0;
  long long done_ = 0;
  Buffers buffers_{};
  DeviceArray<float3> positions_, velocities_;
  DeviceArray<Spring> springs_;
  DeviceArray<Face> faces_;
  DeviceArray<uint3> counts_;
  DeviceArray<Material> materials_;
};

}  // namespace

Result measure(std::span<const Robot> robots, double min_seconds) {
  double springs = 0;
  for (const Robot& robot : robots) springs += static_cast<double>(robot.springs.size());
  Batch batch(robots);
  batch.advance(50);
  Result result;
  for (long long steps = 100; result.seconds < min_seconds; steps *= 2) {
    cuda::Event start{cuda::Event::timed}, end{cuda::Event::timed};
    start.record(cudaStreamLegacy);
    batch.advance(steps);
    end.record(cudaStreamLegacy);
    result.seconds += end.seconds_since(start);
    result.steps += steps;
  }
  result.springs_per_second = springs * static_cast<double>(result.steps) / result.seconds;
  return result;
}

std::vector<Vec3> positions_after(const Robot& robot, int steps) {
  Batch batch(std::span(&robot, 1));
  batch.advance(steps);
  return batch.positions(robot.masses.size());
}

}  // namespace mercury::published
