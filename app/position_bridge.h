// How positions come from the simulation into the renderer's buffer.
#pragma once

#include <memory>
#include <vector>

#include "render/renderer.h"
#include "render/scene.h"
#include "sim/simulation.h"

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

}  // namespace mercury
