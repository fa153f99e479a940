// Everything that a film of a group needs, put together.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/film.h"
#include "app/view_settings.h"
#include "render/context.h"
#include "render/renderer.h"

namespace mercury {

// What draws: an OpenGL context without a window, and a renderer in it.
struct Stage {
  std::unique_ptr<render::Context> context;
  render::Renderer renderer;
};
// Throws render::ContextError when no context can be had.
Stage make_stage(render::ContextKind kind, PictureSize size, render::Quality quality);

// A group of robots on a stage: where they stand, how they look, and who holds the camera. Refers to the stage.
class Studio {
 public:
  // Throws InputError for a setting that does not suit the robots or their environment.
  Studio(Stage& stage, Simulation simulation, const ViewSettings& settings);

  const Simulation& simulation() const { return simulation_; }
  // See film().
  FilmResult film(FrameWriter& writer, render::PixelFormat pixels, const FilmTiming& timing, bool quiet);

 private:
  Stage& stage_;
  Simulation simulation_;
  GroupScene scene_;
  Cameraman camera_;
  DetailObserver details_;
  std::unique_ptr<PositionBridge> bridge_;
};

}  // namespace mercury
