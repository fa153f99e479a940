// SPDX-License-Identifier: Apache-2.0
#include "app/window/viewer.h"

#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/base/interrupt.h"
#include "app/live/background.h"
#include "app/live/live_run.h"
#include "app/live/live_scene.h"
#include "app/live/picking.h"
#include "app/live/scene_comparison.h"
#include "app/live/scene_files.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "app/scene/camera_controller.h"
#include "app/window/frame_report.h"
#include "app/window/kept_settings.h"
#include "app/window/panels/commands.h"
#include "app/window/panels/panels.h"
#include "app/window/panels/robot_list.h"
#include "app/window/panels/video_recorder.h"
#include "app/window/toolkit/frame_times.h"
#include "app/window/toolkit/imgui_layer.h"
#include "app/window/toolkit/screenshot.h"
#include "app/window/toolkit/theme.h"
#include "app/window/viewport/marks.h"
#include "app/window/viewport/mouse_controller.h"
#include "app/window/viewport/second_view.h"
#include "app/window/viewport/viewport_text.h"

namespace mercury::window {
namespace {

using Clock = std::chrono::steady_clock;

// Between frames while nothing moves [s]. Whoever reads a report waits for frames.
constexpr double idle_time = 0.2, reported_idle_time = 0.03;
// While the first robots are prepared, their surroundings are not drawn without them, for this long [s].
constexpr double longest_blank = 0.5;
double since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

// True for key presses that a text field handles while the user types in it.
bool is_text_edit(const KeyPress& press, Action action) {
  if (action == Action::help) return false;
  return !press.control || action == Action::undo || action == Action::redo || action == Action::select_all;
}

// Of both sides.
std::uint64_t changes_of(LiveScene& scene) {
  const DrawnScene* second = scene.comparison().second_drawn();
  return scene.drawn().changes() + (second ? second->changes() : 0);
}

class Viewer {
 public:
  explicit Viewer(ViewerOptions options);
  ~Viewer();
  int run();

 private:
  void fill_scene();
  void frame(double dt);
  void handle_input(const std::vector<InputEvent>& events);
  void draw_frame(const std::vector<InputEvent>& events, double dt);
  void split_area(const ViewportArea& whole);
  void draw_text();
  void use_mouse();
  void draw_handles();
  void place_views();
  void update_renderer();
  void begin_close();
  void keep_anchor();
  std::optional<std::size_t> followed(const CameraPlan& plan) const;
  bool draw_frame(double dt);
  void present(bool draws);
  void update_screenshot();
  bool anything_moves() const;
  bool leaves_gpu_to_steps() const;

  FrameReport report_;  // first member, since it measures the time from the start
  UnsavedResults session_;
  ViewerOptions options_;
  std::filesystem::path folder_;  // of settings; empty = neither loaded nor saved
  Preferences preferences_;
  EventLog log_;
  Window window_;
  ImGuiLayer imgui_;
  Viewport viewport_;
  SecondView second_;
  LiveScene scene_;
  LiveRun run_;
  OrbitController camera_;
  Toasts toasts_;
  Dialogs dialogs_;
  VideoRecorder recorder_;
  FrameHistory frame_history_;
  Thumbnails thumbnails_{window_.gl_context()};
  KeyMap keys_;
  PanelContext context_{scene_,   run_,    camera_,   preferences_, keys_,          log_,       toasts_,
                        dialogs_, window_, viewport_, recorder_,    frame_history_, thumbnails_};
  Panels panels_{context_};
  MouseController mouse_{scene_, camera_, log_, toasts_, context_.pinned};
  LegendView legend_;
  CutHandle cut_handle_;
  TargetHandle target_handle_;
  Screenshot screenshot_;

