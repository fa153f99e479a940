// SPDX-License-Identifier: Apache-2.0
// Pictures and films. mercurysim/pictures.py wraps what is here.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/recording/trajectory_playback.h"
#include "app/scene/hero_style.h"
#include "app/scene/view_words.h"
#include "app/video/film.h"
#include "mercury/error.h"
#include "mercury/names.h"
#include "python/src/arguments.h"
#include "python/src/array.h"
#include "python/src/batch.h"
#include "python/src/bindings.h"
#include "python/src/result.h"
#include "python/src/values.h"
#include "render/png.h"

namespace mercury::python {
namespace {

// The thread that draws for this process, from the first picture to the interpreter's exit.
// Used with the GIL; who draws keeps a copy.
std::shared_ptr<DrawingThread>& drawing_thread() {
  // Never destroyed: end_drawing() does what is necessary while the interpreter still works.
  static auto* thread = new std::shared_ptr<DrawingThread>(std::make_shared<DrawingThread>());
  return *thread;
}

std::shared_ptr<DrawingThread> drawing() {
  if (!drawing_thread()) throw DeviceError("the interpreter exits; nothing is drawn any more");
  return drawing_thread();
}

// Videos that threads make. They end before the interpreter does, since they ask it for Ctrl-C.
class RunningVideos {
 public:
  void begin() { ++running_; }
  void end() {
    --running_;
    running_.notify_all();
  }
  bool stopping() const { return stopping_; }
  void stop() {
    stopping_ = true;
    for (int running = running_; running > 0; running = running_) running_.wait(running);
  }

