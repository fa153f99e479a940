// SPDX-License-Identifier: Apache-2.0
// Universal Scene Description, as text (.usda): the skin as a mesh, the springs as curves, their points over time. A
// recorded frame is a time code. Frames are written one after another; none is kept in memory.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
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
  std::span<const Vec3> velocities(std::size_t frame) const {
    return motion_ ? motion_->pose_with_velocities(frame).velocities : pose_.velocities;
  }
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
  // `total`: frames of all lists of points that will be written.
  UsdaWriter(OutputStream& file, const ExportChoices& choices, std::size_t total)
      : file_(file), watch_(choices.watch), total_(total) {}

  // `title` of the document; `frames`: of the longest motion.
  void begin(const std::string& title, const std::string& root, const Frames& frames) {
    file_.print("#usda 1.0\n(\n    defaultPrim = \"{}\"\n    doc = \"{}\"\n    metersPerUnit = 1\n    upAxis = \"Z\"\n",
                root, quoted(fmt::format("{}, written by {}", title, program_version)));
    if (frames.moves()) {
      const double rate = frames.count() > 1 ? frames.rate() : 24;
      file_.print(
          "    startTimeCode = 0\n    endTimeCode = {}\n    timeCodesPerSecond = {}\n    framesPerSecond = {}\n",
          frames.time_code(frames.count() - 1), rate, rate);
    }
    file_.text(")\n\n");
  }

  // The floor and the camera as prims below `parent`.
  void write_stage(const Environment& environment, const StageChoices& choices) {
    const Stage stage = stage_of(reach_, environment, choices);
    if (stage.floor) write_floor(*stage.floor);
    if (stage.camera) write_camera(*stage.camera);
  }

  // A robot as a prim below `parent`, a path such as "/robots"; empty = at the top.
  void write(const ExportedRobot& exported, const SkinShape& shape, const Frames& frames, const std::string& parent,
             const std::string& name, const render::Vector3& offset) {
    frames_ = &frames;
    path_ = parent + "/" + name;
    offset_ = offset;
    file_.print("def Xform \"{}\" (\n    kind = \"component\"\n)\n{{\n", name);
    if (offset != render::Vector3{0, 0, 0})
      file_.print(
          "    double3 xformOp:translate = ({}, {}, {})\n    uniform token[] xformOpOrder = [\"xformOp:translate\"]\n",
          offset.x, offset.y, offset.z);
    write_materials(shape);
    if (!shape.faces.empty()) write_skin(shape);
    if (!shape.springs.empty()) write_springs(shape, shortest_of(exported.robot));
    file_.text("}\n");
  }

 private:
  void write_floor(const StageFloor& floor) {
    const std::vector<Vec3> corners(floor.corners.begin(), floor.corners.end());
    file_.text(
        "def Mesh \"floor\" (\n    prepend apiSchemas = [\"MaterialBindingAPI\"]\n)\n{\n"
        "    uniform token subdivisionScheme = \"none\"\n    int[] faceVertexCounts = [4]\n"
        "    int[] faceVertexIndices = [0, 1, 2, 3]\n    rel material:binding = </floor_materials/floor>\n");
    write_vectors("    point3f[] points = [", corners, "]\n");
    file_.text("    float3[] extent = ");
    write_box(box_of(corners));
    const auto [r, g, b] = floor.color;
    file_.print(
        "\n    color3f[] primvars:displayColor = [({}, {}, {})] (\n        interpolation = \"constant\"\n    )\n}}\n",
        r, g, b);
    file_.text("def Scope \"floor_materials\"\n{\n");
    write_material("/floor_materials", "floor", "floor", floor.color, 0.9f);
    file_.text("}\n");
  }

  // USD wants the sizes of a film and of its lens, here those of 35 mm [tenths of a unit of the scene].
  void write_camera(const StageCamera& camera) {
    constexpr float width = 36;
    const float height = width / camera.aspect, focal_length = height / (2 * std::tan(camera.field_of_view / 2));
    file_.print(
        "def Camera \"camera\"\n{{\n    token projection = \"perspective\"\n    float horizontalAperture = {}\n"
        "    float verticalAperture = {}\n    float focalLength = {}\n    float2 clippingRange = ({}, {})\n"
        "    matrix4d xformOp:transform = ( ",
        width, height, focal_length, camera.near, camera.far);
    for (const render::Vector3& axis : camera.axes) file_.print("({}, {}, {}, 0), ", axis.x, axis.y, axis.z);
    file_.print("({}, {}, {}, 1) )\n    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n}}\n", camera.eye.x,
                camera.eye.y, camera.eye.z);
  }

  static std::string material_name(const ExportedMaterial& material) { return fmt::format("material_{}", material.id); }

  // As renderers and Blender take them, beside the colors of faces that viewers show.
  void write_materials(const SkinShape& shape) {
    file_.text("    def Scope \"materials\"\n    {\n");
    for (const ExportedMaterial& material : shape.materials)
      write_material(path_ + "/materials", material_name(material), material.name, render::linear_of(material.color),
                     0.5f);
    file_.text("    }\n");
  }

  void write_material(const std::string& scope, const std::string& name, const std::string& shown,
                      const std::array<float, 3>& color, float roughness) {
    file_.print(
        "        def Material \"{0}\" (\n            displayName = \"{1}\"\n        )\n        {{\n"
        "            token outputs:surface.connect = <{2}/{0}/surface.outputs:surface>\n"
        "            def Shader \"surface\"\n            {{\n"
        "                uniform token info:id = \"UsdPreviewSurface\"\n"
        "                color3f inputs:diffuseColor = ({3}, {4}, {5})\n"
        "                float inputs:roughness = {6}\n"
        "                token outputs:surface\n            }}\n        }}\n",
        name, quoted(shown), scope, color[0], color[1], color[2], roughness);
  }

  // The faces of each material, and their material.
  void write_subsets(const SkinShape& shape) {
    const auto faces = by_material(shape, shape.face_materials);
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (faces[i].empty()) continue;
      file_.print(
          "        def GeomSubset \"{}\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n"
          "        {{\n            uniform token elementType = \"face\"\n"
          "            uniform token familyName = \"materialBind\"\n",
          material_name(shape.materials[i]));
      write_list("            int[] indices = [", faces[i], [&](std::uint32_t face) { file_.print("{}", face); });
      file_.print("            rel material:binding = <{}/materials/{}>\n        }}\n", path_,
                  material_name(shape.materials[i]));
    }
  }

  void write_skin(const SkinShape& shape) {
    file_.text(
        "    def Mesh \"skin\"\n    {\n        uniform token subdivisionScheme = \"none\"\n"
        "        uniform token subsetFamily:materialBind:familyType = \"partition\"\n");
    write_list("        int[] faceVertexCounts = [", shape.faces, [&](const auto&) { file_.text("3"); });
    write_list("        int[] faceVertexIndices = [", shape.faces,
               [&](const auto& face) { file_.print("{}, {}, {}", face[0], face[1], face[2]); });
    write_colors(shape, shape.face_materials);
    const auto of_vertices = [&](std::span<const Vec3> of_masses) { return vertices_of(shape, of_masses); };
    write_points(of_vertices);
    write_velocities(of_vertices);
    write_normals(shape);
    write_subsets(shape);
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

  void write_vectors(std::string_view start, const std::vector<Vec3>& vectors, std::string_view end) {
    write_list(
        start, vectors, [&](Vec3 p) { file_.print("({}, {}, {})", p.x, p.y, p.z); }, end);
  }

  template <class PointsAt>
  void write_points(const PointsAt& points_at) {
    std::vector<Box> boxes;
    const auto write_frame = [&](std::string_view start, std::size_t frame, std::string_view end) {
      const std::vector<Vec3> points = points_at(frames_->pose(frame).positions);
      boxes.push_back(box_of(points));
      reach_.extend(render::Vector3(boxes.back().low) + offset_);
      reach_.extend(render::Vector3(boxes.back().high) + offset_);
      write_vectors(start, points, end);
    };
    if (!frames_->moves()) {
      write_frame("        point3f[] points = [", 0, "]\n");
      file_.text("        float3[] extent = ");
      write_box(boxes.front());
      return file_.text("\n");
    }
    file_.text("        point3f[] points.timeSamples = {\n");
    for (std::size_t frame = 0; frame < frames_->count(); ++frame) {
      write_frame(fmt::format("            {}: [", frames_->time_code(frame)), frame, "],\n");
      watch_(std::min(++done_, total_), total_);
    }
    file_.text("        }\n        float3[] extent.timeSamples = {\n");
    for (std::size_t frame = 0; frame < frames_->count(); ++frame) {
      file_.print("            {}: ", frames_->time_code(frame));
      write_box(boxes[frame]);
      file_.text(",\n");
    }
    file_.text("        }\n");
  }

  // In meters per second, for motion blur; poses at rest have none.
  template <class At>
  void write_velocities(const At& at) {
    if (!frames_->moves()) return;
    file_.text("        vector3f[] velocities.timeSamples = {\n");
    for (std::size_t frame = 0; frame < frames_->count(); ++frame)
      write_vectors(fmt::format("            {}: [", frames_->time_code(frame)), at(frames_->velocities(frame)),
                    "],\n");
    file_.text("        }\n");
  }

  // Of a curved skin; without them, programs shade each face flat.
  void write_normals(const SkinShape& shape) {
    if (!shape.is_smooth) return;
    const auto normals = [&](std::size_t frame) {
      return vertex_normals(shape, vertices_of(shape, frames_->pose(frame).positions));
    };
    if (frames_->moves()) {
      file_.text("        normal3f[] normals.timeSamples = {\n");
      for (std::size_t frame = 0; frame < frames_->count(); ++frame)
        write_vectors(fmt::format("            {}: [", frames_->time_code(frame)), normals(frame), "],\n");
      file_.text("        }\n");
    } else {
      write_vectors("        normal3f[] normals = [", normals(0), "]\n");
    }
  }

  void write_box(const Box& box) {
    file_.print("[({}, {}, {}), ({}, {}, {})]", box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z);
  }

  OutputStream& file_;
  const FrameWatch& watch_;
  const Frames* frames_ = nullptr;
  std::string path_;        // of the robot
  render::Vector3 offset_;  // likewise
  render::Bounds reach_;    // of all robots at all times
  std::size_t total_, done_ = 0;
};

