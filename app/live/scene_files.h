// SPDX-License-Identifier: Apache-2.0
// The files of the window's scene: what it opens and saves, and its command line.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/live/command_text.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_document.h"
#include "app/scene/view_settings.h"
#include "mercury/robot_file.h"

namespace mercury {

class Background;
class SavedRobots;
class SceneCore;
class SceneFile;
class SceneRobots;
class SceneTime;
class TrajectoryReader;
struct Repro;

// An existing file is replaced only with `overwrite`.
class SceneFiles {
 public:
  SceneFiles(SceneCore& core, SceneTime& time, SceneRobots& robots, SavedRobots& saved, Background& background)
      : core_(core), time_(time), robots_(robots), saved_(saved), background_(background) {}

  // Opens robot files, folders of them, or one recording, repro or scene, in the background. Those three take the place
  // of the current scene; of several recordings, the robots are opened at rest.
  void open(const std::vector<std::filesystem::path>& paths);
  // Holds these as soon as the robots that are being opened or made are there; no edit of its own.
  void hold_opened(HeldParts held);

  SaveResult save(RobotId robot, const std::filesystem::path& path, bool overwrite = false);
  SaveResult save_all(const std::vector<RobotId>& robots, const std::filesystem::path& folder, RobotFormat format,
                      bool overwrite = false);
  // Writes the scene as a file (docs/formats.md): robots, configuration and looks. Robots that no file or seed has are
  // written beside it, into the folder NAME-robots.
  SaveResult save_scene(const std::filesystem::path& path, bool overwrite = false);
  // The scene that was opened or saved last; empty if there was none.
  const std::filesystem::path& scene_file() const { return scene_file_; }
  // The camera of a scene that was opened since the last call.
  std::optional<CameraPlan> take_camera();
  // Writes NAME.repro: the robot, its configuration, a state some seconds before the explosion, and the changes and
  // perturbations since. `mercury run` and `mercury view` repeat the explosion at the same step, on the same kind of
  // device bit for bit.
  SaveResult save_repro(RobotId robot, const std::filesystem::path& folder, bool overwrite = false);
  // The command line `mercury view ...` or `mercury render ... -o scene.mp4` that makes this scene, and what it cannot
  // express.
  CommandText command(const std::string& subcommand = "view") const;

 private:
  // Clears the scene and sets what else the file says. `environments`: those that its robots are made for.
  SceneDocument& open_scene(const SceneFile& scene, std::span<const Robot* const> robots);
  void replay(const std::shared_ptr<const Repro>& repro, const std::filesystem::path& file);
  void play_recording(const std::shared_ptr<TrajectoryReader>& recording, const std::filesystem::path& file);
  // Empties the scene for what has its own clock and states; undo brings back those of now.
  SceneDocument& replace_scene(const std::filesystem::path& file, const Configuration& configuration);

  SceneCore& core_;
  SceneTime& time_;
  SceneRobots& robots_;
  SavedRobots& saved_;
  Background& background_;
  std::filesystem::path scene_file_;  // opened or saved last
  std::optional<CameraPlan> camera_;  // of a scene that was opened
};

}  // namespace mercury
