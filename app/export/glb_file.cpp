// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 in one binary file. glTF has y up; a node turns the robots, whose numbers stay as they are.
//
// A motion has a morph target per frame, the difference from the first frame. The weight of target k is 1 at the time
// of frame k and 0 at all others; viewers interpolate linearly between frames.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/base/version.h"
#include "app/export/writers.h"
#include "app/recording/configuration_json.h"
#include "mercury/error.h"
#include "mercury/number_text.h"

namespace mercury {
namespace {

using nlohmann::ordered_json;

// Numbers that the format gives to its words.
enum Gltf { float_type = 5126, short_type = 5123, array_buffer = 34962, element_buffer = 34963, lines = 1 };

constexpr std::size_t most_targets = 256;                   // WebGL 2 promises textures of as many layers
constexpr std::size_t largest_glb = std::size_t{64} << 20;  // of the frames [bytes]

ordered_json shortest_numbers(Vec3 v) { return {shortest(v.x), shortest(v.y), shortest(v.z)}; }

// The document, and the numbers after it.
class Document {
 public:
  ordered_json json;
  std::string numbers;

  // Adds a list of numbers and its description; returns the accessor's index.
  template <class Value>
  std::size_t add(std::span<const Value> values, int component, const char* type, std::size_t count, int target = 0) {
    ordered_json view{{"buffer", 0}, {"byteOffset", numbers.size()}, {"byteLength", values.size_bytes()}};
    if (target != 0) view["target"] = target;
    numbers.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    numbers.append((4 - numbers.size() % 4) % 4, '\0');
    json["bufferViews"].push_back(view);
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", component},
                                 {"count", count},
                                 {"type", type}});
    return json["accessors"].size() - 1;
  }
  std::size_t add_vectors(const std::vector<Vec3>& values) {
    const std::size_t index = add(std::span(values), float_type, "VEC3", values.size(), array_buffer);
    Vec3 low = values.front(), high = low;
    for (const Vec3 v : values) {
      low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
      high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    json["accessors"][index]["min"] = shortest_numbers(low);
    json["accessors"][index]["max"] = shortest_numbers(high);
    return index;
  }
  std::size_t add_floats(const std::vector<float>& values) {
    return add(std::span(values), float_type, "SCALAR", values.size());
  }

  void write(OutputStream& file) {
    json["buffers"] = {{{"byteLength", numbers.size()}}};
    std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    text.append((4 - text.size() % 4) % 4, ' ');
    const auto size = [](std::size_t bytes) { return static_cast<std::uint32_t>(bytes); };
    file.text("glTF");
    file.raw(std::uint32_t{2});
    file.raw(size(12 + 8 + text.size() + 8 + numbers.size()));
    file.raw(size(text.size()));
    file.text("JSON");
    file.text(text);
    file.raw(size(numbers.size()));
    file.text(std::string_view("BIN\0", 4));
    file.text(numbers);
  }
};

ordered_json material_of(const ExportedMaterial& material) {
  const auto [r, g, b] = render::linear_of(material.color);
  return {{"name", material.name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {shortest(r), shortest(g), shortest(b), 1}},
            {"metallicFactor", 0},
            {"roughnessFactor", 0.5}}}};
}

// A primitive per material. Without normals viewers shade each face flat.
void add_primitives(Document& document, const std::string& name, const SkinShape& shape, const ordered_json& attributes,
                    const ordered_json& targets) {
  const std::size_t first_material = document.json["materials"].size();
  for (const ExportedMaterial& material : shape.materials) document.json["materials"].push_back(material_of(material));
  ordered_json primitives = ordered_json::array();
  const auto add = [&](const std::vector<std::uint16_t>& indices, std::size_t material, bool are_lines) {
    if (indices.empty()) return;
    ordered_json primitive{
        {"attributes", attributes},
        {"indices", document.add(std::span(indices), short_type, "SCALAR", indices.size(), element_buffer)},
        {"material", material}};
    if (are_lines) primitive["mode"] = int{lines};
    if (!targets.empty()) primitive["targets"] = targets;
    primitives.push_back(primitive);
  };
  const auto add_all = [&](const auto& elements, std::span<const MaterialId> materials, bool are_lines) {
    const auto lists = by_material(shape, materials);
    for (std::size_t i = 0; i < lists.size(); ++i) {
      std::vector<std::uint16_t> indices;
      for (const std::uint32_t element : lists[i])
        indices.insert(indices.end(), elements[element].begin(), elements[element].end());
      add(indices, first_material + i, are_lines);
    }
  };
  add_all(shape.faces, shape.face_materials, false);
  add_all(shape.springs, shape.spring_materials, true);
  document.json["meshes"].push_back({{"name", name}, {"primitives", primitives}});
}