 private:
  std::atomic<bool> stopping_ = false;
  std::atomic<int> running_ = 0;
};
RunningVideos running_videos;

void stop_videos() {
  const ReleasedGil released;
  running_videos.stop();
}

void end_drawing() {
  std::shared_ptr<DrawingThread> thread = std::move(drawing_thread());
  const ReleasedGil released;
  running_videos.stop();
  if (thread) thread->end();
}

// Errors of the encoder and of OpenGL are those of the machine.
template <class Work>
auto with_errors(const Work& work) {
  try {
    return work();
  } catch (const VideoError& error) {
    throw DeviceError(error.what());
  } catch (const render::ContextError& error) {
    throw DeviceError(error.what());
  }
}

// The words of a picture, as keyword arguments of Python. None = the usual.
struct Look {
  ViewWords words;
  std::string quality = "auto";
  bool hero = false;   // of a picture
  float aperture = 0;  // of a picture
};

float small_number_from(const std::string& name, nb::handle value) {
  return static_cast<float>(number_from(name, value));
}

// The two elements of a sequence, each taken by `element`.
template <class Element>
auto pair_from(const std::string& name, nb::handle value, const char* wanted, const Element& element) {
  if (!PySequence_Check(value.ptr()) || nb::isinstance<nb::str>(value) || nb::len(value) != 2)
    refuse_type(name, wanted, value);
  return std::pair(element(name, value[0]), element(name, value[1]));
}

int side_from(const std::string& name, nb::handle value) {
  return static_cast<int>(whole_from(name, value, 1, 1 << 20));
}

PictureSize size_from(nb::handle value) {
  const auto [width, height] = pair_from("size", value, "a pair of whole numbers (width, height)", side_from);
  return {width, height};
}

bool is_hero(const std::string& style) {
  if (style != "usual" && style != "hero")
    throw ParameterError("style", "\"" + style + "\" is not accepted; give usual or hero");
  return style == "hero";
}

float aperture_from(const std::string& name, nb::handle value) {
  const float aperture = small_number_from(name, value);
  if (!(aperture >= 0 && aperture <= 1)) throw ParameterError(name, "give 0 to 1");
  return aperture;
}

void take_word(Look& look, const std::string& name, nb::handle value) {
  ViewWords& words = look.words;
  const std::map<std::string, std::function<void()>> takes{
      {"color", [&] { words.color = text_from(name, value); }},
      {"scale", [&] { words.scale = pair_from(name, value, "a pair of numbers", small_number_from); }},
      {"colormap", [&] { words.colormap = text_from(name, value); }},
      {"log_scale", [&] { words.log_scale = bool_from(name, value); }},
      {"show", [&] { words.show = text_from(name, value); }},
      {"camera", [&] { words.camera = text_from(name, value); }},
      {"azimuth", [&] { words.azimuth = small_number_from(name, value); }},
      {"elevation", [&] { words.elevation = small_number_from(name, value); }},
      {"zoom", [&] { words.zoom = small_number_from(name, value); }},
      {"layout", [&] { words.layout = text_from(name, value); }},
      {"grid",
       [&] {
         const auto [columns, rows] = pair_from(name, value, "a pair of whole numbers (columns, rows)", side_from);
         words.grid = Grid{columns, rows};
       }},
      {"theme", [&] { words.theme = text_from(name, value); }},
      {"arrow_length", [&] { words.arrow_length = small_number_from(name, value); }},
      {"arrow_density", [&] { words.arrow_density = small_number_from(name, value); }},
      {"arrow_threshold", [&] { words.arrow_threshold = small_number_from(name, value); }},
      {"caption", [&] { words.caption = text_from(name, value); }},
      {"plain", [&] { words.plain = bool_from(name, value); }},
      {"cut", [&] { words.cut = text_from(name, value); }},
      {"smooth", [&] { words.smooth = bool_from(name, value); }},
      {"faceted", [&] { words.faceted = bool_from(name, value); }},
      {"footprints", [&] { words.footprints = bool_from(name, value); }},
      {"style", [&] { look.hero = is_hero(text_from(name, value)); }},
      {"aperture", [&] { look.aperture = aperture_from(name, value); }},
      {"quality", [&] { look.quality = text_from(name, value); }}};
  if (const auto found = takes.find(name); found != takes.end()) return found->second();
  std::vector<std::string> names;
  for (const auto& [known, take] : takes) names.push_back(known);
  throw nb::type_error(("\"" + name + "\" is not an option of pictures" + suggestion(name, names)).c_str());
}

Look look_of(const nb::dict& given) {
  Look look;
  for (const auto& [key, value] : given)
    if (!value.is_none()) take_word(look, nb::cast<std::string>(key), value);
  return look;
}

render::Quality quality_of(const std::string& name) {
  try {
    return render::quality_named(name);
  } catch (const std::invalid_argument&) {
    throw ParameterError("quality", "\"" + name + "\" is not accepted; give auto, low, medium, high");
  }
}

PictureOptions picture_options(nb::handle size, const nb::dict& given) {
  const Look look = look_of(given);
  PictureOptions options{
      .size = size_from(size), .view = view_settings(look.words), .quality = quality_of(look.quality)};
  options.view.hero = look.hero;
  options.view.aperture = look.aperture;
  if (look.hero && options.quality == render::Quality::automatic) options.quality = render::Quality::medium;
  return options;
}

FilmOptions film_options(nb::handle size, double fps, double speed, int crf, const std::string& ffmpeg,
                         const nb::dict& given) {
  const PictureOptions picture = picture_options(size, given);
  if (picture.view.hero) throw ParameterError("style", "hero is of picture()");
  if (picture.view.aperture > 0) throw ParameterError("aperture", "is of picture()");
  return {.size = picture.size,
          .view = picture.view,
          .quality = picture.quality,
          .frames_per_second = fps,
          .speed = speed,
          .crf = crf == -1 ? std::nullopt : std::optional(crf),
          .ffmpeg = ffmpeg};
}

// Robots at rest.
Simulation resting(const SharedRobots& robots, const Environment& environment) {
  return {Configuration{.environment = environment, .device = {.kind = DeviceKind::cpu}}, robots};
}

// One robot of a batch, as it is now.
Simulation alone(const Simulation& simulation, std::size_t robot, std::shared_ptr<const Robot> shape) {
  Configuration configuration = simulation.configuration();
  configuration.device = {.kind = DeviceKind::cpu, .threads = 1};
  Simulation one(configuration, SharedRobots{std::move(shape)});
  one.set_clock({.dt = configuration.dt, .base_time = simulation.time()});
  one.set_state(0, simulation.state(robot));
  return one;
}

// The picture of a simulation, whose robots stand as the style wants it.
render::Image styled_picture(DrawingThread& thread, const Simulation& simulation, PictureOptions options) {
  if (options.view.hero) set_hero_style(options.view, simulation.configuration().environment);
  return picture_of(thread, simulation, options);
}

// `robot` of a batch; nothing = all.
render::Image picture(nb::handle what, nb::handle environment, const PictureOptions& options,
                      std::optional<std::int64_t> robot = {}) {
  const std::shared_ptr<DrawingThread> thread = drawing();
  return with_errors([&] {
    if (nb::isinstance<Batch>(what)) {
      if (!environment.is_none()) throw ParameterError("environment", "a batch has one already");
      const Batch& batch = nb::cast<const Batch&>(what);
      if (!robot)
        return batch.use([&](const Simulation& simulation) { return styled_picture(*thread, simulation, options); });
      const SharedRobots robots = batch.robots();
      const std::size_t index = checked_index(*robot, robots.size());
      const Simulation one =
          batch.use([&](const Simulation& simulation) { return alone(simulation, index, robots[index]); });
      const ReleasedGil released;
      return styled_picture(*thread, one, options);
    }
    if (robot) throw ParameterError("robot", "goes with a batch; give one robot instead");
    SharedRobots robots = robots_of(what);
    if (robots.empty()) throw InputError("there is no robot to show");
    const Environment surroundings = environment_of(environment);
    const ReleasedGil released;
    if (options.view.hero) add_siblings(robots, surroundings);
    return styled_picture(*thread, resting(robots, surroundings), options);
  });
}

nb::object array_of(render::Image image) {
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  const std::size_t channels = image.format == render::PixelFormat::rgba ? 4 : 3;
  return owned_array(std::move(image.bytes), {height, width, channels});
}

// A PNG for notebooks; None where there is no OpenGL, so that they show the text instead.
nb::object png_of(nb::handle what, const PictureOptions& options) {
  try {
    const std::vector<std::uint8_t> png = render::png_bytes(picture(what, nb::none(), options));
    return nb::bytes(png.data(), png.size());
  } catch (const DeviceError&) {
    return nb::none();
  }
}

nb::object png_of_robot(nb::handle_t<SharedRobot> robot) {
  PictureOptions options{.size = {400, 300}, .view = {.theme = render::Theme::light, .plain = true}};
  options.view.shown.clock = false;
  options.view.camera.zoom = 1.15f;  // it needs no room to move
  return png_of(robot, options);
}

nb::object png_of_batch(nb::handle_t<Batch> batch) {
  constexpr std::size_t most_robots = 256;  // more take seconds without a GPU
  const std::size_t robots = nb::cast<const Batch&>(batch).robots().size();
  if (robots == 0 || robots > most_robots) return nb::none();
  return png_of(batch, {.size = robots <= 6 ? PictureSize{640, 360} : PictureSize{960, 540}});
}

// Asks Python for Ctrl-C, on a thread without the interpreter's lock.
class InterruptWatch {
 public:
  explicit InterruptWatch(std::optional<nb::python_error>& interrupted) : interrupted_(interrupted) {
    running_videos.begin();
  }
  ~InterruptWatch() { running_videos.end(); }
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  bool go_on() {
    if (running_videos.stopping()) return false;
    const nb::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() != 0) interrupted_.emplace();
    return !interrupted_;
  }

