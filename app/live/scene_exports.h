// SPDX-License-Identifier: Apache-2.0
// What the window's scene writes for other programs: poses, motions, pages of runs, and videos. All but poses are made
// in the background.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/live/live_run.h"
#include "app/live/robot_saving.h"

namespace mercury {

class Background;
class GroupVideo;
class SceneCore;
class SceneSelection;
struct GroupVideoOptions;

// An existing file is replaced only with `overwrite`, except by a video.
class SceneExports {
 public:
  SceneExports(SceneCore& core, const SceneSelection& selection, Background& background)
      : core_(core), selection_(selection), background_(background) {}

  // Writes a robot's current pose; the file's extension says the format (app/export).
  SaveResult pose(RobotId robot, const std::filesystem::path& path, bool overwrite = false);
  // The same for the motion of robots from time 0 to `seconds`, which is simulated: of one, or of as many as the format
  // holds. Returns once it has begun, with the file; a message says when it is there.
  SaveResult motion(const std::vector<RobotId>& robots, const std::filesystem::path& path, double seconds,
                    bool overwrite = false);
  // Runs `mercury export` with these words, which writes a page of a run to `path`. `program` is this one, except in
  // tests.
  SaveResult run(const std::filesystem::path& run, const std::vector<std::string>& words,
                 const std::filesystem::path& path, bool overwrite = false,
                 const std::filesystem::path& program = this_program());
  // Starts a video of the visible robots from time 0.
  std::unique_ptr<GroupVideo> video(const GroupVideoOptions& options) const;

 private:
  SceneCore& core_;
  const SceneSelection& selection_;
  Background& background_;
};

}  // namespace mercury
