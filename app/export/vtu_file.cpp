// SPDX-License-Identifier: Apache-2.0
// VTK's unstructured grids (.vtu) and series of them (.pvd), for ParaView.
//
//   points   all masses, in the order of the robot's file, with their velocities
//   cells    first the faces, then the springs, in the order of the robot's file
//
// A face has the mean strain and force of the springs along its edges, so that the skin can be colored by them.
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <set>
#include <stdexcept>
#include <string>

#include "app/export/writers.h"
#include "mercury/names.h"

namespace mercury {
namespace {

constexpr std::uint8_t vtk_line = 3, vtk_triangle = 5;

template <class Value>
constexpr const char* vtk_type() {
  if constexpr (std::is_same_v<Value, float>) return "Float32";
  if constexpr (std::is_same_v<Value, double>) return "Float64";
  if constexpr (std::is_same_v<Value, std::uint8_t>) return "UInt8";
  if constexpr (std::is_same_v<Value, std::int32_t>) return "Int32";
}

// Arrays after the document, each compressed as one block.
class AppendedArrays {
 public:
  // The element that describes an array.
  template <class Value>
  std::string add(const char* name, std::span<Value> values, int components = 1, const char* more = "") {
    const std::size_t offset = content_.size();
    append(values.data(), values.size_bytes());
    const std::string shape = components > 1 ? fmt::format(" NumberOfComponents=\"{}\"", components) : "";
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\"{}{} format=\"appended\" offset=\"{}\"/>\n",
                       vtk_type<std::remove_const_t<Value>>(), name, shape, more, offset);
  }
  std::string add(const char* name, std::span<const Vec3> values) {
    return add(name, std::span(reinterpret_cast<const float*>(values.data()), 3 * values.size()), 3);
  }
  const std::string& content() const { return content_; }

 private:
  // Number of blocks, bytes of a block, bytes of a partial last block (none), compressed bytes of each block.
  void append(const void* data, std::size_t size) {
    if (size == 0) return header({0, 0, 0});
    uLongf packed = compressBound(static_cast<uLong>(size));
    std::string block(packed, '\0');
    if (compress2(reinterpret_cast<Bytef*>(block.data()), &packed, static_cast<const Bytef*>(data),
                  static_cast<uLong>(size), Z_BEST_SPEED) != Z_OK)
      throw std::runtime_error("the memory is used up");
    header({1, static_cast<std::uint32_t>(size), 0, static_cast<std::uint32_t>(packed)});
    content_.append(block, 0, packed);
  }
  void header(std::initializer_list<std::uint32_t> numbers) {
    content_.append(reinterpret_cast<const char*>(std::data(numbers)), numbers.size() * sizeof(std::uint32_t));
  }

  std::string content_;
};

// What is the same in all frames.
class CellGrid {
 public:
  explicit CellGrid(const ExportedRobot& exported)
      : exported_(exported), springs_of_faces_(springs_of_faces(exported.robot)) {
    const Robot& robot = exported.robot;
    const std::vector<render::Color> colors = colors_of(robot);
    const auto add = [&](std::uint8_t type, MaterialId material, std::initializer_list<std::uint16_t> corners) {
      corners_.insert(corners_.end(), corners.begin(), corners.end());
      ends_.push_back(static_cast<std::int32_t>(corners_.size()));
      types_.push_back(type);
      kinds_.push_back(type == vtk_line);
      materials_.push_back(material);
      for (const std::uint8_t channel : {colors[material].r, colors[material].g, colors[material].b})
        colors_.push_back(channel);
    };
    const std::vector<MaterialId> of_faces = skin_shape(robot, false).face_materials;
    for (std::size_t i = 0; i < robot.faces.size(); ++i)
      add(vtk_triangle, of_faces[i], {robot.faces[i].a, robot.faces[i].b, robot.faces[i].c});
    for (const Spring& spring : robot.springs) add(vtk_line, spring.material, {spring.a, spring.b});
  }