// Vertices of the robot at a moment: positions, and normals of a curved skin.
ordered_json add_vertices(Document& document, const SkinShape& shape, const std::vector<Vec3>& vertices) {
  ordered_json attributes{{"POSITION", document.add_vectors(vertices)}};
  if (shape.is_smooth) attributes["NORMAL"] = document.add_vectors(vertex_normals(shape, vertices));
  return attributes;
}

// A morph target: the differences of vertices and their normals from the first ones.
ordered_json add_target(Document& document, const SkinShape& shape, const std::vector<Vec3>& first,
                        const std::vector<Vec3>& moved) {
  const auto add_difference = [&](const std::vector<Vec3>& from, std::vector<Vec3> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = to[i] - from[i];
    return document.add_vectors(to);
  };
  ordered_json target{{"POSITION", add_difference(first, moved)}};
  if (shape.is_smooth) target["NORMAL"] = add_difference(vertex_normals(shape, first), vertex_normals(shape, moved));
  return target;
}

// A node that turns the scene, whose children are the robots.
Document empty_document() {
  constexpr double half_root = 0.7071067811865476;
  Document document;
  document.json = {
      {"asset", {{"version", "2.0"}, {"generator", program_version}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes",
       {{{"name", "robots"}, {"rotation", {-half_root, 0, 0, half_root}}, {"children", ordered_json::array()}}}},
      {"meshes", ordered_json::array()},
      {"materials", ordered_json::array()},
      {"accessors", ordered_json::array()},
      {"bufferViews", ordered_json::array()}};
  return document;
}

// Of the last mesh. Returns the node's index.
std::size_t add_node(Document& document, const std::string& name, const render::Vector3& offset) {
  ordered_json node{{"name", name}, {"mesh", document.json["meshes"].size() - 1}};
  if (offset != render::Vector3{0, 0, 0})
    node["translation"] = {shortest(offset.x), shortest(offset.y), shortest(offset.z)};
  document.json["nodes"].push_back(node);
  const std::size_t index = document.json["nodes"].size() - 1;
  document.json["nodes"][0]["children"].push_back(index);
  return index;
}

// The floor and the camera, beside the robots.
void add_stage(Document& document, const Stage& stage) {
  const auto add = [&](ordered_json node) {
    document.json["nodes"].push_back(std::move(node));
    document.json["nodes"][0]["children"].push_back(document.json["nodes"].size() - 1);
  };
  if (stage.floor) {
    const auto& [corners, color] = *stage.floor;
    const std::vector<std::uint16_t> indices{0, 1, 2, 0, 2, 3};
    const std::size_t positions = document.add_vectors({corners.begin(), corners.end()});
    document.json["materials"].push_back(
        {{"name", "floor"},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {shortest(color[0]), shortest(color[1]), shortest(color[2]), 1}},
           {"metallicFactor", 0},
           {"roughnessFactor", 0.9}}}});
    document.json["meshes"].push_back(
        {{"name", "floor"},
         {"primitives",
          {{{"attributes", {{"POSITION", positions}}},
            {"indices", document.add(std::span(indices), short_type, "SCALAR", indices.size(), element_buffer)},
            {"material", document.json["materials"].size() - 1}}}}});
    add({{"name", "floor"}, {"mesh", document.json["meshes"].size() - 1}});
  }
  if (stage.camera) {
    const StageCamera& camera = *stage.camera;
    const auto [x, y, z, w] = camera.quaternion();
    document.json["cameras"] = {{{"name", "camera"},
                                 {"type", "perspective"},
                                 {"perspective",
                                  {{"yfov", shortest(camera.field_of_view)},
                                   {"aspectRatio", shortest(camera.aspect)},
                                   {"znear", shortest(camera.near)},
                                   {"zfar", shortest(camera.far)}}}}};
    add({{"name", "camera"},
         {"camera", 0},
         {"rotation", {shortest(x), shortest(y), shortest(z), shortest(w)}},
         {"translation", {shortest(camera.eye.x), shortest(camera.eye.y), shortest(camera.eye.z)}}});
  }
}

// Of a robot at its place.
void extend(render::Bounds& reach, const std::vector<Vec3>& vertices, const render::Vector3& offset) {
  for (const Vec3& vertex : vertices) reach.extend(render::Vector3(vertex) + offset);
}

std::size_t bytes_of(std::size_t frames, std::size_t vertices) {
  return frames * vertices * sizeof(Vec3) + frames * (frames - 1) * sizeof(float);
}

bool fits(std::size_t frames, std::size_t vertices) {
  return frames <= most_targets + 1 && bytes_of(frames, vertices) <= largest_glb;
}

