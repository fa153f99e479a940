// SPDX-License-Identifier: Apache-2.0
#include "app/video/film.h"

#include <unistd.h>

#include <array>
#include <chrono>
#include <deque>
#include <mutex>
#include <utility>

#include "app/video/figure.h"
#include "app/video/frame_encoder.h"
#include "app/video/group_drawing.h"
#include "app/video/moment_sampler.h"
#include "app/video/picture_memory.h"
#include "mercury/error.h"
#include "mercury/host_memory.h"

namespace mercury {
namespace {

constexpr std::size_t waiting_snapshots = 4;  // added, not yet drawn

float aspect_of(PictureSize size) { return static_cast<float>(size.width) / static_cast<float>(size.height); }

// Waits for a task. A machine without OpenGL is a DeviceError like a machine without a GPU.
void wait_for(std::future<void>& task) {
  try {
    task.get();
  } catch (const render::ContextError& error) {
    throw DeviceError(std::string("cannot draw: ") + error.what());
  }
}

void prepare(DrawingThread::Canvas& canvas, PictureSize size, render::Quality quality) {
  render::Renderer& renderer = canvas.offscreen.renderer;
  renderer.set_quality(quality);
  if (size.width != renderer.width() || size.height != renderer.height())
    require_memory_for_pictures(size, canvas.offscreen.context->is_software(), usable_host_memory());
  try {
    renderer.resize(size.width, size.height);
  } catch (const render::ContextError& error) {
    throw ParameterError("size", error.what());
  }
}

// Reports what cannot be drawn before anything else is done.
void require_canvas(DrawingThread& thread, PictureSize size, render::Quality quality) {
  std::future<void> made = thread.post([=](DrawingThread::Canvas& canvas) { prepare(canvas, size, quality); });
  wait_for(made);
}

void show_bodies(DrawingThread::Canvas& canvas, const std::shared_ptr<GroupDrawing>& drawing) {
  if (canvas.owner == drawing) return;
  drawing->set_bodies(canvas.offscreen.renderer);
  canvas.owner = drawing;
}

// Its context is gone, so its destructor must not call OpenGL.
void leave_to_the_driver(render::Readback readback) {
  static std::mutex mutex;
  static auto& left = *new std::deque<render::Readback>;  // never destroyed
  const std::lock_guard lock(mutex);
  left.push_back(std::move(readback));
}

VideoSettings video_settings(const std::string& output, const FilmOptions& options, const Simulation& simulation) {
  const VideoKind kind = video_kind_of(output);
  require_drawable(options.size);
  std::optional<render::PixelFormat> pixels;
  if (options.view.background) pixels = figure_pixels(kind, *options.view.background);
  return {.size = encoded_size(kind, options.size),
          .frames_per_second = options.frames_per_second == 0 ? usual_frame_rate(kind) : options.frames_per_second,
          .crf = options.crf,
          .comment = simulation.size() == 0 ? "" : comment_of(simulation.robot(0), simulation.configuration()),
          .ffmpeg = options.ffmpeg,
          .pixels = pixels};
}

}  // namespace

render::Image picture_of(DrawingThread& thread, const Simulation& simulation, const PictureOptions& options) {
  require_drawable(options.size);
  thread.require_no_fork();
  std::array<render::Image, 2> pictures;
  const std::size_t count = options.view.background ? 2 : 1;
  for (std::size_t i = 0; i < count; ++i) {
    ViewSettings view = options.view;
    if (view.background) view.flat_backdrop = figure_backdrops.at(i);
    const auto drawing = std::make_shared<GroupDrawing>(simulation, view, aspect_of(options.size));
    const auto bridge = make_host_bridge();
    FrameSnapshot snapshot = drawing->take(*bridge);
    std::future<void> drawn = thread.post([&](DrawingThread::Canvas& canvas) {
      prepare(canvas, options.size, options.quality);
      show_bodies(canvas, drawing);
      drawing->draw(snapshot, *bridge, canvas.offscreen.renderer, 0);
      pictures.at(i) = render::read(canvas.offscreen.renderer);
      canvas.owner = nullptr;  // the drawing refers to the caller's simulation
    });
    wait_for(drawn);
  }
  return options.view.background ? matted(pictures, *options.view.background) : std::move(pictures[0]);
}

namespace {

DrawingThread& usable(DrawingThread& thread) {
  thread.require_no_fork();
  return thread;
}

}  // namespace

struct Film::Parts {
  Parts(DrawingThread& drawing_thread, const Simulation& filmed, const std::string& output, const FilmOptions& given)
      : thread(usable(drawing_thread)), simulation(filmed), options(given),
        settings(video_settings(output, given, filmed)), pixels(pixel_format_of(video_kind_of(output))),
        writer(open_frame_writer(output, settings)), encoder(std::make_unique<FrameEncoder>(*writer)) {}

