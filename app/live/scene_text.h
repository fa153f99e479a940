// SPDX-License-Identifier: Apache-2.0
// The window's scene as the text of a scene file (docs/formats.md).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/live/command_text.h"
#include "app/live/robot_saving.h"
#include "app/live/scene_document.h"
#include "app/options/attachment_options.h"
#include "app/scene/view_settings.h"

namespace mercury {

// A robot of the document as a scene names it.
struct SceneRobot {
  const DocumentRobot* robot = nullptr;
  std::string file;  // that holds it as it is; empty = none
};

// What is to be written for a scene: the scene file last, and before it a file for each robot that is in no other.
// Those are robots that only the window has, random ones before robots of files (a scene names files first), and random
// ones of a kind whose options differ from those of the first. `beside` are the indices of those robots, in the order
// of their files. `attached` and `driven`: pins and springs, and drives by hand, by the robots' places in `robots`.
// Throws InputError for a robot or a name that cannot be written.
struct SceneOutput {
  std::vector<FileToSave> files;
  std::vector<std::size_t> beside;
};
SceneOutput scene_files(const std::filesystem::path& path, const std::vector<SceneRobot>& robots,
                        const Configuration& configuration, const ViewSettings& view, const HeldParts& held = {},
                        const TrialStart& start = {});

}  // namespace mercury
