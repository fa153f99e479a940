// SPDX-License-Identifier: Apache-2.0
#include "app/live/live_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/live/background.h"
#include "app/live/picking.h"
#include "app/live/saved_robots.h"
#include "app/live/scene_comparison.h"
#include "app/live/scene_core.h"
#include "app/live/scene_exports.h"
#include "app/live/scene_files.h"
#include "app/live/scene_mouse.h"
#include "app/live/scene_parameters.h"
#include "app/live/scene_robots.h"
#include "app/live/scene_selection.h"
#include "app/live/scene_time.h"
#include "app/live/stepping.h"

namespace mercury {

struct LiveScene::Parts {
  explicit Parts(const LiveSceneOptions& options) : core(options.configuration, options.start, options.view) {}

  SceneCore core;
  DrawnScene drawn;
  SavedRobots saved;
  SceneTime time{core};
  SceneSelection selection{core.document()};
  SceneRobots robots{core, selection, saved, background};
  SceneParameters parameters{core};
  SceneComparison comparison{core};
  SceneMouse mouse{core, selection, drawn, comparison};
  SceneFiles files{core, time, robots, saved, background};
  SceneExports exports{core, selection, background};

  float aspect = 16.0f / 9;
  std::optional<bool> from_above;  // see LiveScene::face
  std::optional<render::Orbit> facing;
  RobotId watched_brain = 0;
  int brain_frames = 0;  // until snapshots stop reading it

  Background background{core.messages()};  // last: its tasks end before the members that they use
};

LiveScene::LiveScene(const LiveSceneOptions& options) : parts_(std::make_unique<Parts>(options)) { frame(); }

LiveScene::~LiveScene() = default;

SceneTime& LiveScene::time() { return parts_->time; }
SceneSelection& LiveScene::selection() { return parts_->selection; }
SceneRobots& LiveScene::robots() { return parts_->robots; }
SceneParameters& LiveScene::parameters() { return parts_->parameters; }
SceneMouse& LiveScene::mouse() { return parts_->mouse; }
SceneComparison& LiveScene::comparison() { return parts_->comparison; }
SceneFiles& LiveScene::files() { return parts_->files; }
SceneExports& LiveScene::exports() { return parts_->exports; }
const SceneTime& LiveScene::time() const { return parts_->time; }
const SceneSelection& LiveScene::selection() const { return parts_->selection; }
const SceneRobots& LiveScene::robots() const { return parts_->robots; }
const SceneParameters& LiveScene::parameters() const { return parts_->parameters; }
const SceneMouse& LiveScene::mouse() const { return parts_->mouse; }
const SceneComparison& LiveScene::comparison() const { return parts_->comparison; }
const SceneFiles& LiveScene::files() const { return parts_->files; }
const Measurements& LiveScene::measurements() const { return parts_->core.physics().measurements(); }

void LiveScene::watch_brain(RobotId robot) {
  parts_->brain_frames = 30;
  if (robot != parts_->watched_brain) parts_->core.physics().watch_brain(parts_->watched_brain = robot);
}

void LiveScene::frame(float aspect) {
  Parts& parts = *parts_;
  SceneCore& core = parts.core;
  if (std::isfinite(aspect) && aspect > 0) parts.aspect = aspect;
  parts.background.finish_done();
  parts.mouse.update();
  if (parts.brain_frames > 0 && --parts.brain_frames == 0) core.physics().watch_brain(parts.watched_brain = 0);
  core.fetch_snapshot();
  parts.time.update();
  parts.comparison.update();
  parts.selection.update();
  core.update_held(parts.background.work().empty());
  ViewSettings shown = core.view();
  if (parts.from_above) shown.camera.mode = *parts.from_above ? CameraMode::top : CameraMode::group;
  if (parts.facing) {
    constexpr float flattest = 0.35f;  // a view of the ground in which rows are apart [rad]
    const bool land = has_ground(core.document().configuration.environment);
    shown.camera.azimuth = parts.facing->azimuth;
    shown.camera.elevation = land ? std::max(flattest, parts.facing->elevation) : parts.facing->elevation;
  }
  std::optional<RobotId> held;
  if (const auto& pull = core.perturbations().by_mouse()) held = pull->robot;
  parts.drawn.update(core.hold_snapshot(), shown, parts.aspect, parts.selection.ids(), parts.selection.hidden(), held,
                     wall_now());
  parts.comparison.draw(parts.drawn, shown, parts.aspect, parts.selection, held);
}

void LiveScene::face(bool from_above, const std::optional<render::Orbit>& direction) {
  parts_->from_above = from_above;
  parts_->facing = direction;
}
const Snapshot& LiveScene::snapshot() const { return parts_->core.snapshot(); }
std::shared_ptr<const Snapshot> LiveScene::hold_snapshot() const { return parts_->core.hold_snapshot(); }
DrawnScene& LiveScene::drawn() { return parts_->drawn; }
std::vector<Message> LiveScene::take_messages() { return parts_->core.messages().take(); }
std::string LiveScene::device_name() const { return parts_->core.physics().device_name(); }
int LiveScene::cuda_device() const { return parts_->core.physics().cuda_device(); }
void LiveScene::set_bridge(std::shared_ptr<PositionBridge> bridge) {
  parts_->drawn.set_bridge(bridge);
  parts_->core.physics().set_bridge(std::move(bridge));
}

const SceneDocument& LiveScene::document() const { return std::as_const(parts_->core).document(); }
const ViewSettings& LiveScene::view() const { return parts_->core.view(); }
void LiveScene::set_view(const ViewSettings& settings) { parts_->core.set_view(settings); }

const EditHistory& LiveScene::history() const { return parts_->core.history(); }
void LiveScene::undo() { parts_->core.undo(); }
void LiveScene::redo() { parts_->core.redo(); }
void LiveScene::end_edit() { parts_->core.history().end_edit(); }
void LiveScene::forget_edits() { parts_->core.history().clear(); }

std::vector<Work> LiveScene::work() const { return parts_->background.work(); }
void LiveScene::cancel_work(std::uint64_t work) { parts_->background.cancel(work); }
void LiveScene::wait_for_work() {
  // A result may begin more work: that of a scene makes its random robots.
  do parts_->background.wait();
  while (parts_->background.finish_done());
}
void LiveScene::wait_until_done() {
  wait_for_work();
  parts_->core.physics().wait_until_done();
  frame(parts_->aspect);
}

std::vector<ExplodedRobot> LiveScene::exploded() const {
  std::vector<ExplodedRobot> robots = exploded_robots(snapshot(), parts_->drawn.last_boxes());
  std::erase_if(robots, [&](const ExplodedRobot& robot) { return parts_->selection.is_hidden(robot.robot); });
  return robots;
}
std::vector<Explosion> LiveScene::take_explosions() { return parts_->core.physics().take_explosions(); }

}  // namespace mercury
