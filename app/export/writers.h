// SPDX-License-Identifier: Apache-2.0
// The writers of the formats, listed in export_format.cpp. Files are whole or not at all; files of these names are
// replaced. All throw as OutputStream.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/export/exported_robot.h"
#include "app/export/output_stream.h"
#include "app/export/recorded_motion.h"
#include "app/export/skin_shape.h"
#include "app/export/stage.h"
#include "mercury/import.h"

namespace mercury {

struct Board;

// Called after each frame; may throw to stop the work, which then leaves nothing behind.
using FrameWatch = std::function<void(std::size_t done, std::size_t total)>;

// An individual of an evolution, as a node of a family tree.
struct ExportedIndividual {
  std::uint64_t id = 0;
  std::vector<std::uint64_t> parents;
  int generation = 0;
  double score = 0;
  std::optional<std::size_t> robot;  // of those that are exported
};

// What a page says besides motions.
struct ExportNotes {
  std::string title;                               // empty = the robots' names
  std::string subtitle;                            // empty = how many robots there are
  std::string command;                             // that makes the file again
  std::vector<std::vector<std::string>> captions;  // lines below the names, per robot; empty = none
  std::vector<std::string> final_states;           // per robot: hash and time; empty = those of the last frames
  std::shared_ptr<const Board> board;              // a map whose cells have the robots, or nothing
  std::vector<ExportedIndividual> family;          // the robots and their kin, by id; empty = none
};

struct ExportChoices {
  bool springs = false;                   // also the springs, as lines
  StageChoices stage;                     // of formats that hold scenes
  std::optional<ImportedSettings> world;  // of formats that hold one; none = that of the robot's origin
  ExportNotes notes;
  FrameWatch watch = [](std::size_t, std::size_t) {};
};

void write_obj(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
               const ExportChoices& choices);
// Its materials, in an .mtl file.
std::vector<std::filesystem::path> beside_obj(const std::filesystem::path& obj);
// Adds both to the files that are written.
void add_obj(OutputStreams& files, const ExportedRobot& robot, const SkinShape& shape, const Pose& pose,
             const std::filesystem::path& path);

void write_ply(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
               const ExportChoices& choices);
void write_stl(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
               const ExportChoices& choices);

// Faces and springs as cells, all masses as points.
void write_vtu(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
               const ExportChoices& choices);
// A .vtu file per frame in a folder beside the .pvd file, which lists them with their times.
void write_pvd(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
               const ExportChoices& choices);
std::filesystem::path frames_beside(const std::filesystem::path& pvd);

void write_glb(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
               const ExportChoices& choices);
// Throws InputError that says what would fit if the motion is too long (largest_glb).
void write_glb_motion(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                      const ExportChoices& choices);

// The first frame as an .obj file beside the point cache, which moves its vertices.
void write_pc2(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
               const ExportChoices& choices);
std::vector<std::filesystem::path> beside_pc2(const std::filesystem::path& pc2);

// A table with a line per frame.
void write_csv(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
               const ExportChoices& choices);

void write_usda(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
                const ExportChoices& choices);
void write_usda_motion(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                       const ExportChoices& choices);

// Several robots side by side, as pictures lay them out.
void write_glb_motions(std::span<RecordedMotion> motions, const std::filesystem::path& path,
                       const ExportChoices& choices);
void write_usda_motions(std::span<RecordedMotion> motions, const std::filesystem::path& path,
                        const ExportChoices& choices);

// The same in one archive.
void write_usdz(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
                const ExportChoices& choices);
void write_usdz_motion(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                       const ExportChoices& choices);
void write_usdz_motions(std::span<RecordedMotion> motions, const std::filesystem::path& path,
                        const ExportChoices& choices);

// Describes the recording for ParaView and meshio; its numbers stay where they are. Beside it, a file with names of the
// frames. Throws InputError for a recording that was not finished.
void write_xdmf(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                const ExportChoices& choices);
std::vector<std::filesystem::path> beside_xdmf(const std::filesystem::path& xdmf);

// A web page that plays all motions side by side. They are of one recording.
void write_html(std::span<RecordedMotion> motions, const std::filesystem::path& path, const ExportChoices& choices);
void write_html_motion(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                       const ExportChoices& choices);

}  // namespace mercury
