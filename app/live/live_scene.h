// SPDX-License-Identifier: Apache-2.0
// The scene of the interactive window: everything that the window does except windows and OpenGL.
//
//   SceneDocument (robots, parameters; edits, undo) --> PhysicsThread --> Snapshot --> DrawnScene --> the window draws
//
// An edit changes the document on the window's thread and sends it to the physics thread; frame() fetches the newest
// snapshot. Reading files and making robots are background tasks; their results enter the document in frame().
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/live/background.h"
#include "app/live/command_text.h"
#include "app/live/drawn_scene.h"
#include "app/live/group_video.h"
#include "app/live/live_run.h"
#include "app/live/physics.h"
#include "app/live/picking.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_document.h"
#include "app/live/voxel_edit.h"
#include "app/options/attachment_options.h"
#include "mercury/robot_file.h"

namespace mercury {

struct LiveSceneOptions {
  Configuration configuration;
  TrialStart start;
  ViewSettings view;
};

// A perturbation by the mouse as the window draws it. Positions are those in the view.
struct PerturbationDetails {
  RobotId robot = 0;
  std::uint16_t mass = 0;
  render::Vector3 at, target;  // of the mass and of the mouse [m]
  float stiffness = 0;         // [N/m]
  float force = 0;             // [N]
};

// One entry of the list of robots.
struct RobotEntry {
  RobotId id = 0;
  std::string name;
  std::size_t masses = 0, springs = 0, faces = 0;
  std::string file;                                      // read from or saved to it; empty = none
  bool unsaved = false;                                  // differs from its file
  bool selected = false, hidden = false, tuned = false;  // tuned: its materials were changed
  bool exploded = false;
  double exploded_at = 0;                    // [s]
  std::uint32_t culprit_spring = no_spring;  // index in Robot::springs
};

// What a ghost shows. automatic: the robot before it was changed, if it was; else its parent, if it has one.
enum class GhostOf { automatic, unchanged, parent };

// A ghost that is wanted.
struct LiveGhost {
  RobotId robot = 0;
  bool of_parent = false;
  LiveRobot body;
};

// How a robot compares with its ghost, when it was as old as the ghost is now.
struct GhostFigures {
  RobotId robot = 0;
  bool of_parent = false;
  double age = 0;                                 // of the ghost [s]
  double robot_distance = 0, ghost_distance = 0;  // from their starts [m]
  double robot_speed = 0, ghost_speed = 0;        // distance / age [m/s]
  bool same_age = true;                           // the robot is as old as the ghost
  bool ghost_exploded = false;
};

// What LiveScene::mark_loop() did.
enum class LoopMark { begun, closed, ended };

// All members are called from one thread. None waits for physics or for files, except those named wait_*. Errors are
// reported by take_messages(); only the constructor throws.
class LiveScene {
 public:
  // Throws InputError for an invalid configuration and DeviceError for a missing device.
  explicit LiveScene(const LiveSceneOptions& options = {});
  ~LiveScene();

  // Call it first in every frame: fetches the newest snapshot and the results of background tasks, and updates
  // drawn(). `aspect` is the view's width divided by its height; the layout of the robots depends on it.
  void frame(float aspect = 16.0f / 9);
  // What a grid faces from the next frame() on; before the first call, the camera of view() decides. From above, the
  // robots lie beside each other, as on the ground. `direction`: else the angles of the eye; absent = those of view().
  void face(bool from_above, const std::optional<render::Orbit>& direction = {});
  const Snapshot& snapshot() const;  // of the last frame(); valid until the next one
  std::shared_ptr<const Snapshot> hold_snapshot() const;
  DrawnScene& drawn();
  std::vector<Message> take_messages();
  std::string device_name() const;
  int cuda_device() const;  // of all robots; -1 = none, or several
  // Positions stay on the GPU and reach the renderer by this bridge. The bridge's context must be current in the
  // destructor.
  void set_bridge(std::shared_ptr<PositionBridge> bridge);

  // Time. Speeds are simulated seconds per second.
  void play();
  void pause();
  void toggle();
  bool playing() const;               // as requested; snapshot().playing is what physics does
  void step(std::int64_t count = 1);  // pauses first
  void reset();
  void set_speed(double speed);  // clamped to 1/1000 .. 100, or unlimited_speed
  double speed() const;
  void change_speed(int notches);  // faster if > 0: 0.1, 0.2, 0.5, 1, 2, 5, ...

  // The timeline (timeline.h). snapshot().timeline says which moments there are; times are simulated seconds. An edit
  // while an earlier moment is shown goes on from there.
  void seek(double time);
  void step_back(std::int64_t count = 1);  // pauses first
  void go_on();                            // what came after the moment shown is forgotten
  // Copies of robots in the state of the moment shown, which goes on. Returns their ids.
  std::vector<RobotId> fork(const std::vector<RobotId>& robots);
  void set_loop(std::optional<std::pair<double, double>> times);
  // One key: begins a loop at the moment shown, closes it there, ends it.
  LoopMark mark_loop();
  std::optional<double> loop_begin() const;      // of a loop that is not closed yet
  const std::vector<double>& bookmarks() const;  // ascending
  bool toggle_bookmark();                        // at the moment shown; returns whether there is one now
  bool seek_bookmark(int direction);             // to the next (> 0) or previous one; false = there is none
  void set_timeline_budget(std::size_t bytes);

