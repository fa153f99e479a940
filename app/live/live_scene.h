// SPDX-License-Identifier: Apache-2.0
// The scene of the interactive window: everything it does that is neither window nor OpenGL.
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
#include "app/live/explosions.h"
#include "app/live/group_video.h"
#include "app/live/live_picture.h"
#include "app/live/physics.h"
#include "app/live/picking.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_document.h"
#include "mercury/robot_file.h"

namespace mercury {

struct LiveSceneOptions {
  Configuration configuration;
  ViewSettings view;
};

// A pull by the hand, for the eye; places in the picture.
struct PerturbationDetails {
  RobotId robot = 0;
  std::uint16_t mass = 0;
  Eigen::Vector3f at, target;  // the mass, the hand [m]
  float stiffness = 0;         // [N/m]
  float force = 0;             // [N]
};

// One entry of the list of robots.
struct RobotEntry {
  RobotId id = 0;
  std::string name;
  std::size_t masses = 0, springs = 0, faces = 0;
  std::string file;                                      // it was read from or saved to; empty = none
  bool unsaved = false;                                  // differs from that file
  bool selected = false, hidden = false, tuned = false;  // tuned: has materials of its own now
  bool exploded = false;
  double exploded_at = 0;  // [s]
  std::uint32_t culprit_spring = no_spring;
};

// For one thread. Nothing waits for physics or for files; what cannot be done is told by take_messages(), and nothing
// but the constructor throws for what a user gives.
class LiveScene {
 public:
  // Throws InputError and DeviceError as Simulation.
  explicit LiveScene(const LiveSceneOptions& options = {});
  ~LiveScene();

  // Once a frame, first of all: takes the newest snapshot and what was made in the background, and brings picture() up
  // to date. `aspect` of the picture; counts when robots are laid out anew.
  void frame(float aspect = 16.0f / 9);
  const Snapshot& snapshot() const;  // newest, as of the last frame(); stays until the next one
  std::shared_ptr<const Snapshot> hold_snapshot() const;
  LivePicture& picture();  // scene, bounds, offsets, bodies' revision
  std::vector<Message> take_messages();
  std::string device_name() const;

  // Time.
  void play();
  void pause();
  void toggle();
  bool playing() const;               // as asked for; snapshot().playing tells what physics does
  void step(std::int64_t count = 1);  // pauses first
  void reset();
  void set_speed(double speed);  // clamped to 1/1000 .. 100, or unlimited_speed
  double speed() const;
  void change_speed(int notches);  // + faster: through 1, 2, 5 times powers of ten

  // Robots.
  std::vector<RobotEntry> entries() const;
  const SceneDocument& document() const;
  void add(std::vector<Robot> robots, bool unsaved = true);  // `unsaved`: they are kept nowhere else
  void open(const std::vector<std::filesystem::path>&
                paths);  // files and folders, recordings for their robots, or one repro; in the background
  void generate(const RandomRobots& generation, bool replace = false);  // in the background; replace = instead of all
  void remove(const std::vector<RobotId>& robots);
  void duplicate(const std::vector<RobotId>& robots);
  // A child of each, beside it or in its place. Robots that are neither voxel nor network ones cannot.
  void mutate(const std::vector<RobotId>& robots, const MutationRequest& mutation, bool replace = false);
  void clear();
  void rename(RobotId robot, const std::string& name);
  bool can_mutate(RobotId robot) const;
  std::vector<Work> work() const;  // what goes on in the background: for progress bars
  void cancel_work(std::uint64_t work);
  void wait_for_work();    // until nothing goes on in the background, and it is in the scene
  void wait_until_done();  // the same, and physics has done all it was asked for, and frame() was called

  // Selection. The current one is the last that was selected.
  void select(RobotId robot, bool alone = true);
  void toggle_selected(RobotId robot);
  void select_all();
  void clear_selection();
  bool is_selected(RobotId robot) const;
  std::vector<RobotId> selection() const;  // in the order of the list
  std::optional<RobotId> current() const;
  void set_hidden(RobotId robot, bool hidden);

  // Edits that can be taken back. Changes of one kind that follow each other, as a slider makes them, are one edit
  // until end_edit().
  bool can_undo() const;
  bool can_redo() const;
  std::string undo_name() const;  // "remove 2 robots"; empty = nothing
  std::string redo_name() const;
  void undo();
  void redo();
  void end_edit();

  // Parameters. What cannot be used is told and changes nothing; false then.
  const Configuration& configuration() const;
  bool set_configuration(const Configuration& configuration);  // the device stays what it is
  void reset_configuration();                                  // defaults of the present environment; device stays
  std::span<const Material> materials(RobotId robot) const;    // as they are now; empty = no such robot
  bool set_material(const std::vector<RobotId>& robots, MaterialId id, const Material& material);
  // For all materials but air: stiffness, amplitude, frequency multiplied, phase added to those of the robot's file.
  bool scale_materials(const std::vector<RobotId>& robots, const MaterialScale& scale);
  void reset_materials(const std::vector<RobotId>& robots);  // to those of the robot's file
  const ViewSettings& view() const;
  void set_view(const ViewSettings& settings);  // what the environment has not is left out while it lasts

  // Hands. Rays and places in the picture.
  std::optional<Hit> pick(const render::Ray& ray) const;
  HitDetails describe(const Hit& hit) const;
  void begin_perturbation(const Hit& hit, float stiffness = 0);  // 0 = what suits the robot
  void move_perturbation(const Eigen::Vector3f& target);
  void set_perturbation_stiffness(float stiffness);
  void end_perturbation();
  std::optional<PerturbationDetails> perturbation() const;

  // Files. None replaces a file that exists unless told to.
  SaveResult save(RobotId robot, const std::filesystem::path& path, bool overwrite = false);
  SaveResult save_all(const std::vector<RobotId>& robots, const std::filesystem::path& folder, RobotFormat format,
                      bool overwrite = false);
  // `mercury view ...` or `mercury render ... -o scene.mp4` that makes this scene, and what it cannot say.
  CommandText command(const std::string& subcommand = "view") const;

  // Measures.
  Series series(RobotId robot) const;
  std::vector<RankingRow> ranking() const;
  std::string csv(const std::vector<RobotId>& robots) const;  // time series, one column a robot and quantity
  std::string ranking_csv() const;
  SaveResult save_text(const std::filesystem::path& path, const std::string& text, bool overwrite = false);

  // A film of the robots that are not hidden, from time 0, in the background.
  std::unique_ptr<GroupVideo> export_video(const GroupVideoOptions& options) const;

  // Explosions.
  std::vector<ExplodedRobot> exploded() const;  // at the snapshot, those that are hidden left out
  std::vector<Explosion> take_explosions();     // since the last call
  void pause_on_explosion(bool pause);
  // NAME.repro in a folder: robot, configuration, a state of some seconds ago, and pulls and changes since. mercury run
  // and mercury view make it explode again, at the same step and bit for bit on the same kind of device.
  SaveResult save_repro(RobotId robot, const std::filesystem::path& folder, bool overwrite = false);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