 private:
  std::optional<nb::python_error>& interrupted_;
};

// Something that is filmed: robots, a recording, or results of evaluate().
struct Filmed {
  FilmedGroup group;
  std::optional<double> seconds = {};  // of its own
};

// Reads the file again: the Recording may be in use by another thread.
Filmed filmed_recording(const TrajectoryReader& given, const std::string& title) {
  const auto recording = std::make_shared<TrajectoryReader>(given.path());
  if (recording->frames() == 0) throw InputError(given.path().string(), "holds no frames");
  const auto share = std::make_shared<float>();
  return {{playback(recording, share), {}, title, share},
          recording->time(recording->frames() - 1) - recording->time(0)};
}

Filmed filmed(nb::handle what, const std::string& title, const Configuration& configuration) {
  if (nb::isinstance<TrajectoryReader>(what)) return filmed_recording(nb::cast<const TrajectoryReader&>(what), title);
  if (const std::vector<const Result*> results = results_of(what); !results.empty()) {
    const ReleasedGil released;
    Repetition again = repetition_of(results);
    return {{std::move(again.simulation), {}, title}, again.seconds};
  }
  const SharedRobots robots = robots_of(what);
  if (robots.empty()) throw InputError("there is no robot to film");
  const ReleasedGil released;
  return {{Simulation(configuration, robots), {}, title}};
}

// `sides`: pairs of a title and what is filmed. Returns the number of frames.
std::int64_t render(const nb::list& sides, const std::string& output, std::optional<double> seconds,
                    nb::handle environment, const std::string& solver, double dt, double damping, nb::handle device,
                    int threads, nb::handle size, double fps, double speed, int crf, const std::string& ffmpeg,
                    const nb::dict& look) {
  constexpr double usual_seconds = 10;
  const FilmOptions options = film_options(size, fps, speed, crf, ffmpeg, look);
  const Configuration configuration = configuration_of(environment, solver, dt, damping, device, threads);
  std::vector<FilmedGroup> groups;
  std::optional<double> longest;
  bool simulated = false;
  for (const nb::handle side : sides) {
    Filmed one = filmed(side[1], nb::cast<std::string>(side[0]), configuration);
    simulated |= !one.seconds;
    if (one.seconds) longest = std::max(longest.value_or(0), *one.seconds);
    groups.push_back(std::move(one.group));
  }
  if (!simulated && !environment.is_none())
    throw ParameterError("environment", "recordings and results have their own");
  const std::shared_ptr<DrawingThread> thread = drawing();
  VideoResult result;
  std::optional<nb::python_error> interrupted;
  {
    const ReleasedGil released;
    InterruptWatch watch(interrupted);
    result = with_errors([&] {
      return film_of(*thread, std::move(groups), output, options, seconds.value_or(longest.value_or(usual_seconds)),
                     [&] { return watch.go_on(); });
    });
  }
  if (interrupted) throw nb::python_error(std::move(*interrupted));
  if (result.interrupted) throw DeviceError("the interpreter exits; nothing is drawn any more");
  return result.frames;
}

// A film of a batch, as Python has it.
class BatchFilm {
 public:
  BatchFilm(const std::string& output, Batch& batch, nb::handle size, double fps, int crf, const std::string& ffmpeg,
            const nb::dict& look)
      : thread_(drawing()), batch_(batch) {
    const FilmOptions options = film_options(size, fps, 1, crf, ffmpeg, look);
    with_errors([&] {
      batch.use([&](const Simulation& simulation) { film_.emplace(*thread_, simulation, output, options); });
    });
  }
  ~BatchFilm() {
    const ReleasedGil released;
    film_.reset();
  }