void require_short(const RecordedMotion& motion, std::size_t vertices, const std::filesystem::path& path) {
  const std::size_t frames = motion.frames();
  if (fits(frames, vertices)) return;
  std::size_t every = 2;
  while (!fits((frames - 1) / every + 1, vertices)) ++every;
  std::size_t first = frames;
  while (!fits(first, vertices)) first = std::min(first - 1, most_targets + 1);
  const std::size_t apart = motion.recorded_frame(frames > 1 ? 1 : 0) - motion.recorded_frame(0);
  throw InputError(
      path.string(),
      fmt::format("{} frames of {} vertices are too many for a .glb file, which web viewers hold in memory: "
                  "at most {} fit; give --every {}, or --to {:.4g}",
                  frames, vertices, first, every * apart, motion.time(first - 1) - motion.recording().time(0)));
}

// The weights of the last mesh, moved by the one animation.
void add_animation(Document& document, RecordedMotion& motion, std::size_t targets, std::size_t node) {
  const std::size_t frames = motion.frames();
  std::vector<float> times, weights(frames * targets, 0.0f);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    times.push_back(static_cast<float>(motion.time(frame) - motion.time(0)));
    if (frame > 0) weights[frame * targets + frame - 1] = 1;
  }
  const std::size_t input = document.add_floats(times), output = document.add_floats(weights);
  document.json["accessors"][input]["min"] = {shortest(times.front())};
  document.json["accessors"][input]["max"] = {shortest(times.back())};
  document.json["meshes"].back()["weights"] = std::vector<int>(targets, 0);
  if (!document.json.contains("animations"))
    document.json["animations"] = {
        {{"name", "motion"}, {"channels", ordered_json::array()}, {"samplers", ordered_json::array()}}};
  ordered_json& animation = document.json["animations"][0];
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", "weights"}}}});
  animation["samplers"].push_back({{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
}

}  // namespace

void write_glb(const ExportedRobot& robot, const Pose& pose, const std::filesystem::path& path,
               const ExportChoices& choices) {
  const SkinShape shape = skin_shape(robot.robot, choices.springs);
  Document document = empty_document();
  const std::vector<Vec3> vertices = vertices_of(shape, pose.positions);
  add_primitives(document, robot.robot.name, shape, add_vertices(document, shape, vertices), {});
  add_node(document, robot.robot.name, {});
  render::Bounds reach;
  extend(reach, vertices, {});
  add_stage(document, stage_of(reach, robot.environment, choices.stage));
  OutputStreams files;
  document.write(files.add(path));
  files.keep();
}

void write_glb_motions(std::span<RecordedMotion> motions, const std::filesystem::path& path,
                       const ExportChoices& choices) {
  std::vector<SkinShape> shapes;
  std::size_t vertices = 0, frames = 0, done = 0;
  for (RecordedMotion& motion : motions) {
    shapes.push_back(skin_shape(motion.robot().robot, choices.springs));
    vertices += (shapes.back().is_smooth ? 2 : 1) * shapes.back().masses.size();  // normals are as large
    frames += motion.frames();
  }
  const auto longest = std::ranges::max_element(motions, {}, &RecordedMotion::frames);
  require_short(*longest, vertices, path);
  const std::vector<render::Vector3> offsets = side_by_side(motions);
  Document document = empty_document();
  render::Bounds reach;
  for (std::size_t robot = 0; robot < motions.size(); ++robot) {
    RecordedMotion& motion = motions[robot];
    const SkinShape& shape = shapes[robot];
    const std::string name = motion.robot().robot.name;
    const std::vector<Vec3> first = vertices_of(shape, motion.pose(0).positions);
    const ordered_json attributes = add_vertices(document, shape, first);
    extend(reach, first, offsets[robot]);
    ordered_json targets = ordered_json::array();
    for (std::size_t frame = 1; frame < motion.frames(); ++frame) {
      const std::vector<Vec3> moved = vertices_of(shape, motion.pose(frame).positions);
      targets.push_back(add_target(document, shape, first, moved));
      extend(reach, moved, offsets[robot]);
      choices.watch(std::min(++done, frames), frames);
    }
    add_primitives(document, name, shape, attributes, targets);
    const std::size_t node = add_node(document, name, offsets[robot]);
    if (!targets.empty()) add_animation(document, motion, targets.size(), node);
  }
  add_stage(document, stage_of(reach, motions.front().robot().environment, choices.stage));
  OutputStreams files;
  document.write(files.add(path));
  files.keep();
}

void write_glb_motion(const ExportedRobot&, RecordedMotion& motion, const std::filesystem::path& path,
                      const ExportChoices& choices) {
  write_glb_motions(std::span(&motion, 1), path, choices);
}

}  // namespace mercury
