// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewer.h"

#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/interrupt.h"
#include "app/live/live_scene.h"
#include "app/live/session_settings.h"
#include "app/scene/cameraman.h"
#include "app/window/frame_report.h"
#include "app/window/panels/panels.h"
#include "app/window/toolkit/imgui_layer.h"
#include "app/window/toolkit/screenshot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/viewport/mouse_controller.h"
#include "app/window/viewport/viewport_text.h"

namespace mercury::window {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double frame_time = 1.0 / 60;  // at least, where the display sets no pace [s]
constexpr double idle_time = 0.2;        // between looks at what goes on while nothing moves [s]
constexpr double unseen_share =
    4;  // of the time without a picture to that of drawing one, while it catches up with the user

double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

Preferences remembered(const ViewerOptions& options, const std::filesystem::path& folder) {
  Preferences preferences;
  if (options.remember && !folder.empty()) load(preferences, folder / "window.json");
  if (options.size.width > 0) preferences.size = options.size;
  if (options.quality != render::Quality::automatic) preferences.quality = options.quality;
  return preferences;
}

Tone tone_of(Severity severity) {
  switch (severity) {
    case Severity::warning:
      return Tone::warning;
    case Severity::error:
      return Tone::error;
    default:
      return Tone::info;
  }
}

class Viewer {
 public:
  explicit Viewer(ViewerOptions options);
  ~Viewer();
  int run();

 private:
  void remember();
  void fill_scene();
  void frame(double dt);
  void listen(const std::vector<InputEvent>& events);
  void draw_picture(const ViewportArea& area, double dt);
  void finish_picture();
  void take_screenshot();
  bool anything_moves() const;
  std::filesystem::path settings(const char* name) const { return folder_.empty() ? folder_ : folder_ / name; }

  FrameReport report_;  // first: it measures how long opening takes
  ViewerOptions options_;
  std::filesystem::path folder_;  // of settings; empty = nothing is remembered
  Preferences preferences_;
  EventLog log_;
  Window window_;
  ImGuiLayer imgui_;
  Viewport viewport_;
  LiveScene scene_;
  OrbitController camera_;
  Toasts toasts_;
  Dialogs dialogs_;
  PanelContext context_{scene_, camera_, preferences_, log_, toasts_, dialogs_};
  Panels panels_;
  MouseController mouse_{scene_, camera_, log_, toasts_};
  Screenshot screenshot_;

