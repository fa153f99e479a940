// SPDX-License-Identifier: Apache-2.0
// Universal Scene Description, as text (.usda): the skin as a mesh, the springs as curves, their points over time. A
// recorded frame is a time code. Frames are written one after another; none is kept in memory.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/base/version.h"
#include "app/export/writers.h"

namespace mercury {
namespace {

// The frames of a motion, or the one of a pose.
class Frames {
 public:
  explicit Frames(const Pose& pose) : pose_(pose) {}
  explicit Frames(RecordedMotion& motion) : motion_(&motion) {}

  bool moves() const { return motion_ != nullptr; }
  std::size_t count() const { return motion_ ? motion_->frames() : 1; }
  Pose pose(std::size_t frame) const { return motion_ ? motion_->pose(frame) : pose_; }
  double rate() const { return motion_ ? motion_->frame_rate() : 0; }
  // Whole numbers, as far as frames are equally far apart.
  double time_code(std::size_t frame) const {
    if (count() < 2) return 0;
    const double code = (motion_->time(frame) - motion_->time(0)) * rate();
    const double whole = static_cast<double>(std::llround(code));
    return std::abs(code - whole) < 1e-6 ? whole : code;
  }

 private:
  Pose pose_;
  RecordedMotion* motion_ = nullptr;
};

struct Box {
  Vec3 low, high;
};
Box box_of(const std::vector<Vec3>& points) {
  Box box{points.front(), points.front()};
  for (const Vec3 p : points) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
  }
  return box;
}

// Text between quotes: what could end it, or is no character of a line, becomes "_".
std::string quoted(const std::string& text) {
  std::string result;
  for (const char letter : text)
    result += letter == '"' || letter == '\\' || static_cast<unsigned char>(letter) < 0x20 ? '_' : letter;
  return result;
}

class UsdaWriter {
 public:
  UsdaWriter(OutputStream& file, const Frames& frames, const ExportChoices& choices)
      : file_(file), frames_(frames), watch_(choices.watch) {}

  void write(const ExportedRobot& exported, const SkinShape& shape) {
    passes_ = std::size_t{!shape.faces.empty()} + std::size_t{!shape.springs.empty()};
    const std::string name = identifier_of(exported.robot.name);
    file_.print("#usda 1.0\n(\n    defaultPrim = \"{}\"\n    doc = \"{}\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n",
                name, quoted(fmt::format("{}, written by {}", exported.robot.name, program_version)));
    if (frames_.moves()) {
      const double rate = frames_.count() > 1 ? frames_.rate() : 24;
      file_.print(
          "    startTimeCode = 0\n    endTimeCode = {}\n    timeCodesPerSecond = {}\n    framesPerSecond = {}\n",
          frames_.time_code(frames_.count() - 1), rate, rate);
    }
    file_.print(")\n\ndef Xform \"{}\" (\n    kind = \"component\"\n)\n{{\n", name);
    if (!shape.faces.empty()) write_skin(shape);
    if (!shape.springs.empty()) write_springs(shape, shortest_of(exported.robot));
    file_.text("}\n");
  }

 private:
  void write_skin(const SkinShape& shape) {
    file_.text("    def Mesh \"skin\"\n    {\n        uniform token subdivisionScheme = \"none\"\n");
    write_list("        int[] faceVertexCounts = [", shape.faces, [&](const auto&) { file_.text("3"); });
    write_list("        int[] faceVertexIndices = [", shape.faces,
               [&](const auto& face) { file_.print("{}, {}, {}", face[0], face[1], face[2]); });
    write_colors(shape, shape.face_materials);
    write_points([&](std::span<const Vec3> positions) { return vertices_of(shape, positions); });
    file_.text("    }\n");
  }