  ViewportArea area_{{0, 0}, {16, 9}};        // of the robots, or of the first side
  ViewportArea whole_area_{{0, 0}, {16, 9}};  // of both sides
  float titles_ = 0;                          // height of the titles of two sides [pixels]
  EventLog no_log_;                           // for what the second side shows again
  std::uint64_t bodies_revision_ = 0;         // of the bodies that the renderer has
  bool camera_moved_ = false;                 // between the last two frames
  bool camera_placed_ = false;                // the camera has been placed before the first robots
  bool began_ = false;                        // what the window was started with is there
  bool expects_robots_ = false;               // it was started with some
  Clock::time_point run_begin_;
  bool begins_close_ = false;        // it shows one robot before the group
  int frames_due_ = 3;               // frames of the panels to draw even if nothing changes
  bool redraw_ = true;               // the robots, even if they rest: their area or bodies are new
  std::uint64_t shown_changes_ = 0;  // of the scene, in the last frame of the robots

  // The last frame.
  std::int64_t shown_steps_ = -1;
  double shown_time_ = -1;  // simulated time [s]
  render::Camera shown_camera_;
  struct Anchor {
    RobotId robot = 0;
    render::Vector3 cell{0, 0, 0};  // its middle [m]
  };
  std::optional<Anchor> anchor_;  // the robot that a camera which stands looks at
  std::int64_t drawn_ = 0;        // of the robots, drawn so far
  std::int64_t presented_ = 0;    // frames brought to the display so far