std::size_t lists_of(const SkinShape& shape) {
  return std::size_t{!shape.faces.empty()} + std::size_t{!shape.springs.empty()};
}

void write_one(const ExportedRobot& robot, const Frames& frames, const std::filesystem::path& path,
               const ExportChoices& choices) {
  const SkinShape shape = skin_shape(robot.robot, choices.springs);
  OutputStreams files;
  UsdaWriter writer(files.add(path), choices, lists_of(shape) * frames.count());
  const std::string name = identifier_of(robot.robot.name);
  writer.begin(robot.robot.name, name, frames);
  writer.write(robot, shape, frames, "", name, {});
  writer.write_stage(robot.environment, choices.stage);
  files.keep();
}

}  // namespace

void write_usda(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
                const ExportChoices& choices) {
  write_one(robot, Frames(pose), path, choices);
}

void write_usda_motion(const ExportedRobot& robot, RecordedMotion& motion, const std::filesystem::path& path,
                       const ExportChoices& choices) {
  write_one(robot, Frames(motion), path, choices);
}

void write_usda_motions(std::span<RecordedMotion> motions, const std::filesystem::path& path,
                        const ExportChoices& choices) {
  if (motions.size() == 1) return write_usda_motion(motions[0].robot(), motions[0], path, choices);
  std::vector<SkinShape> shapes;
  std::size_t total = 0;
  for (RecordedMotion& motion : motions) {
    shapes.push_back(skin_shape(motion.robot().robot, choices.springs));
    total += lists_of(shapes.back()) * motion.frames();
  }
  OutputStreams files;
  OutputStream& file = files.add(path);
  UsdaWriter writer(file, choices, total);
  writer.begin(fmt::format("{} robots", motions.size()), "robots",
               Frames(*std::ranges::max_element(motions, {}, &RecordedMotion::frames)));
  file.text("def Xform \"robots\" (\n    kind = \"group\"\n)\n{\n");
  const std::vector<render::Vector3> offsets = side_by_side(motions);
  std::set<std::string> names;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    std::string name = identifier_of(motions[i].robot().robot.name);
    while (!names.insert(name).second) name += "_";
    writer.write(motions[i].robot(), shapes[i], Frames(motions[i]), "/robots", name, offsets[i]);
  }
  file.text("}\n");
  writer.write_stage(motions.front().robot().environment, choices.stage);
  files.keep();
}

}  // namespace mercury