  // Each a curve of its own, with its two ends.
  void write_springs(const SkinShape& shape, float width) {
    file_.text("    def BasisCurves \"springs\"\n    {\n        uniform token type = \"linear\"\n");
    write_list("        int[] curveVertexCounts = [", shape.springs, [&](const auto&) { file_.text("2"); });
    file_.print("        float[] widths = [{}] (\n            interpolation = \"constant\"\n        )\n", width);
    write_colors(shape, shape.spring_materials);
    write_points([&](std::span<const Vec3> positions) {
      std::vector<Vec3> ends;
      ends.reserve(2 * shape.springs.size());
      for (const auto& spring : shape.springs)
        for (const std::uint16_t vertex : spring) ends.push_back(positions[shape.masses[vertex]]);
      return ends;
    });
    file_.text("    }\n");
  }

  // A tenth of the shortest spring.
  static float shortest_of(const Robot& robot) {
    float shortest = robot.springs.front().rest_length;
    for (const Spring& spring : robot.springs) shortest = std::min(shortest, spring.rest_length);
    return 0.1f * shortest;
  }

  template <class Element, class Write>
  void write_list(std::string_view start, const std::vector<Element>& elements, const Write& write,
                  std::string_view end = "]\n") {
    file_.text(start);
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (i > 0) file_.text(", ");
      write(elements[i]);
    }
    file_.text(end);
  }

  // In linear light, one per face or curve.
  void write_colors(const SkinShape& shape, const std::vector<MaterialId>& materials) {
    std::array<std::array<float, 3>, max_materials> linear{};
    for (const ExportedMaterial& material : shape.materials) linear[material.id] = render::linear_of(material.color);
    const auto write_color = [&](MaterialId id) {
      const auto [r, g, b] = linear[id];
      file_.print("({}, {}, {})", r, g, b);
    };
    write_list("        color3f[] primvars:displayColor = [", materials, write_color,
               "] (\n            interpolation = \"uniform\"\n        )\n");
  }

  template <class PointsAt>
  void write_points(const PointsAt& points_at) {
    const auto write_vector = [&](Vec3 p) { file_.print("({}, {}, {})", p.x, p.y, p.z); };
    std::vector<Box> boxes;
    const auto write_frame = [&](std::string_view start, std::size_t frame, std::string_view end) {
      const std::vector<Vec3> points = points_at(frames_.pose(frame).positions);
      boxes.push_back(box_of(points));
      write_list(start, points, write_vector, end);
    };
    if (!frames_.moves()) {
      write_frame("        point3f[] points = [", 0, "]\n");
      file_.text("        float3[] extent = ");
      write_box(boxes.front());
      return file_.text("\n");
    }
    file_.text("        point3f[] points.timeSamples = {\n");
    for (std::size_t frame = 0; frame < frames_.count(); ++frame) {
      write_frame(fmt::format("            {}: [", frames_.time_code(frame)), frame, "],\n");
      watch_(++done_, passes_ * frames_.count());
    }
    file_.text("        }\n        float3[] extent.timeSamples = {\n");
    for (std::size_t frame = 0; frame < frames_.count(); ++frame) {
      file_.print("            {}: ", frames_.time_code(frame));
      write_box(boxes[frame]);
      file_.text(",\n");
    }
    file_.text("        }\n");
  }

  void write_box(const Box& box) {
    file_.print("[({}, {}, {}), ({}, {}, {})]", box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z);
  }

  OutputStream& file_;
  const Frames& frames_;
  const FrameWatch& watch_;
  std::size_t passes_ = 1, done_ = 0;
};

void write(const ExportedRobot& robot, const Frames& frames, const std::filesystem::path& path,
           const ExportChoices& choices) {
  OutputStreams files;
  UsdaWriter(files.add(path), frames, choices).write(robot, skin_shape(robot.robot, choices.springs));
  files.keep();
}

}  // namespace

void write_usda(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
                const ExportChoices& choices) {
  write(robot, Frames(pose), path, choices);
}

void write_usda_motion(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                       const ExportChoices& choices) {
  write(robot, Frames(motion), path, choices);
}

}  // namespace mercury
