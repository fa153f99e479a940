// SPDX-License-Identifier: Apache-2.0
// A scene as a file (docs/formats.md): robots, environment, solver, camera and looks.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/options/attachment_options.h"
#include "app/options/command.h"
#include "app/options/trial_start.h"
#include "app/scene/view_settings.h"
#include "mercury/configuration.h"
#include "mercury/generator.h"
#include "mercury/robot.h"

namespace mercury {

// Whether the name is that of a scene: *.toml, in small letters or capitals, other than run.toml of a run.
bool is_scene_name(const std::filesystem::path& path);

class SceneFile {
 public:
  // Reads and checks the whole file, except for the robots' own files. Throws InputError with the line and the key:
  // "scene.toml:7: --dt: -1 is not accepted; ...".
  explicit SceneFile(const std::filesystem::path& path);
  ~SceneFile();
  SceneFile(SceneFile&&) noexcept;
  SceneFile& operator=(SceneFile&&) noexcept;

  const std::filesystem::path& path() const;
  // Robot files, as paths from the working folder, and random robots, which follow them.
  const std::vector<std::string>& robots() const;
  std::vector<RandomRobots> random() const;
  // What is held by hand; robots are counted as in the file, random ones last.
  HeldParts held() const;
  // Where its robots begin.
  TrialStart start() const;
  // Gives a robot of one of its files a real body if the scene says so. Throws InputError.
  void give_body(Robot& robot, const std::string& file) const;
  // `files` = the robots of its files. Without `environment` in the scene, they and the random ones choose. Appends to
  // `notes` what the user should know about that. The device is the default one. Throws InputError if some have real
  // bodies and others those of the paper.
  Configuration configuration(std::span<const Robot* const> files, std::vector<std::string>& notes) const;
  // `usual`: the layout if the file names none.
  ViewSettings view(Layout usual = Layout::grid) const;

  // What the file says as options of a command ("--dt=0.002"): those that the command has, and that are not on its
  // command line `given`. If that names another environment, the file's parameters of its own are left out.
  std::vector<std::string> arguments(const Command& command, const std::vector<std::string>& given) const;
  // The error's text, preceded by file and line if it begins with the name of an option that came from the file.
  std::string located(const std::string& error) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mercury