  void add_frame() {
    with_errors([&] { batch_.use([&](const Simulation&) { film_->add_frame(); }); });
  }
  // Steps the batch, and adds the frames on the way at exactly the film's rate. Steps that the batch makes by itself
  // begin again.
  void step(std::int64_t steps) {
    do {
      const std::int64_t wait = with_errors([&] {
        return batch_.use([&](const Simulation& simulation) {
          if (stepped_to_ != simulation.steps()) film_->begin_frames();
          stepped_to_ = simulation.steps();
          return film_->next_step() - simulation.steps();
        });
      });
      const std::int64_t count = std::min(steps, wait);
      batch_.step(count, nb::none());
      with_errors([&] {
        batch_.use([&](const Simulation& simulation) {
          stepped_to_ = simulation.steps();
          film_->observe();
        });
      });
      steps -= count;
    } while (steps > 0);
  }
  void finish() {
    with_errors([&] { batch_.use([&](const Simulation&) { film_->finish(); }); });
  }
  void discard() {
    batch_.use([&](const Simulation&) { film_->discard(); });
  }
  std::int64_t frames() const { return film_->frames(); }
  double frames_per_second() const { return film_->frames_per_second(); }
  std::pair<int, int> size() const { return {film_->size().width, film_->size().height}; }

 private:
  const std::shared_ptr<DrawingThread> thread_;
  Batch& batch_;  // kept by Python
  std::optional<std::int64_t> stepped_to_;
  std::optional<Film> film_;
};

template <class Draw>
void add_png(nb::handle type, Draw draw, const char* doc) {
  nb::setattr(type, "_repr_png_",
              nb::cpp_function(draw, nb::name("_repr_png_"), nb::scope(type), nb::is_method(), doc));
}

}  // namespace

void bind_pictures(nb::module_& module) {
  module.def(
      "_picture",
      [](nb::handle what, nb::handle size, nb::handle environment, std::optional<std::int64_t> robot,
         const nb::dict& look) { return array_of(picture(what, environment, picture_options(size, look), robot)); },
      nb::arg("what"), nb::arg("size"), nb::arg("environment").none(), nb::arg("robot").none(), nb::arg("look"));
  module.def("_render", &render, nb::arg("sides"), nb::arg("output"), nb::arg("seconds").none(),
             nb::arg("environment").none(), nb::arg("solver"), nb::arg("dt"), nb::arg("damping"),
             nb::arg("device").none(), nb::arg("threads"), nb::arg("size"), nb::arg("fps"), nb::arg("speed"),
             nb::arg("crf"), nb::arg("ffmpeg"), nb::arg("look"));
  module.def("_stop_videos", &stop_videos);
  module.def("_end_drawing", &end_drawing);
  nb::class_<BatchFilm>(module, "_Film")
      .def(nb::init<const std::string&, Batch&, nb::handle, double, int, const std::string&, const nb::dict&>(),
           nb::arg("output"), nb::arg("batch"), nb::arg("size"), nb::arg("fps"), nb::arg("crf"), nb::arg("ffmpeg"),
           nb::arg("look"), nb::keep_alive<1, 3>())
      .def("add_frame", &BatchFilm::add_frame)
      .def(
          "step", [](BatchFilm& self, nb::handle n) { self.step(whole_from("n", n, 0)); }, nb::arg("n"))
      .def("finish", &BatchFilm::finish)
      .def("discard", &BatchFilm::discard)
      .def_prop_ro("frames", &BatchFilm::frames)
      .def_prop_ro("fps", &BatchFilm::frames_per_second)
      .def_prop_ro("size", &BatchFilm::size);
  add_png(nb::type<SharedRobot>(), &png_of_robot, "A picture for notebooks, as PNG; None without OpenGL.");
  add_png(nb::type<Batch>(), &png_of_batch,
          "A picture for notebooks, as PNG; None without OpenGL, and for more than 256 robots.");
}

}  // namespace mercury::python
