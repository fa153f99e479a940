// SPDX-License-Identifier: Apache-2.0
// How positions get from the simulation into the renderer's buffer: through the host's memory, or on the GPU.
//
// The simulating thread takes a snapshot per frame and goes on; the drawing thread shows it later:
//
//   simulating thread   take() --> PositionSnapshot --> queue
//   drawing thread                                      queue --> show() --> Renderer::draw()
//
// 1. A snapshot is a copy, because the simulation has stepped on when it is drawn.
// 2. The CUDA bridge copies twice, simulation -> snapshot -> the renderer's buffer, because there is one such buffer
//    and several snapshots may be waiting. Both copies stay on the GPU.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mercury/simulation.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace mercury {

// The positions of all masses at one time. Each bridge keeps them in its own kind of memory.
class PositionSnapshot {
 public:
  virtual ~PositionSnapshot() = default;
  // Copies out.size() positions from that of mass `first` on to the host; waits for them. Safe to call from any thread.
  virtual void read(std::size_t first, std::span<Vec3> out) const = 0;
};

// The simulating thread calls take() and the drawing thread calls show(), possibly at the same time. A bridge serves
// one simulation.
class PositionBridge {
 public:
  virtual ~PositionBridge() = default;
  // Copies the current positions.
  virtual std::unique_ptr<PositionSnapshot> take(const Simulation& simulation) = 0;
  // Positions at that share of the way from one snapshot to another: interpolated() of app/base/frame_places.h. Called
  // like take().
  virtual std::unique_ptr<PositionSnapshot> mix(const PositionSnapshot& earlier, const PositionSnapshot& later,
                                                float share) = 0;
  // Makes the renderer draw them next: sets scene.positions, which then refers to the snapshot, or writes into the
  // renderer's buffer.
  virtual void show(const PositionSnapshot& snapshot, render::Renderer& renderer, render::Scene& scene) = 0;
};

// Copies through the host's memory: works everywhere.
std::unique_ptr<PositionBridge> make_host_bridge();

// CUDA and OpenGL cannot share memory here; what() is one line that says why.
class NoInterop : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Copies from CUDA's memory into the renderer's buffer on the GPU `cuda_device`, which must also draw in the current
// context. That context must be current here, in show() and in the bridge's destructor. Throws NoInterop.
std::unique_ptr<PositionBridge> make_cuda_bridge(int cuda_device);

// CUDA ordinal of the GPU that draws in the current context; -1 = none that CUDA knows.
int cuda_device_of_current_context();

struct ChosenBridge {
  std::unique_ptr<PositionBridge> bridge;
  bool on_device = false;  // positions do not pass through the host
  std::string note;        // why they do although a GPU simulates; empty = nothing to say
};
// The CUDA bridge if `interop` allows it and it works with the device that simulates (Simulation::cuda_device()), else
// the host's. The rules of make_cuda_bridge() apply.
ChosenBridge choose_bridge(int cuda_device, bool interop);

}  // namespace mercury