  const pid_t process = getpid();
  DrawingThread& thread;
  const Simulation& simulation;
  const FilmOptions options;
  const VideoSettings settings;
  const render::PixelFormat pixels;
  std::unique_ptr<FrameWriter> writer;
  std::unique_ptr<FrameEncoder> encoder;
  std::int64_t frames = 0;
  std::deque<std::future<void>> waiting;
  bool ended = false;

  std::vector<const Robot*> robots;  // of the drawing
  Environment environment;
  std::shared_ptr<GroupDrawing> drawing;
  std::unique_ptr<PositionBridge> bridge = make_host_bridge();
  std::optional<FramePlaces> places;  // of the frames since begin_frames()
  std::int64_t placed = 0;            // of them
  std::optional<MomentSampler> sampler;
  std::optional<render::Readback> readback;  // used on the drawing thread only

  // Another drawing when the robots or the environment are others.
  void follow_simulation() {
    const Environment& now = simulation.configuration().environment;
    std::vector<const Robot*> present;
    for (std::size_t i = 0; i < simulation.size(); ++i) present.push_back(&simulation.robot(i));
    if (drawing && present == robots && now == environment) return;
    drawing = std::make_shared<GroupDrawing>(simulation, options.view, aspect_of(settings.size));
    sampler.emplace(simulation, *drawing, *bridge, false);
    robots = std::move(present);
    environment = now;
  }

  void add_frame() {
    encoder->rethrow();
    follow_simulation();
    add(drawing->take(*bridge));
  }

  void begin_frames() {
    const double dt = simulation.configuration().dt;
    require_frame_rate("fps", settings.frames_per_second, dt);
    places.emplace(simulation.steps(), settings.frames_per_second, dt);
    placed = 0;
  }

  std::int64_t next_step() {
    follow_simulation();
    return sampler->next_step(places->of(placed)).value();
  }

  void observe() {
    encoder->rethrow();
    if (simulation.steps() != next_step()) return;
    const FramePlace place = places->of(placed);
    sampler->observe(place);
    if (sampler->next_step(place)) return;
    ++placed;
    add(sampler->moment(place));
    // The later step of this frame may be the earlier one of the next.
    if (next_step() == simulation.steps()) sampler->observe(places->of(placed));
  }

  void add(FrameSnapshot taken) {
    while (waiting.size() >= waiting_snapshots) take_oldest();
    const auto snapshot = std::make_shared<FrameSnapshot>(std::move(taken));
    waiting.push_back(thread.post([this, snapshot, shown = drawing](DrawingThread::Canvas& canvas) {
      prepare(canvas, settings.size, options.quality);
      show_bodies(canvas, shown);
      shown->draw(*snapshot, *bridge, canvas.offscreen.renderer, 1 / settings.frames_per_second);
      if (!readback) readback.emplace(pixels, settings.size.width, settings.size.height);
      if (!readback->full() || encoder->take(*readback)) readback->start(canvas.offscreen.renderer);
    }));
    ++frames;
  }

  void take_oldest() {
    std::future<void> oldest = std::move(waiting.front());
    waiting.pop_front();
    wait_for(oldest);
  }

  void finish() {
    while (!waiting.empty()) take_oldest();
    if (frames == 0) throw VideoError("the film has no frames; nothing was kept");
    std::future<void> passed_on = thread.post([this](DrawingThread::Canvas&) {
      while (readback->pending() > 0 && encoder->take(*readback)) {
      }
    });
    wait_for(passed_on);
    encoder->finish();
    writer->finish();
  }

