// SPDX-License-Identifier: Apache-2.0
// Pictures and films of simulations, for programs.
//
//     DrawingThread thread;
//     const render::Image picture = picture_of(thread, simulation, {.size = {1280, 720}});
//     Film film(thread, simulation, "swim.mp4", {.view = view_settings({.color = "strain"})});
//     for (int i = 0; i < 300; ++i, simulation.step(33)) film.add_frame();
//     film.finish();
//
// Or with frames at exactly the film's rate, of which most lie between two steps of 1 ms:
//
//     for (film.begin_frames(); simulation.steps() < 10000; film.observe())
//       simulation.step(std::min<std::int64_t>(film.next_step(), 10000) - simulation.steps());
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/view_settings.h"
#include "app/video/drawing_thread.h"
#include "app/video/frame_writer.h"
#include "app/video/video_pipeline.h"
#include "mercury/simulation.h"
#include "render/readback.h"
#include "render/renderer.h"

namespace mercury {

struct PictureOptions {
  PictureSize size;
  ViewSettings view;
  render::Quality quality = render::Quality::automatic;
};

// The simulation's current state as a picture of 3 bytes per pixel, or 4 over a transparent background, upper row
// first. The same state and options give the same bytes. Throws InputError for options that cannot be used,
// ParameterError("size", ...) for a size that cannot be drawn, DeviceError if there is no OpenGL.
render::Image picture_of(DrawingThread& thread, const Simulation& simulation, const PictureOptions& options = {});

struct FilmOptions {
  PictureSize size;
  ViewSettings view;
  render::Quality quality = render::Quality::automatic;
  double frames_per_second = 0;  // 0 = usual_frame_rate()
  double speed = 1;              // film_of(): simulated seconds per second of film
  std::optional<int> crf;        // see VideoSettings
  std::string ffmpeg;
};

// Films a simulation that the caller steps. One thread at a time may use a film. In a process that was forked meanwhile
// its members throw DeviceError, and its destructor leaves the file to the parent.
class Film {
 public:
  // `output`: see video_kind_of(). Both references must outlive the film. Throws as open_frame_writer() and
  // picture_of() do.
  Film(DrawingThread& thread, const Simulation& simulation, const std::string& output, const FilmOptions& options);
  ~Film();  // discards the film unless finish() was called
  Film(const Film&) = delete;
  Film& operator=(const Film&) = delete;

  // The simulation's current state is the next frame. Drawing and encoding go on in the background; waits while several
  // frames are behind. After robots were added or removed, the group is laid out again. Throws what an earlier frame
  // threw, InputError when the film has ended.
  void add_frame();

  // Instead of add_frame(): from the simulation's current step on, frames are frames_per_second() of simulated time
  // apart. One between two steps is interpolated and needs both. Throws ParameterError("fps", ...) for more than one
  // per step.
  void begin_frames();
  // The next step that a frame needs.
  std::int64_t next_step();
  // Adds the frame, or keeps the first of its two steps, if the simulation is at next_step(). Waits and throws as
  // add_frame() does.
  void observe();

  // Waits for all frames, and gives the film its name. Throws VideoError if there is none.
  void finish();
  // Drops everything. An existing file of that name stays as it was.
  void discard();

  std::int64_t frames() const;  // added
  double frames_per_second() const;
  PictureSize size() const;  // of a frame; even sides for .mp4 and .webm

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

// Simulates, draws and encodes a film of `seconds` of groups, from left to right (VideoPipeline); nothing else is drawn
// meanwhile. Asks `go_on` about twenty times per second, on the calling thread; after it has returned false, the film
// is discarded and the result says `interrupted`. Throws what the constructor of Film and its members throw.
VideoResult film_of(DrawingThread& thread, std::vector<FilmedGroup> groups, const std::string& output,
                    const FilmOptions& options, double seconds, const std::function<bool()>& go_on = {});
// The same of one group.
VideoResult film_of(DrawingThread& thread, Simulation simulation, const std::string& output, const FilmOptions& options,
                    double seconds, const std::function<bool()>& go_on = {});

}  // namespace mercury