  void write(OutputStream& file, const Pose& pose) const {
    const SpringValues springs = spring_values(exported_, pose);
    AppendedArrays arrays;
    const double time = pose.time;
    file.print(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
        "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n");
    // One after another: the offsets follow from the order.
    const auto section = [&](const char* name, std::initializer_list<std::string> elements) {
      file.print("<{}>\n", name);
      for (const std::string& element : elements) file.text(element);
      file.print("</{}>\n", name);
    };
    section("FieldData", {arrays.add("TimeValue", std::span(&time, 1), 1, " NumberOfTuples=\"1\"")});
    file.print("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", pose.positions.size(), types_.size());
    section("Points", {arrays.add("position", pose.positions)});
    if (!pose.velocities.empty()) section("PointData", {arrays.add("velocity", pose.velocities)});
    section("Cells", {arrays.add("connectivity", std::span(corners_)), arrays.add("offsets", std::span(ends_)),
                      arrays.add("types", std::span(types_))});
    const std::vector<float> strain = cell_values(springs.strain), force = cell_values(springs.force);
    section("CellData", {arrays.add("kind", std::span(kinds_)), arrays.add("material", std::span(materials_)),
                         arrays.add("color", std::span(colors_), 3), arrays.add("strain", std::span(strain)),
                         arrays.add("force", std::span(force))});
    file.text("</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    file.text(arrays.content());
    file.text("\n</AppendedData>\n</VTKFile>\n");
  }

 private:
  std::vector<float> cell_values(const std::vector<float>& of_springs) const {
    std::vector<float> values;
    values.reserve(types_.size());
    for (const auto& edges : springs_of_faces_) {
      float sum = 0, count = 0;
      for (const std::uint32_t spring : edges) {
        if (spring == no_spring) continue;
        sum += of_springs[spring];
        ++count;
      }
      values.push_back(count > 0 ? sum / count : 0);
    }
    values.insert(values.end(), of_springs.begin(), of_springs.end());
    return values;
  }

  const ExportedRobot& exported_;
  std::vector<std::array<std::uint32_t, 3>> springs_of_faces_;
  std::vector<std::int32_t> corners_, ends_;  // of the cells, one after another
  std::vector<std::uint8_t> types_, kinds_, materials_, colors_;
};

// The frames of a series: in a folder of a temporary name until all are there.
class FrameFiles {
 public:
  explicit FrameFiles(const std::filesystem::path& folder) : folder_(folder), unfinished_(folder) {
    unfinished_ += fmt::format(".{}.part", getpid());
    std::filesystem::create_directories(unfinished_);
  }
  ~FrameFiles() {
    std::error_code ignored;
    std::filesystem::remove_all(unfinished_, ignored);
    if (std::filesystem::is_empty(folder_, ignored)) std::filesystem::remove(folder_, ignored);
  }
  FrameFiles(const FrameFiles&) = delete;
  FrameFiles& operator=(const FrameFiles&) = delete;

  void write(const CellGrid& grid, const Pose& pose, const std::string& name) {
    OutputStream file(unfinished_ / name);
    grid.write(file, pose);
    file.close();
    file.keep();
    names_.insert(name);
  }
  // Replaces the frames of an earlier series; other files of the folder stay.
  void keep() {
    std::filesystem::create_directories(folder_);
    for (const std::string& name : names_) std::filesystem::rename(unfinished_ / name, folder_ / name);
    std::vector<std::filesystem::path> earlier;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (is_frame(entry.path()) && !names_.contains(entry.path().filename().string())) earlier.push_back(entry.path());
    for (const std::filesystem::path& file : earlier) std::filesystem::remove(file);
  }

 private:
  static bool is_frame(const std::filesystem::path& file) {
    return file.extension() == ".vtu" && file.stem().string().find_first_not_of("0123456789") == std::string::npos;
  }

  std::filesystem::path folder_, unfinished_;
  std::set<std::string> names_;
};

}  // namespace

void write_vtu(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path, const ExportChoices&) {
  OutputStreams files;
  CellGrid(robot).write(files.add(path), pose);
  files.keep();
}

std::filesystem::path frames_beside(const std::filesystem::path& pvd) {
  return pvd.parent_path() / (pvd.stem().string() + "-frames");
}

namespace {

void write_series(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                  const ExportChoices& choices) {
  const CellGrid grid(robot);
  const std::filesystem::path folder = frames_beside(path);
  FrameFiles frames(folder);
  OutputStreams files;
  OutputStream& list = files.add(path);
  list.text(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n");
  const int digits = static_cast<int>(std::to_string(motion.frames() - 1).size());
  for (std::size_t frame = 0; frame < motion.frames(); ++frame) {
    const std::string name = fmt::format("{:0{}}.vtu", frame, digits);
    frames.write(grid, motion.pose_with_velocities(frame), name);
    list.print("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", motion.time(frame),
               markup_text((folder.filename() / name).string()));
    choices.watch(frame + 1, motion.frames());
  }
  list.text("</Collection>\n</VTKFile>\n");
  files.close({folder});
  frames.keep();
  files.keep();
}

}  // namespace

void write_pvd(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
               const ExportChoices& choices) {
  write_together(
      path, [](const std::filesystem::path& pvd) { return std::vector{frames_beside(pvd)}; },
      [&](const std::filesystem::path& name) { write_series(robot, motion, name, choices); });
}

}  // namespace mercury