  // Gives back what belongs to the drawing thread, and removes the file unless it is finished.
  void end() {
    ended = true;
    writer->abandon();
    encoder->abandon();
    for (std::future<void>& task : waiting) task.wait();
    waiting.clear();
    try {
      thread
          .post([this](DrawingThread::Canvas& canvas) {
            if (canvas.owner == drawing) canvas.owner = nullptr;
            readback.reset();
            drawing.reset();
          })
          .wait();
    } catch (const DeviceError&) {
      if (readback) leave_to_the_driver(std::move(*readback));
      readback.reset();
    }
    encoder.reset();
    writer.reset();
  }

  void require_usable() const {
    if (process != getpid()) throw DeviceError("a film goes on only in the process that began it");
    if (ended) throw InputError("the film has ended; begin another one");
  }
};

Film::Film(DrawingThread& thread, const Simulation& simulation, const std::string& output, const FilmOptions& options)
    : parts_(std::make_unique<Parts>(thread, simulation, output, options)) {
  Parts& parts = *parts_;
  if (options.view.background)
    throw ParameterError("background", "is of pictures, and of films of robots and recordings; leave it out");
  parts.follow_simulation();
  require_canvas(thread, parts.settings.size, options.quality);
}

Film::~Film() {
  if (parts_->process != getpid())
    (void)parts_.release();  // the encoder, the file and the threads are those of the parent
  else
    discard();
}

void Film::add_frame() {
  parts_->require_usable();
  parts_->add_frame();
}

void Film::begin_frames() {
  parts_->require_usable();
  parts_->begin_frames();
}

std::int64_t Film::next_step() {
  parts_->require_usable();
  return parts_->next_step();
}

void Film::observe() {
  parts_->require_usable();
  parts_->observe();
}

void Film::finish() {
  parts_->require_usable();
  try {
    parts_->finish();
  } catch (...) {
    parts_->end();
    throw;
  }
  parts_->end();
}

void Film::discard() {
  if (!parts_->ended && parts_->process == getpid()) parts_->end();
}

std::int64_t Film::frames() const { return parts_->frames; }
double Film::frames_per_second() const { return parts_->settings.frames_per_second; }
PictureSize Film::size() const { return parts_->settings.size; }

VideoResult film_of(DrawingThread& thread, Simulation simulation, const std::string& output, const FilmOptions& options,
                    double seconds, const std::function<bool()>& go_on) {
  std::vector<FilmedGroup> groups;
  groups.push_back({std::move(simulation)});
  return film_of(thread, std::move(groups), output, options, seconds, go_on);
}

VideoResult film_of(DrawingThread& thread, std::vector<FilmedGroup> groups, const std::string& output,
                    const FilmOptions& options, double seconds, const std::function<bool()>& go_on) {
  constexpr std::chrono::milliseconds between_questions(50);
  VideoSettings settings = video_settings(output, options, groups.front().simulation);
  const VideoTiming timing = video_timing(seconds, options.speed, settings.frames_per_second);
  settings.expected_frames = timing.frames;
  const std::unique_ptr<FrameWriter> writer = open_frame_writer(output, settings);
  ViewSettings view = options.view;
  view.speed = options.speed;
  VideoControl control;
  VideoResult result;
  std::future<void> made = thread.post([&](DrawingThread::Canvas& canvas) {
    prepare(canvas, settings.size, options.quality);
    canvas.owner = nullptr;
    VideoPipeline pipeline(canvas.offscreen, std::move(groups), view);
    result = pipeline.run(*writer, settings.pixels ? render::PixelFormat::rgb : pixel_format_of(video_kind_of(output)),
                          timing, true, &control);
  });
  while (go_on && made.wait_for(between_questions) != std::future_status::ready)
    if (!control.stop && !go_on()) {
      control.stop = true;
      writer->abandon();
    }
  try {
    wait_for(made);
  } catch (const VideoError&) {
    if (!control.stop) throw;
    result.interrupted = true;
  }
  if (!result.interrupted) writer->finish();
  return result;
}

}  // namespace mercury
