// SPDX-License-Identifier: Apache-2.0
#include "app/export/export_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "mercury/error.h"
#include "mercury/import.h"
#include "mercury/robot_file.h"

namespace mercury {
namespace {

using Springs = ExportFormat::Springs;

// The grid and the materials of the robot's origin; where its masses are does not matter.
void write_vxa_file(const ExportedRobot& robot, const Pose&, const std::filesystem::path& path,
                    const ExportChoices& choices) {
  write_vxa(robot.robot, path, choices.world);
}

constexpr std::array formats{
    ExportFormat{.name = "obj",
                 .extension = ".obj",
                 .title = "Wavefront OBJ",
                 .help = "skin with materials (.mtl) for Blender and most other programs",
                 .springs = Springs::if_asked,
                 .pose = write_obj,
                 .files_beside = beside_obj},
    ExportFormat{.name = "ply",
                 .extension = ".ply",
                 .title = "PLY",
                 .help = "skin with colors for MeshLab and mesh libraries",
                 .springs = Springs::if_asked,
                 .pose = write_ply},
    ExportFormat{.name = "stl",
                 .extension = ".stl",
                 .title = "STL",
                 .help = "skin without colors for printing and CAD",
                 .pose = write_stl},
    ExportFormat{.name = "glb",
                 .extension = ".glb",
                 .title = "glTF",
                 .help = "skin with colors for web viewers; a short motion as morph targets",
                 .springs = Springs::if_asked,
                 .holds_scene = true,
                 .pose = write_glb,
                 .motion = write_glb_motion,
                 .motions = write_glb_motions},
    ExportFormat{.name = "usda",
                 .extension = ".usda",
                 .title = "USD",
                 .help = "skin with colors for Blender, usdview and other USD programs",
                 .springs = Springs::if_asked,
                 .holds_scene = true,
                 .pose = write_usda,
                 .motion = write_usda_motion,
                 .motions = write_usda_motions},
    ExportFormat{.name = "usdz",
                 .extension = ".usdz",
                 .title = "USD archive",
                 .help = "the same in one archive",
                 .springs = Springs::if_asked,
                 .holds_scene = true,
                 .pose = write_usdz,
                 .motion = write_usdz_motion,
                 .motions = write_usdz_motions},
    ExportFormat{.name = "pc2",
                 .extension = ".pc2",
                 .title = "Point cache",
                 .help = "moves the mesh (.obj) written beside it: Blender's Mesh Cache, 3ds Max",
                 .springs = Springs::if_asked,
                 .motion = write_pc2,
                 .files_beside = beside_pc2},
    ExportFormat{.name = "vtu",
                 .extension = ".vtu",
                 .title = "VTK grid",
                 .help = "skin and springs with material, strain, force and velocity for ParaView",
                 .springs = Springs::always,
                 .needs_skin = false,
                 .pose = write_vtu},
    ExportFormat{.name = "pvd",
                 .extension = ".pvd",
                 .title = "VTK series",
                 .help = "the same for every frame of a motion, a .vtu file each",
                 .springs = Springs::always,
                 .needs_skin = false,
                 .motion = write_pvd,
                 .folder_beside = frames_beside},
    ExportFormat{.name = "xdmf",
                 .extension = ".xdmf",
                 .title = "XDMF",
                 .help = "describes the recording itself for ParaView and meshio, which read its numbers from there",
                 .springs = Springs::always,
                 .needs_skin = false,
                 .needs_recording = true,
                 .motion = write_xdmf,
                 .files_beside = beside_xdmf},
    ExportFormat{.name = "csv",
                 .extension = ".csv",
                 .title = "Table",
                 .help = "center of mass, senses and neurons over time, for spreadsheets and pandas",
                 .needs_skin = false,
                 .motion = write_csv},
    ExportFormat{.name = "html",
                 .extension = ".html",
                 .title = "Web page",
                 .help = "plays robots in a browser, in one file and without a network",
                 .motion = write_html_motion,
                 .motions = write_html},
    ExportFormat{.name = "vxa",
                 .extension = ".vxa",
                 .title = "VXA",
                 .help = "voxels, muscles and world of a voxel robot for VoxCAD, evosoro and voxcraft-sim",
                 .needs_skin = false,
                 .holds_world = true,
                 .pose = write_vxa_file},
};

}  // namespace

std::span<const ExportFormat> export_formats() { return formats; }

const ExportFormat& export_format(std::string_view name) {
  const auto found = std::ranges::find(formats, name, &ExportFormat::name);
  if (found == formats.end())
    throw ParameterError("format", fmt::format("\"{}\" is not accepted; give {}", name, format_names()));
  return *found;
}

const ExportFormat* export_format_of(const std::filesystem::path& file) {
  const auto found = std::ranges::find(formats, extension_of(file), &ExportFormat::extension);
  return found == formats.end() ? nullptr : &*found;
}

std::string format_names(bool (*condition)(const ExportFormat&)) {
  std::string names;
  for (const ExportFormat& format : formats) {
    if (!condition(format)) continue;
    if (!names.empty()) names += ", ";
    names += format.name;
  }
  return names;
}

}  // namespace mercury
