// SPDX-License-Identifier: Apache-2.0
// Robots from files of other simulators (docs/import.md): VXA, VXD and VXC of VoxCAD, evosoro and voxcraft-sim, and
// recorded motions of the latter, RSC of RISE, worlds and robots of EvoGym; and voxel robots as VXA.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mercury/import_report.h"
#include "mercury/robot.h"

namespace mercury {

struct ImportOptions {
  std::filesystem::path base;  // of a .vxd or .rsc; empty = base.vxa or env.rsc beside it
  int depth = 1;               // voxels that a flat robot of EvoGym is thick
  int most_materials = 255;    // of a robot; at most 22 give every robot a voxel grid that mutates
};

// Throws ParameterError("depth", ...), ("materials", ...) for values that cannot be used.
void validate(const ImportOptions& options);

// What the file says about the world, in Mercury's units and names.
struct ImportedSettings {
  std::string environment = "land";
  double gravity = 0;                     // along z, negative = down [m/s2]
  double stiffness_scale = 1;             // of the environment, for which the robots' stiffnesses are made
  double friction = 0;                    // of the floor; land only
  double static_friction = 0;             // of masses at rest on it, if above `friction`, else 0; land only
  bool self_collision = true;             // land only
  double contact_stiffness = 100;         // land only, times the stiffness scale [N/m]
  double contact_distance = 0.5;          // land only, in shortest rest lengths of the robot
  double drag_coefficient = 0;            // C_N of one-sided resistive water; resistive only
  double dt = 1e-3;                       // time step that is stable for the stiffest robot [s]
  double damping = 0;                     // [1/s]
  std::optional<double> seconds, settle;  // how long the file's program simulates, and what it waits before [s]
  friend bool operator==(const ImportedSettings&, const ImportedSettings&) = default;
};

// The settings as the text of a configuration file (--config).
std::string to_toml(const ImportedSettings& settings, const ImportReport& report);

// What a file recorded of its robots' motion.
struct ImportedMotion {
  std::vector<double> times;                 // of the frames, rising [s]
  std::vector<std::vector<Vec3>> positions;  // per frame: of all masses, robot after robot [m]
};

struct Import {
  std::vector<Robot> robots;
  std::optional<ImportedMotion> motion;  // of a file that holds one; the robots' materials are then unknown
  ImportedSettings settings;
  ImportReport report;
};

// A format that can be read. Each is described once, beside its reader in robots/importers; the list of import.cpp has
// them all, and messages, help and Python derive from it.
struct ImportFormat {
  std::string_view name;        // "vxa"
  std::string_view extensions;  // in small letters: ".vxa .vxc"
  std::string_view programs;    // that write it: "VoxCAD, evosoro and voxcraft-sim"
  // Of a format that builds on another file: the name of that file, beside the one that is read.
  std::string_view base_name = {};
  bool needs_base = false;
  // Whether a file with such an extension is of this format, by its beginning; nullptr = the extension decides.
  bool (*recognizes)(std::string_view beginning) = nullptr;
  // `name` names the robots; `base` is the text of the base. Throws InputError.
  Import (*read)(std::string_view text, std::string_view base, const std::string& name, const ImportOptions& options);
};

// "VoxCAD, evosoro and voxcraft-sim (.vxa, .vxc, .vxd), RISE (.rsc) and EvoGym (.json)"
std::string import_sources();

// The format of a file: by its extension, in small letters or capitals, and where several programs share an extension
// by its content. nullptr for other files, and for those that cannot be read.
const ImportFormat* import_format_of(const std::filesystem::path& path);
// Whether a file may be the base of others beside it.
bool is_import_base(const std::filesystem::path& path);

// Reads a file of another simulator. Throws InputError in one line that says where and why, for a file that cannot be
// read or breaks a rule: "hopper.vxa: /VXA/VXC/Structure/X_Voxels: ...".
Import import_file(const std::filesystem::path& path, const ImportOptions& options = {});
// The same where the format is known.
Import import_file(const std::filesystem::path& path, const ImportFormat& format, const ImportOptions& options = {});

// The same for a text in the format of a name. Memory follows what the text holds, not the sizes that it claims.
Import import_text(std::string_view text, std::string_view format, const std::string& name,
                   const ImportOptions& options = {}, std::string_view base = {});

// A voxel robot, or one that was imported, as VXA: the grid and the materials of its origin, and a world; without one,
// that of the environment that the robot is made for. import_text() gives back the same grid, materials and world.
// Throws InputError for a robot whose origin holds no grid.
std::string vxa_document(const Robot& robot, const std::optional<ImportedSettings>& world = {});

// Writes vxa_document() to a file, whole or not at all. Throws InputError as that, and for a file that cannot be
// written.
void write_vxa(const Robot& robot, const std::filesystem::path& path,
               const std::optional<ImportedSettings>& world = {});

}  // namespace mercury
