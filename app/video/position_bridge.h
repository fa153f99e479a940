// SPDX-License-Identifier: Apache-2.0
// How positions come from the simulation into the renderer's buffer.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "mercury/simulation.h"
#include "render/renderer.h"
#include "render/scene.h"

namespace mercury {

// The positions of all masses at one moment, kept where the bridge likes.
class PositionSnapshot {
 public:
  virtual ~PositionSnapshot() = default;
};

// take() is called by the thread that simulates, show() by the thread that draws; they may run at the same time.
class PositionBridge {
 public:
  virtual ~PositionBridge() = default;
  // Keeps the positions as they are now.
  virtual std::unique_ptr<PositionSnapshot> take(const Simulation& simulation) = 0;
  // Makes them what the renderer draws next: through scene.positions, which then refers to the snapshot, or straight
  // into the renderer's buffer.
  virtual void show(const PositionSnapshot& snapshot, render::Renderer& renderer, render::Scene& scene) = 0;
};

// Copies through the host's memory: works everywhere.
std::unique_ptr<PositionBridge> make_host_bridge();

// CUDA and OpenGL cannot share memory here; what() is one line that says why.
class NoInterop : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// From CUDA's memory into the renderer's buffer without leaving the card that both use. The renderer must have the
// simulation's bodies, and its context must be current here, in show(), and when the bridge is destroyed, which must
// happen before Renderer::set_bodies() is called again. Throws NoInterop.
std::unique_ptr<PositionBridge> make_cuda_bridge(const Simulation& simulation, const render::Renderer& renderer);

// CUDA ordinal of the card that draws in the current context, as CUDA tells; -1 = none.
int cuda_device_of_current_context();

struct ChosenBridge {
  std::unique_ptr<PositionBridge> bridge;
  bool on_card = false;  // positions do not pass through the host
  std::string note;      // why they do although a GPU simulates; empty = nothing to tell
};
// The CUDA bridge where `interop` allows it and it works, else the host's. As make_cuda_bridge().
ChosenBridge choose_bridge(const Simulation& simulation, const render::Renderer& renderer, bool interop);

}  // namespace mercury