  std::uint64_t bodies_ = 0;  // revision that the renderer has
  bool turned_ = false;       // the camera moved in the last picture
  bool framed_ = false;       // the camera has found its first robots
  int redraw_ = 3;            // pictures to be drawn though nothing in them moves
  std::int64_t shown_steps_ = -1;
  double shown_time_ = -1;  // of the robots in the picture [s]
  render::Camera shown_;    // the picture was drawn with
  ViewportArea area_{{0, 0}, {16, 9}};
  FrameTimes cost_;
  Clock::time_point seen_;  // the last picture
  double seeing_ = 0;       // time that it took [s]
};

Viewer::Viewer(ViewerOptions options)
    : options_(std::move(options)), folder_(options_.remember ? settings_folder() : std::filesystem::path()),
      preferences_(remembered(options_, folder_)),
      log_(options_.report.empty() ? EventLog() : EventLog(options_.report)), window_("Mercury", preferences_.size),
      imgui_(window_, settings("window.ini")), viewport_(window_.gl_context(), preferences_.quality),
      scene_({.configuration = options_.configuration, .view = options_.view}), panels_(context_, window_, viewport_) {
  remember();
  fill_scene();
}

Viewer::~Viewer() {
  if (folder_.empty()) return;
  Messages untold;
  ViewSettings view = scene_.view();
  view.camera = {.mode = camera_.mode()};  // all else is of this scene
  save_session_settings(session_settings_path(),
                        {.view = view,
                         .generation = panels_.generation(),
                         .pause_on_explosion = preferences_.pause_on_explosion,
                         .folder = preferences_.folder},
                        untold);
  if (const WindowSize size = window_.size(); size.width > 0) preferences_.size = size;
  save(preferences_, settings("window.json"));
}

// Settings of the last window, where the command line gives none.
void Viewer::remember() {
  if (folder_.empty()) return;
  Messages messages;
  const SessionSettings last = load_session_settings(session_settings_path(), messages);
  for (const Message& message : messages.take()) toasts_.show(tone_of(message.severity), message.text);
  if (options_of(options_.view).empty()) scene_.set_view(last.view);
  std::error_code unknown;
  if (std::filesystem::exists(session_settings_path(), unknown)) panels_.generation() = last.generation;
  preferences_.pause_on_explosion = last.pause_on_explosion;
}

void Viewer::fill_scene() {
  if (!options_.robots.empty()) scene_.add(std::move(options_.robots), false);
  if (!options_.files.empty()) scene_.open(options_.files);
  for (const RandomRobots& generation : options_.generations) scene_.generate(generation);
  for (const std::string& line : options_.notes) toasts_.show(Tone::info, line);
  if (options_.playing) scene_.play();
}

int Viewer::run() {
  auto last = Clock::now();
  while (!interrupted() && !panels_.quits()) {
    if (window_.close_requested()) {
      window_.cancel_close();
      panels_.quit();
    }
    const double spent = since(last);
    window_.poll(window_.input().has_backlog() ? 0 : anything_moves() ? std::max(0.0, frame_time - spent) : idle_time);
    const double dt = since(last);
    last = Clock::now();
    if (window_.take_activity()) redraw_ = std::max(redraw_, 3);
    frame(std::min(dt, 0.5));
  }
  return 0;
}

bool Viewer::anything_moves() const {
  return redraw_ > 0 || turned_ || scene_.playing() || camera_.gliding() || camera_.mode() == CameraMode::turntable ||
         !toasts_.empty() || panels_.busy() || panels_.film().busy() || screenshot_.busy() || !scene_.work().empty() ||
         mouse_.busy() || viewport_.coarse();
}

void Viewer::listen(const std::vector<InputEvent>& events) {
  if (const auto files = window_.take_dropped_files(); !files.empty()) {
    scene_.open(files);
    log_.write("dropped", {{"files", files.size()}});
  }
  const bool typing = ImGui::GetIO().WantTextInput;
  for (const KeyPress& press : key_presses_in(events)) {
    const std::optional<Command> command = command_of(press);
    if (dialogs_.open()) {
      if (command && command->action == Action::deselect)
        panels_.execute(*command);
      else
        dialogs_.press(press);
      continue;
    }
    if (!command) continue;
    if (typing &&
        (!press.control || command->action == Action::undo || command->action == Action::redo ||
         command->action == Action::select_all) &&
        command->action != Action::help)
      continue;
    panels_.execute(*command);
  }
}

void Viewer::frame(double dt) {
  const std::vector<InputEvent> events = window_.input().take();
  listen(events);
  const auto begin = Clock::now();
  scene_.frame(area_.aspect());
  for (const Message& message : scene_.take_messages()) toasts_.show(tone_of(message.severity), message.text);
  cost_.scene = since(begin);
  panels_.work(0.004);
  cost_.thumbnails = since(begin) - cost_.scene;
  imgui_.set_appearance(scene_.view().theme, preferences_.text_scale);
  const auto panels_begin = Clock::now();
  imgui_.begin_frame(events);
  area_ = panels_.draw_frame();
  mouse_.update(area_, shown_);
  panels_.draw_over(area_, shown_, dt);
  // The play bar has a clock of its own.
  draw_viewport_text(scene_.picture().scene(), scene_.picture().bounds(), area_, shown_, !preferences_.panels);
  mouse_.draw(area_, shown_);
  cost_.panels = since(panels_begin);
  if (window_.input().has_backlog() && since(seen_) < unseen_share * seeing_) {
    imgui_.discard_frame();
  } else {
    const auto drawing = Clock::now();
    draw_picture(area_, dt);
    finish_picture();
    seen_ = Clock::now();
    seeing_ = since(drawing);
  }
  cost_.whole = dt;
  panels_.note(cost_);
  report_.write(context_, window_, {area_, shown_, shown_time_}, cost_, dt);
}

void Viewer::draw_picture(const ViewportArea& area, double dt) {
  const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
  viewport_.place(static_cast<int>(area.low.x * scale.x), static_cast<int>(area.low.y * scale.y),
                  static_cast<int>(area.width() * scale.x), static_cast<int>(area.height() * scale.y));
  LivePicture& live = scene_.picture();
  if (preferences_.quality != render::Quality::automatic && preferences_.quality != viewport_.renderer().quality()) {
    viewport_.renderer().set_quality(preferences_.quality);
    redraw_ = 3;
  }
  if (bodies_ != live.bodies_revision()) {
    live.set_bodies(viewport_.renderer());
    bodies_ = live.bodies_revision();
    redraw_ = 3;
  }
  if (!framed_ && !live.bounds().empty()) {
    camera_.set_orbit(
        direction_of(scene_.view().camera, std::holds_alternative<Land>(scene_.configuration().environment)));
    camera_.start(live.bounds(), area.aspect());
    camera_.set_mode(scene_.view().camera.mode);
    framed_ = true;
  }
  const render::Camera camera = camera_.at(live.bounds(), area.aspect(), dt);
  // The end of a glide is too slow to be seen, and must not keep the picture coarse.
  const float least = 2e-4f * (camera.eye - camera.target).norm();
  const bool turned = (camera.eye - shown_.eye).norm() > least || (camera.target - shown_.target).norm() > least ||
                      camera.field_of_view != shown_.field_of_view;
  const bool stepped = shown_steps_ != scene_.snapshot().steps || shown_time_ != live.scene().time;
  turned_ = turned;
  const bool moving = turned || (stepped && scene_.playing()) || mouse_.busy();
  if (!moving && !stepped && redraw_ == 0 && !viewport_.coarse()) return;
  const auto begin = Clock::now();
  viewport_.draw(without_text(live.scene()), camera, moving);
  cost_.picture = since(begin);
  shown_ = camera;
  shown_steps_ = scene_.snapshot().steps;
  shown_time_ = live.scene().time;
  redraw_ = std::max(0, redraw_ - 1);
}

void Viewer::finish_picture() {
  const WindowSize pixels = window_.pixels();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, pixels.width, pixels.height);
  glClearColor(0.08f, 0.10f, 0.13f, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  if (pixels.width > 0 && pixels.height > 0) viewport_.present(pixels.height);
  imgui_.end_frame();
  panels_.film().frame(context_, pixels);
  if (panels_.take_screenshot_request()) take_screenshot();
  std::filesystem::path path;
  std::string error;
  if (screenshot_.done(path, error)) {
    if (error.empty())
      toasts_.show(Tone::success, "picture saved: " + path.string());
    else
      toasts_.show(Tone::error, error);
    log_.write("screenshot", {{"file", path.string()}});
  }
  window_.swap_buffers();
}

void Viewer::take_screenshot() {
  screenshot_.take(read_window(window_.pixels()), unused_path(picture_folder(context_), ".png"));
}

}  // namespace

int run_viewer(ViewerOptions options) { return Viewer(std::move(options)).run(); }

}  // namespace mercury::window