  // Robots.
  std::vector<RobotEntry> entries() const;
  std::size_t robot_count() const;
  const SceneDocument& document() const;
  // Returns the ids of those that can be used. `unsaved`: they are in no file.
  std::vector<RobotId> add(std::vector<Robot> robots, bool unsaved = true);
  // Shows these robots alone, in this configuration (but on the same device), as one edit. They need no saving.
  void show(std::vector<Robot> robots, const Configuration& configuration, const std::string& edit);
  // Opens robot files, folders of them, or one recording, repro or scene, in the background. Those three take the place
  // of the current scene; of several recordings, the robots are opened at rest.
  void open(const std::vector<std::filesystem::path>& paths);
  // Makes random robots in the background. `replace`: they replace all robots. `lively`: the liveliest of ten times as
  // many (mercury/lively.h), tried in the scene's environment.
  void generate(const RandomRobots& generation, bool replace = false, bool lively = false);
  void remove(const std::vector<RobotId>& robots);
  void duplicate(const std::vector<RobotId>& robots);
  // Makes a child of each robot in the background, beside its parent or in its place. Only robots with a known
  // generator can have children.
  void mutate(const std::vector<RobotId>& robots, const MutationRequest& mutation, bool replace = false);
  // Makes a child of two robots in the background. Both must be of one generator.
  void breed(RobotId a, RobotId b, std::uint64_t seed);
  void clear();
  void rename(RobotId robot, const std::string& name);
  // Edits of a voxel robot's body. The robot goes on where it is, and what is attached to it comes off. edit_voxel()
  // returns false, with a message, if the edit cannot be made.
  bool has_voxels(RobotId robot) const;
  std::optional<VoxelSide> voxel_side(const Hit& hit) const;
  bool edit_voxel(RobotId robot, const VoxelSide& side, const VoxelEdit& edit);
  std::vector<Work> work() const;  // running and waiting background tasks, for progress bars
  void cancel_work(std::uint64_t work);
  void wait_for_work();    // until all background tasks have ended and their results are in the scene
  void wait_until_done();  // also until physics has carried out all commands; calls frame()

  // Selection. The current robot is the one selected last.
  void select(RobotId robot, bool alone = true);
  void toggle_selected(RobotId robot);
  void select_all();
  void clear_selection();
  void set_selection(const std::vector<RobotId>& robots);  // these alone, the last one becomes the current robot
  bool is_selected(RobotId robot) const;
  std::vector<RobotId> selection() const;  // in the order of the list
  std::optional<RobotId> current() const;
  void set_hidden(RobotId robot, bool hidden);
  bool is_hidden(RobotId robot) const;

  // Undo and redo. Successive changes of one kind, such as those of a slider, are one edit until end_edit().
  bool can_undo() const;
  bool can_redo() const;
  std::string undo_name() const;  // "remove 2 robots"; empty = nothing to undo
  std::string redo_name() const;
  void undo();
  void redo();
  void end_edit();
  void forget_edits();  // there is nothing to undo or redo then

  // Parameters. An invalid value changes nothing: it is reported and the result is false. A change of the environment
  // is an edit of its own. Robots that come to land are set down at rest; undo takes every robot back to where and how
  // it was before the change.
  const Configuration& configuration() const;
  bool set_configuration(const Configuration& configuration);  // keeps the device
  // Where robots begin: at rest, or as the first trial of a run does. New ones do so, and all after a reset; at time 0
  // all move there at once. An edit.
  const TrialStart& start() const;
  bool set_start(const TrialStart& start);
  std::span<const Material> materials(RobotId robot) const;  // in use; empty if the robot is unknown
  bool set_material(const std::vector<RobotId>& robots, MaterialId id, const Material& material);
  // Changes all materials but air: multiplies stiffness, amplitude and frequency of the robot's file, adds to the
  // phase.
  bool scale_materials(const std::vector<RobotId>& robots, const MaterialScale& scale);
  void reset_materials(const std::vector<RobotId>& robots);  // to those of the robot's file
  // Drives the actuators of this name by hand, in place of their sines and brains: u in [-1, 1]; none = releases them.
  // Like the materials, drives belong to undo and the timeline; scene files keep them.
  void drive_actuator(const std::vector<RobotId>& robots, const std::string& actuator, std::optional<float> drive);
  void release_actuators(const std::vector<RobotId>& robots);
  // The neuron of its brain has this value whatever it reads (0 silences it), none = it thinks again; kept as drives
  // are.
  void clamp_neuron(RobotId robot, std::size_t neuron, std::optional<float> value);
  void release_neurons(RobotId robot);
  const ViewSettings& view() const;
  void set_view(const ViewSettings& settings);  // details that the environment lacks are ignored

