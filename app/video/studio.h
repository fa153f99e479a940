// SPDX-License-Identifier: Apache-2.0
// Everything that a film of a group needs, put together.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/scene/view_settings.h"
#include "app/video/film.h"
#include "render/context.h"
#include "render/renderer.h"

namespace mercury {

// What draws: an OpenGL context without a window, and a renderer in it.
struct Stage {
  std::unique_ptr<render::Context> context;
  render::Renderer renderer;
};
// On the card with that CUDA ordinal, if there is a choice; -1 = any. Throws render::ContextError when no context can
// be had.
Stage make_stage(render::ContextKind kind, PictureSize size, render::Quality quality, int cuda_device = -1);

// A group of robots on a stage: where they stand, how they look, and who holds the camera. Refers to the stage.
class Studio {
 public:
  // Throws InputError for a setting that does not suit the robots or their environment.
  Studio(Stage& stage, Simulation simulation, const ViewSettings& settings);

  const Simulation& simulation() const { return simulation_; }
  // Whether positions go from the simulation to the picture without leaving the card, and if a GPU simulates and they
  // do not, why.
  bool positions_on_card() const { return bridge_.on_card; }
  const std::string& bridge_note() const { return bridge_.note; }
  // See film().
  FilmResult film(FrameWriter& writer, render::PixelFormat pixels, const FilmTiming& timing, bool quiet,
                  FilmControl* control = nullptr);

 private:
  Stage& stage_;
  Simulation simulation_;
  GroupScene scene_;
  Cameraman camera_;
  DetailObserver details_;
  ChosenBridge bridge_;
};

}  // namespace mercury
