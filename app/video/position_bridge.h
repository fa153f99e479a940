// SPDX-License-Identifier: Apache-2.0
// How positions get from the simulation into the renderer's buffer: through the host's memory, or on the GPU.
//
// The simulating thread takes a snapshot per frame and goes on; the drawing thread shows it later:
//
//   simulating thread   take() --> PositionSnapshot --> queue
//   drawing thread                                      queue --> show() --> Renderer::draw()
//
// 1. A snapshot is a copy, because the simulation has stepped on when it is drawn.
// 2. The CUDA bridge copies twice, simulation -> snapshot -> OpenGL buffer, because there is one OpenGL buffer and
//    several snapshots may be waiting. Events between its stream and the simulation's keep the order.
#pragma once

#include <memory>
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
};

// The simulating thread calls take() and the drawing thread calls show(), possibly at the same time.
class PositionBridge {
 public:
  virtual ~PositionBridge() = default;
  // Copies the present positions.
  virtual std::unique_ptr<PositionSnapshot> take(const Simulation& simulation) = 0;
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

// Copies from CUDA's memory into the renderer's buffer on the GPU that both use. The renderer must have the
// simulation's bodies. Its context must be current here, in show() and in the bridge's destructor. Destroy the bridge
// before the next Renderer::set_bodies(). Throws NoInterop.
std::unique_ptr<PositionBridge> make_cuda_bridge(const Simulation& simulation, const render::Renderer& renderer);

// CUDA ordinal of the GPU that draws in the current context; -1 = none that CUDA knows.
int cuda_device_of_current_context();

struct ChosenBridge {
  std::unique_ptr<PositionBridge> bridge;
  bool on_card = false;  // positions do not pass through the host
  std::string note;      // why they do although a GPU simulates; empty = nothing to say
};
// The CUDA bridge if `interop` allows it and it works, else the host's. The rules of make_cuda_bridge() apply.
ChosenBridge choose_bridge(const Simulation& simulation, const render::Renderer& renderer, bool interop);

}  // namespace mercury