  // Mouse. Rays and positions are those in the view, or in that of the second side.
  void point_at_second(bool second);
  bool points_at_second() const;
  const Snapshot& pointed_snapshot() const;
  const DrawnScene& pointed_drawn() const;
  std::optional<Hit> pick(const render::Ray& ray) const;
  HitDetails describe(const Hit& hit) const;
  void begin_perturbation(const Hit& hit, float stiffness = 0);  // [N/m]; 0 = suits the robot
  void move_perturbation(const render::Vector3& target);
  void set_perturbation_stiffness(float stiffness);
  void end_perturbation();
  std::optional<PerturbationDetails> perturbation() const;
  // Pushes all robots a tenth of a second from now, or in the next step while time stands: the parameters push and
  // push_at of the environment. Returns false, with a message, if the velocity cannot be [m/s].
  bool push(const Vec3& velocity);
  // Springs that stay until they are removed or their robot goes; each change is an edit. attach_perturbation() ends
  // the perturbation and leaves its spring; pin() holds a mass where it is, and after a reset where it starts.
  void attach_perturbation();
  void pin(const Hit& hit);
  bool has_attachments(const std::vector<RobotId>& robots) const;
  void remove_attachments(const std::vector<RobotId>& robots);
  std::vector<PerturbationDetails> attachments() const;
  // Holds these as soon as the robots that are being opened or made are there; no edit of its own.
  void hold_opened(HeldParts held);

  // Comparison (comparison.h). The second side shows the same robots under other settings, from the moment shown on;
  // all that changes robots or time acts on both. nullopt ends it.
  void set_second(const std::optional<SideDifference>& difference);
  const std::optional<SideDifference>& second() const;
  // The second side's view; null if there is none, as while a recording is played.
  DrawnScene* second_drawn();
  // Ghosts of these robots, from the moment shown on, in the place of those there were. Returns how many there are:
  // robots without a parent have no ghost of it.
  std::size_t show_ghosts(const std::vector<RobotId>& robots, GhostOf of = GhostOf::automatic);
  void hide_ghosts();
  const std::vector<LiveGhost>& ghosts() const;
  std::vector<GhostFigures> ghost_figures() const;

  // Files. An existing file is replaced only with `overwrite`.
  SaveResult save(RobotId robot, const std::filesystem::path& path, bool overwrite = false);
  SaveResult save_all(const std::vector<RobotId>& robots, const std::filesystem::path& folder, RobotFormat format,
                      bool overwrite = false);
  // Writes the scene as a file (docs/formats.md): robots, configuration and looks. Robots that no file or seed has are
  // written beside it, into the folder NAME-robots.
  SaveResult save_scene(const std::filesystem::path& path, bool overwrite = false);
  // The scene that was opened or saved last; empty if there was none.
  const std::filesystem::path& scene_file() const;
  // The camera of a scene that was opened since the last call.
  std::optional<CameraPlan> take_camera();
  // Writes a robot's current pose for other programs; the file's extension says the format (app/export).
  SaveResult export_pose(RobotId robot, const std::filesystem::path& path, bool overwrite = false);
  // The same for the motion of robots from time 0 to `seconds`, which is simulated in the background: of one, or of as
  // many as the format holds. Returns once it has begun, with the file; a message says when it is there.
  SaveResult export_motion(const std::vector<RobotId>& robots, const std::filesystem::path& path, double seconds,
                           bool overwrite = false);
  // Runs `mercury export` with these words in the background, which writes a page of a run to `path`. `program` is this
  // one, except in tests.
  SaveResult export_run(const std::filesystem::path& run, const std::vector<std::string>& words,
                        const std::filesystem::path& path, bool overwrite = false,
                        const std::filesystem::path& program = this_program());
  // The command line `mercury view ...` or `mercury render ... -o scene.mp4` that makes this scene, and what it cannot
  // express.
  CommandText command(const std::string& subcommand = "view") const;

  // Until some frames without a call, snapshots have the activity of this robot's brain.
  void watch_brain(RobotId robot);

  // Measures.
  Series series(RobotId robot) const;
  Series second_series(RobotId robot) const;  // empty if there is no second side
  Series ghost_series(RobotId robot) const;   // empty if it has no ghost
  std::vector<RankingRow> ranking() const;
  std::string csv(const std::vector<RobotId>& robots) const;  // time series, one column per robot and quantity
  std::string ranking_csv() const;
  SaveResult save_text(const std::filesystem::path& path, const std::string& text, bool overwrite = false);

  // Starts a video of the visible robots from time 0, in the background.
  std::unique_ptr<GroupVideo> export_video(const GroupVideoOptions& options) const;

  // Explosions.
  std::vector<ExplodedRobot> exploded() const;  // in the snapshot, without hidden robots
  std::vector<Explosion> take_explosions();     // since the last call
  void pause_on_explosion(bool pause);
  // Writes NAME.repro: the robot, its configuration, a state some seconds before the explosion, and the changes and
  // perturbations since. `mercury run` and `mercury view` repeat the explosion at the same step, on the same kind of
  // device bit for bit.
  SaveResult save_repro(RobotId robot, const std::filesystem::path& folder, bool overwrite = false);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