  Pacing pacing_;
  FrameTimes times_;  // of this frame
};

Viewer::Viewer(ViewerOptions options)
    : options_(std::move(options)), folder_(options_.remember ? settings_folder() : std::filesystem::path()),
      preferences_(kept_preferences(options_, folder_)),
      log_(options_.report.empty() ? EventLog() : EventLog(options_.report)),
      window_("Mercury", preferences_.size, options_.paced),
      imgui_(window_, folder_.empty() ? folder_ : folder_ / "window.ini"),
      viewport_(window_.gl_context(), preferences_.quality), second_(window_.gl_context()),
      scene_({.configuration = options_.configuration, .start = options_.start, .view = options_.view}),
      pacing_(options_.paced, window_.gl_context().is_software()) {
  if (ChosenBridge chosen = choose_bridge(scene_.cuda_device(), options_.interop); chosen.on_device)
    scene_.set_bridge(std::move(chosen.bridge));
  mouse_.set_actions({.click = [this](const Hit& hit) { return edit_body_at(context_, hit); },
                      .menu = [this](const Hit& hit) { open_robot_menu(context_, hit); }});
  load_session(context_, keys_, options_, folder_);
  camera_.set_mode(scene_.view().camera.mode);
  fill_scene();
}

Viewer::~Viewer() { save_session(context_, folder_); }

void Viewer::fill_scene() {
  begins_close_ = options_.welcome && options_.playing;
  expects_robots_ =
      !options_.robots.empty() || !options_.files.empty() || !options_.generations.empty() || !options_.run.empty();
  if (!options_.robots.empty()) scene_.robots().add(std::move(options_.robots), false);
  if (!options_.files.empty()) scene_.files().open(options_.files);
  for (const RandomRobots& generation : options_.generations) scene_.robots().generate(generation);
  scene_.files().hold_opened(options_.held);
  if (!options_.run.empty()) open_first_run(context_, options_.run);
  for (const std::string& line : options_.notes) toasts_.show(Tone::info, line);
  scene_.time().set_speed(options_.speed);
  if (options_.playing) scene_.time().play();
}

int Viewer::run() {
  session_.begin();
  auto last = run_begin_ = Clock::now();
  while (!interrupted() && !panels_.quit_confirmed()) {
    if (window_.close_requested()) {
      window_.cancel_close();
      panels_.quit();
    }
    const double spent = since(last);
    window_.poll(window_.input().has_backlog() ? 0
                 : anything_moves()            ? pacing_.wait(spent, leaves_gpu_to_steps())
                 : log_                        ? reported_idle_time
                                               : idle_time);
    const double dt = since(last);
    last = Clock::now();
    if (window_.take_activity()) frames_due_ = 3;
    frame(std::min(dt, 0.5));
  }
  return 0;
}

bool Viewer::anything_moves() const {
  return frames_due_ > 0 || redraw_ || camera_moved_ || scene_.time().playing() || scene_.snapshot().timeline.seeking ||
         camera_.gliding() || camera_.mode() == CameraMode::turntable || !toasts_.empty() || panels_.busy() ||
         thumbnails_.busy() || recorder_.busy() || screenshot_.busy() || !scene_.work().empty() || mouse_.busy() ||
         viewport_.coarse() || second_.coarse();
}

void Viewer::handle_input(const std::vector<InputEvent>& events) {
  if (const auto files = window_.take_dropped_files(); !files.empty()) {
    open_paths(context_, files);
    log_.write("dropped", {{"files", files.size()}});
  }
  // The text field of a dialog that has closed wants text for one more frame.
  const bool typing = ImGui::GetIO().WantTextInput && ImGui::IsAnyItemActive();
  for (const KeyPress& press : key_presses_in(events)) {
    const std::optional<Action> command = keys_.command_of(press);
    if (dialogs_.open()) {
      if (command == Action::deselect)
        panels_.execute(*command);
      else
        dialogs_.press(press);
      continue;
    }
    if (panels_.press_in_palette(press, command)) continue;
    if (!command) continue;
    if (!typing || !is_text_edit(press, *command)) panels_.execute(*command);
  }
}

void Viewer::frame(double dt) {
  const std::vector<InputEvent> events = window_.input().take();
  handle_input(events);
  const auto scene_begin = Clock::now();
  if (camera_placed_) scene_.face(camera_.from_above(), camera_.facing());
  if (drawn_ > 0) scene_.drawn().see(shown_camera_, area_.aspect());
  if (DrawnScene* second = scene_.comparison().second_drawn(); second && drawn_ > 0)
    second->see(shown_camera_, area_.aspect());
  scene_.frame(area_.aspect());
  // Whoever edits a body sees its voxels. At low quality, round skins would take as long as all else.
  const bool rounded =
      !scene_.view().faceted && context_.body_edit.robot == 0 && viewport_.renderer().quality() != render::Quality::low;
  scene_.drawn().scene().rounded = rounded;
  if (DrawnScene* second = scene_.comparison().second_drawn()) second->scene().rounded = rounded;
  run_.frame();
  if (const auto plan = scene_.files().take_camera()) {
    camera_.follow(std::nullopt);
    camera_.set_mode(plan->mode);
    camera_placed_ = false;
  }
  if (!began_ && scene_.work().empty()) {
    scene_.forget_edits();  // undo does not go back to a window without robots
    began_ = true;
  }
  show_messages(toasts_, scene_.take_messages());
  show_messages(toasts_, run_.take_messages());
  times_.scene = since(scene_begin);
  const auto work_begin = Clock::now();
  panels_.work();
  thumbnails_.work(scene_.view().theme, 0.004);
  times_.thumbnails = since(work_begin);
  draw_frame(events, dt);
  times_.whole = dt;
  frame_history_.add(times_);
  frames_due_ = std::max(0, frames_due_ - 1);
  report_.write(context_, {area_, shown_camera_, shown_time_, drawn_, presented_}, times_, dt);
}

void Viewer::draw_frame(const std::vector<InputEvent>& events, double dt) {
  imgui_.set_appearance(scene_.view().theme, preferences_.text_scale);
  imgui_.begin_frame(events);
  const bool left_out = pacing_.leaves_out_frame(window_.input().has_backlog());
  split_area(whole_area_);
  const auto mouse_begin = Clock::now();
  use_mouse();
  times_.mouse = since(mouse_begin);
  // In a steady view, the GPU draws the robots while the panels are made.
  const bool early = camera_placed_ && !redraw_ && scene_.time().playing();
  bool draws = early && !left_out && draw_frame(dt);
  const auto panels_begin = Clock::now();
  split_area(panels_.draw_frame());
  panels_.draw_over(area_, shown_camera_, dt);
  draw_text();
  draw_handles();
  mouse_.draw(scene_.mouse().points_at_second() ? *second_.area() : area_, shown_camera_,
              context_.body_edit.robot == 0);
  panels_.draw_dialogs();
  times_.panels = since(panels_begin);
  context_.gestures = mouse_.used();
  if (left_out) {
    imgui_.discard_frame();
    return;
  }
  if (!early) draws = draw_frame(dt);
  const auto waiting = Clock::now();
  viewport_.finish();
  second_.finish();
  if (draws) times_.drawn += since(waiting);
  place_views();  // the panels may have moved
  const auto presenting = Clock::now();
  present(draws);
  times_.present = since(presenting) - times_.waiting;
  pacing_.showed_frame((draws ? times_.drawn : 0) + since(presenting), draws);
}

// Two sides have a half each, and frames of the same size.
void Viewer::split_area(const ViewportArea& whole) {
  const ViewportArea before = std::exchange(whole_area_, whole);
  if (before.low.x != whole.low.x || before.low.y != whole.low.y || before.high.x != whole.high.x ||
      before.high.y != whole.high.y)
    redraw_ = true;
  area_ = second_.split(scene_, whole);
  context_.aspect = area_.aspect();
  if (second_.changed()) {
    redraw_ = true;
    scene_.drawn().lay_out(area_.aspect());
    if (DrawnScene* second = scene_.comparison().second_drawn()) second->lay_out(area_.aspect());
  }
  if (second_.area()) log_.item("second", second_.area()->low, second_.area()->high);
  keep_anchor();
}

// A drag belongs to the side on which it began.
void Viewer::use_mouse() {
  if (!second_.area())
    scene_.mouse().point_at_second(false);
  else if (!mouse_.busy())
    scene_.mouse().point_at_second(ImGui::GetIO().MousePos.x >= second_.area()->low.x);
  mouse_.update(scene_.mouse().points_at_second() ? *second_.area() : area_, shown_camera_);
}

void Viewer::draw_text() {
  ViewportTextOptions options{.clock = !preferences_.panels,  // the play bar has its own clock
                              .hovered = mouse_.hovered(),
                              .legend = legend_.box()};
  titles_ = second_.area() ? draw_side_titles(scene_, halves_of(whole_area_), log_) : 0;
  options.top = titles_;
  options.covered = context_.covered;
  if (titles_ > 0) options.covered.push_back({area_.low, {whole_area_.high.x, area_.low.y + titles_}});
  context_.caption =
      draw_viewport_text(scene_.drawn().scene(), scene_.drawn().bounds(), area_, shown_camera_, options, log_);
  if (titles_ > 0)  // they are above the caption
    context_.caption = {area_.low, {area_.high.x, std::max(context_.caption.high.y, area_.low.y + titles_)}};
  draw_ghost_figures(scene_, area_, titles_, shown_camera_, log_);
  DrawnScene* const second = scene_.comparison().second_drawn();
  if (!second || !second_.area()) return;
  options.caption = second->scene().caption != scene_.drawn().scene().caption;
  draw_viewport_text(second->scene(), second->bounds(), *second_.area(), shown_camera_, options, no_log_);
}

// What the mouse moves in the view besides robots and camera.
void Viewer::draw_handles() {
  ViewSettings view = scene_.view();
  ViewportArea place = second_.area().value_or(area_);
  // Where a side is too narrow for title and legend beside each other, the legend is below.
  if (place.width() < 30 * ImGui::GetFontSize()) place.low.y += titles_;
  bool changed = legend_.draw(scene_.drawn().scene().legend, place, view, log_);
  context_.legend = legend_.box();
  changed |= cut_handle_.draw(scene_, area_, shown_camera_, view, log_);
  target_handle_.draw(scene_, area_, shown_camera_, log_);
  if (mouse_.hovered_hit() && !scene_.mouse().points_at_second())
    draw_voxel_outline(context_, *mouse_.hovered_hit(), area_, shown_camera_);
  if (changed) scene_.set_view(view);
}

// The index of the robot that a plan names, by name or number; none = the group, or no such robot.
std::optional<std::size_t> Viewer::followed(const CameraPlan& plan) const {
  const std::vector<RobotEntry> entries = scene_.robots().entries();
  for (std::size_t i = 0; i < entries.size(); ++i)
    if (!plan.robot.empty() && (entries[i].name == plan.robot || std::to_string(i) == plan.robot)) return i;
  return std::nullopt;
}

// Puts the view of the robots into its area.
void Viewer::place_views() {
  const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
  viewport_.place(static_cast<int>(area_.low.x * scale.x), static_cast<int>(area_.low.y * scale.y),
                  static_cast<int>(area_.width() * scale.x), static_cast<int>(area_.height() * scale.y));
  second_.place(scale);
}

// Hands changed robots, quality and size to the renderer.
void Viewer::update_renderer() {
  place_views();
  DrawnScene& live = scene_.drawn();
  if (preferences_.quality != render::Quality::automatic && preferences_.quality != viewport_.renderer().quality()) {
    viewport_.renderer().set_quality(preferences_.quality);
    redraw_ = true;
  }
  if (bodies_revision_ != live.bodies_revision()) {
    live.set_bodies(viewport_.renderer());
    bodies_revision_ = live.bodies_revision();
    redraw_ = true;
  }
  if (second_.update(scene_, viewport_.renderer().quality())) redraw_ = true;
  if (!camera_placed_ && !live.bounds().empty()) {
    CameraPlan plan = scene_.view().camera;
    plan.mode = camera_.mode();  // unless the user has changed it, that of the scene
    const auto robot = followed(plan);
    camera_.set_mode(CameraMode::still);
    camera_.set_orbit(direction_of(plan, has_ground(scene_.document().configuration.environment)));
    camera_.start(live.camera_boxes(), area_.aspect());
    camera_.begin(plan, robot ? robot : camera_.followed());
    if (std::exchange(begins_close_, false)) begin_close();
    camera_placed_ = true;
  }
}

// The samples are many and small: one of them shows first what moves here.
void Viewer::begin_close() {
  const std::span<const render::Bounds> boxes = scene_.drawn().camera_boxes();
  const render::Bounds all = render::bounds_of(boxes);
  const auto middle = std::ranges::min_element(boxes, {}, [&](const render::Bounds& box) {
    return box.empty() ? std::numeric_limits<float>::max() : (box.center() - all.center()).norm();
  });
  camera_.begin_close(static_cast<std::size_t>(middle - boxes.begin()));
}

// Cells are packed again when robots come or go, or when the view has another shape. A camera that stands then goes
// with the cell that it looks at: that of the selected robot, else the one nearest to its target. Call it before
// anything frames robots where they are now.
void Viewer::keep_anchor() {
  const LiveRobots& robots = *scene_.snapshot().robots;
  const DrawnScene& live = scene_.drawn();
  const bool stands = camera_placed_ && camera_.mode() == CameraMode::still && scene_.view().layout == Layout::cells;
  if (!stands || robots.robots.empty() || live.offsets().size() != robots.robots.size()) {
    anchor_.reset();
    return;
  }
  const auto at = anchor_ ? robots.index_of(anchor_->robot) : std::nullopt;
  if (at) camera_.shift(live.cell_center(*at) - anchor_->cell);
  const auto current = scene_.selection().current() ? robots.index_of(*scene_.selection().current()) : std::nullopt;
  std::size_t chosen = current.value_or(0);
  const auto distance = [&](std::size_t i) { return (live.cell_center(i) - camera_.orbit().target).norm(); };
  for (std::size_t i = 1; i < robots.robots.size() && !current; ++i)
    if (distance(i) < distance(chosen)) chosen = i;
  anchor_ = Anchor{robots.robots[chosen].id, live.cell_center(chosen)};
}

bool Viewer::leaves_gpu_to_steps() const {
  if (!scene_.time().playing() || std::isfinite(scene_.time().speed()) || scene_.cuda_device() < 0) return false;
  return !redraw_ && !mouse_.busy() && !camera_.gliding() && !recorder_.busy();
}

// Returns whether it draws the robots.
bool Viewer::draw_frame(double dt) {
  update_renderer();
  DrawnScene& live = scene_.drawn();
  camera_.floor =
      live.scene().surroundings == render::Surroundings::none ? std::nullopt : std::optional(live.scene().floor);
  const auto share = [](float covered, float whole) { return std::clamp(covered / std::max(1.0f, whole), 0.0f, 0.4f); };
  const Box &legend = context_.legend, &steps = context_.first_steps;
  // Of two sides, the second has the legend; both show the same.
  camera_.free.right = legend.empty() ? 0 : share(whole_area_.high.x - legend.low.x, area_.width());
  // A caption or a message has its place above the robots.
  camera_.free.top = share(std::max(Toasts::line_height(), context_.message.high.y - area_.low.y), area_.height());
  camera_.free.bottom = steps.empty() ? 0 : share(area_.high.y - steps.low.y, area_.height());
  const render::Camera camera = camera_.at(live.camera_boxes(), area_.aspect(), dt);
  if (drawn_ == 0 && expects_robots_ && live.bounds().empty() && since(run_begin_) < longest_blank) return false;
  // A glide ends with moves too small to see, which must not keep the view coarse.
  const float least = 2e-4f * (camera.eye - camera.target).norm();
  const bool moved_before = camera_moved_;
  camera_moved_ = (camera.eye - shown_camera_.eye).norm() > least ||
                  (camera.target - shown_camera_.target).norm() > least ||
                  camera.field_of_view != shown_camera_.field_of_view;
  const bool stepped = shown_steps_ != scene_.snapshot().steps || shown_time_ != live.scene().time;
  const bool changed = shown_changes_ != changes_of(scene_);
  // A new area or new bodies move the camera once.
  const bool jumps = redraw_ && !moved_before;
  const bool moving = (camera_moved_ && !jumps) || (stepped && scene_.time().playing()) || mouse_.busy();
  if (!moving && !stepped && !changed && !redraw_ && !viewport_.coarse() && !second_.coarse()) return false;
  if (pacing_.keeps_robots(leaves_gpu_to_steps())) return false;
  const auto begin = Clock::now();
  live.show_positions(viewport_.renderer());
  times_.positions = since(begin);
  viewport_.draw(without_text(live.scene()), camera, moving);
  second_.draw(scene_, camera, moving);
  ++drawn_;
  times_.drawn = since(begin);
  shown_camera_ = camera;
  shown_steps_ = scene_.snapshot().steps;
  shown_changes_ = changes_of(scene_);
  shown_time_ = live.scene().time;
  redraw_ = false;
  return true;
}

// Does nothing if the window shows this frame already. `draws`: the frame has new robots.
void Viewer::present(bool draws) {
  const bool exposed = window_.take_exposure(), looks_new = imgui_.end_frame();
  times_.waiting = 0;
  if (!draws && !exposed && !looks_new && !redraw_ && !recorder_.busy() && !screenshot_.busy() &&
      !context_.screenshot_requested)
    return;
  const WindowSize pixels = window_.pixels();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, pixels.width, pixels.height);
  const ImVec4 background = panel_background();
  glClearColor(background.x, background.y, background.z, background.w);
  glClear(GL_COLOR_BUFFER_BIT);
  if (pixels.width > 0 && pixels.height > 0 && drawn_ > 0) {
    viewport_.present(pixels.height);
    second_.present(pixels.height);
  }
  imgui_.draw();
  recorder_.capture_frame(context_, pixels);
  update_screenshot();
  // After both, so that neither shows it.
  if (recorder_.recording() && !recorder_.ending())
    imgui_.draw_on_top([&](ImDrawList& list) { draw_recording_sign(list, context_, area_); });
  if (log_) {
    const auto begin = Clock::now();
    glFinish();
    times_.waiting = since(begin);
  }
  window_.swap_buffers();
  ++presented_;
}

void Viewer::update_screenshot() {
  if (std::exchange(context_.screenshot_requested, false) && !screenshot_.busy())
    screenshot_.take(read_window(window_.pixels()), unused_path(picture_folder(context_), ".png"));
  std::filesystem::path path;
  std::string error;
  if (!screenshot_.done(path, error)) return;
  if (error.empty())
    toasts_.show(Tone::success, "picture saved: " + path.string());
  else
    toasts_.show(Tone::error, error);
  log_.write("screenshot", {{"file", path.string()}});
}

}  // namespace

int run_viewer(ViewerOptions options) { return Viewer(std::move(options)).run(); }

}  // namespace mercury::window
