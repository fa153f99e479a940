// SPDX-License-Identifier: Apache-2.0
// A web page that plays robots: one file, which needs no network. Its parts are in app/export/page and, as far as the
// program draws with them too, in shaders/.
//
// The page has a description of its robots as JSON, and the numbers of each robot as text (page_numbers.h), which the
// browser unpacks when the robot is shown: positions rounded to `step`, the skin, and the springs for strains.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "app/base/version.h"
#include "app/export/page_numbers.h"
#include "app/export/writers.h"
#include "app/recording/configuration_json.h"
#include "app/scene/board.h"
#include "app/scene/camera_controller.h"
#include "app/scene/group_look.h"
#include "app/scene/robot_shape.h"
#include "mercury/error.h"
#include "mercury/fnv.h"
#include "mercury/names.h"
#include "mercury/number_text.h"
#include "mercury/observables.h"
#include "render/context/shader_source.h"
#include "render/style.h"

namespace mercury {
namespace {

using nlohmann::ordered_json;

constexpr double page_rate = 30;         // frames per second that are enough: the page interpolates between them
constexpr float largest_step = 5e-4f;    // of positions; the error is at most half of it [m]
constexpr float steps_per_spring = 100;  // small robots are rounded less: at least as many steps per typical spring
constexpr float finer_rest_lengths = 8;  // in the same step, strains would be off by some tenths of a percent
constexpr int colors_of_map = 48;
constexpr double most_coordinates = 150e6;  // of all frames; as many bytes at most

std::string hex(render::Color color) { return fmt::format("#{:02x}{:02x}{:02x}", color.r, color.g, color.b); }

ordered_json numbers(const render::Vector3& v) { return {shortest(v.x), shortest(v.y), shortest(v.z)}; }

ordered_json json_of(const render::Style& style) {
  return {{"to_key", numbers(style.to_key)},
          {"key_light", numbers(style.key_light)},
          {"sky_light", numbers(style.sky_light)},
          {"ground_light", numbers(style.ground_light)},
          {"key_size", shortest(style.key_size)},
          {"backdrop_high", numbers(style.backdrop_high)},
          {"backdrop_low", numbers(style.backdrop_low)},
          {"floor_color", numbers(style.floor_color)},
          {"line_color", numbers(style.line_color)},
          {"fog", numbers(style.fog)},
          {"caustics", shortest(style.caustics)},
          {"glow", shortest(style.glow)},
          {"vignette", shortest(style.vignette)}};
}

ordered_json styles_of(render::Surroundings surroundings) {
  ordered_json styles;
  for (const auto& [name, theme] : {std::pair{"dark", render::Theme::dark}, {"light", render::Theme::light}})
    styles[name] = {{"plain", json_of(render::style_of(surroundings, theme))},
                    {"values", json_of(render::style_of(surroundings, theme, true))}};
  return styles;
}

// Frames at equal distances in time: those of the recording, or fewer between which it is interpolated.
class EvenFrames {
 public:
  explicit EvenFrames(RecordedMotion& motion) : motion_(motion) {
    const double recorded_rate = motion.frame_rate();
    thinned_ = recorded_rate > 1.15 * page_rate;
    rate_ = thinned_ ? page_rate : recorded_rate > 0 ? recorded_rate : page_rate;
    const double length = motion.time(motion.frames() - 1) - motion.time(0);
    count_ = thinned_ ? static_cast<std::size_t>(length * rate_ + 1e-6) + 1 : motion.frames();
  }
  double rate() const { return rate_; }  // [1/s]
  std::size_t count() const { return count_; }

  // Call it for rising frames.
  std::vector<Vec3> positions(std::size_t frame) {
    if (!thinned_) return copy_of(frame);
    const double time = motion_.time(0) + static_cast<double>(frame) / rate_;
    while (at_ + 2 < motion_.frames() && motion_.time(at_ + 1) <= time) ++at_;
    std::vector<Vec3> before = copy_of(at_);
    const std::vector<Vec3> after = copy_of(std::min(at_ + 1, motion_.frames() - 1));
    const double span = motion_.time(std::min(at_ + 1, motion_.frames() - 1)) - motion_.time(at_);
    const auto share = static_cast<float>(span > 0 ? std::clamp((time - motion_.time(at_)) / span, 0.0, 1.0) : 0);
    for (std::size_t i = 0; i < before.size(); ++i) before[i] = before[i] + share * (after[i] - before[i]);
    return before;
  }

 private:
  std::vector<Vec3> copy_of(std::size_t frame) {
    const auto positions = motion_.pose(frame).positions;
    return {positions.begin(), positions.end()};
  }

  RecordedMotion& motion_;
  bool thinned_ = false;
  double rate_ = page_rate;
  std::size_t count_ = 0, at_ = 0;
};

std::int32_t rounded(float value, float step) {
  const float steps = std::round(value / step);
  if (!(std::abs(steps) < 1e9f))
    throw InputError("html", "holds no positions this far away; export a part of the motion");
  return static_cast<std::int32_t>(steps);
}

// The masses that a skin or springs have; others are not seen.
std::vector<std::int32_t> page_masses(const Robot& robot, std::size_t& count) {
  std::vector<std::int32_t> index(robot.masses.size(), -1);
  for (const Face& face : robot.faces) index[face.a] = index[face.b] = index[face.c] = 0;
  for (const Spring& spring : robot.springs) index[spring.a] = index[spring.b] = 0;
  std::int32_t next = 0;
  for (std::int32_t& i : index)
    if (i == 0) i = next++;
  count = static_cast<std::size_t>(next);
  return index;
}

struct PageRobot {
  ordered_json description;
  std::string data;  // packed numbers
};

// One robot and its motion.
class PageRobotWriter {
 public:
  PageRobotWriter(RecordedMotion& motion, const ExportChoices& choices)
      : motion_(motion), exported_(motion.robot()), robot_(exported_.robot), choices_(choices),
        shape_(shape_of(robot_)), index_(page_masses(robot_, masses_)), step_(step_of(shape_->body->lengths)) {}

  // `caption`: lines below the name; empty = the distance. `done` of `total` frames are written before.
  PageRobot write(const std::vector<std::string>& caption, const std::string& final_state, std::size_t& done,
                  std::size_t total) {
    EvenFrames frames(motion_);
    add_positions(frames, done, total);
    add_skin();
    add_springs();
    const std::string distance = distance_text(frames);
    ordered_json facts = {{"masses, springs, faces",
                           fmt::format("{}, {}, {}", robot_.masses.size(), robot_.springs.size(), robot_.faces.size())},
                          {"distance", distance},
                          {"positions", fmt::format("rounded to {:.3g} mm", 500 * step_)},
                          {"final state", final_state.empty() ? hash_text() : final_state}};
    ordered_json pairs = ordered_json::array();
    for (const auto& [name, text] : facts.items()) pairs.push_back({name, text});
    return {{{"name", robot_.name},
             {"caption", caption.empty() ? std::vector{distance} : caption},
             {"facts", pairs},
             {"smooth", shape_->smooth},
             {"step", shortest(step_)},
             {"rest_step", shortest(step_ / finer_rest_lengths)},
             {"start", motion_.time(0)},
             {"rate", frames.rate()},
             {"frames", frames.count()},
             {"masses", masses_},
             {"largest_amplitude", largest_amplitude()},
             {"materials", materials_},
             {"legend", legend()},
             {"tables", numbers_.descriptions()}},
            numbers_.packed()};
  }

 private:
  static float step_of(std::vector<float> lengths) {
    if (lengths.empty()) return largest_step;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::ranges::nth_element(lengths, middle);
    // At least as fine as asked for, and a round number in the page.
    const float step = std::min(largest_step, *middle / steps_per_spring);
    return step == largest_step ? step : std::exp2(std::floor(std::log2(std::max(step, 1e-9f))));
  }

  void add_positions(EvenFrames& frames, std::size_t& done, std::size_t total) {
    std::vector<std::int32_t> values;
    values.reserve(frames.count() * masses_ * 3);
    for (std::size_t frame = 0; frame < frames.count(); ++frame) {
      const std::vector<Vec3> positions = frames.positions(frame);
      if (frame == 0) first_center_ = mean_over_masses(robot_, positions);
      if (frame + 1 == frames.count()) last_center_ = mean_over_masses(robot_, positions);
      for (std::size_t mass = 0; mass < positions.size(); ++mass) {
        if (index_[mass] < 0) continue;
        const Vec3 p = positions[mass];
        for (const float x : {p.x, p.y, p.z}) values.push_back(rounded(x, step_));
      }
      choices_.watch(std::min(++done, total), total);
    }
    numbers_.add("positions", values, 3 * masses_, 2);
  }

  // How far the center of mass got, on ground along it.
  std::string distance_text(const EvenFrames& frames) const {
    const double up = has_ground(exported_.environment) ? 0 : last_center_[2] - first_center_[2];
    const double distance = std::hypot(last_center_[0] - first_center_[0], last_center_[1] - first_center_[1], up);
    return fmt::format("{:.3g} m in {:.3g} s", distance, static_cast<double>(frames.count() - 1) / frames.rate());
  }

  void add_skin() {
    std::array<std::int32_t, max_materials> place{};
    for (const ExportedMaterial& material : exported_materials(robot_)) {
      place[material.id] = static_cast<std::int32_t>(materials_.size());
      const auto [r, g, b] = render::linear_of(material.color);
      const Material& muscle = exported_.materials[material.id];
      materials_.push_back({{"name", material.name},
                            {"css", hex(material.color)},
                            {"color", {shortest(r), shortest(g), shortest(b)}},
                            {"amplitude", shortest(muscle.amplitude)},
                            {"frequency", shortest(muscle.frequency)},
                            {"phase", shortest(muscle.phase)},
                            {"half_wave", muscle.half_wave}});
    }
    std::vector<std::int32_t> corners, neighbors, bits;
    const render::PreparedBody& body = *shape_->body;
    for (std::size_t face = 0; face < body.records.size(); ++face) {
      const render::FaceRecord& record = body.records[face];
      for (std::size_t corner = 0; corner < 3; ++corner) corners.push_back(index_[body.faces[3 * face + corner]]);
      for (const std::uint32_t neighbor : record.neighbors)
        neighbors.push_back(
            neighbor == render::no_face ? 0 : static_cast<std::int32_t>(neighbor) - static_cast<std::int32_t>(face));
      bits.push_back(static_cast<std::int32_t>(record.shape) | place[record.material] << 2);
    }
    numbers_.add("faces", corners, 3, 1);
    numbers_.add("neighbors", neighbors, 4, 0);
    numbers_.add("face_bits", bits, 1, 0);
  }

  void add_springs() {
    std::vector<std::int32_t> springs;
    for (const Spring& spring : robot_.springs)
      springs.insert(springs.end(), {index_[spring.a], index_[spring.b],
                                     std::max(1, rounded(spring.rest_length, step_ / finer_rest_lengths))});
    numbers_.add("springs", springs, 3, 1);
  }

  double largest_amplitude() const {
    float largest = 0;
    for (const Material& material : exported_.materials) largest = std::max(largest, std::abs(material.amplitude));
    return shortest(largest);
  }

  ordered_json legend() const {
    const render::Legend legend = material_legend(std::array{&robot_}, std::array{shape_});
    ordered_json lines = ordered_json::array(), wheel = ordered_json::array();
    for (const auto& [color, name] : legend.swatches) lines.push_back({color.a > 0 ? hex(color) : "transparent", name});
    for (const render::Color color : legend.wheel) wheel.push_back(hex(color));
    return {{"swatches", lines}, {"wheel", wheel}};
  }

  // As Simulation::hash(): of positions and velocities at the last frame.
  std::string hash_text() {
    const std::size_t last = motion_.frames() - 1;
    const Pose pose = motion_.pose_with_velocities(last);
    Fnv1a hash;
    for (const Vec3 p : pose.positions) hash.add(p);
    for (const Vec3 v : pose.velocities) hash.add(v);
    return fmt::format("{:016x} at {:.6g} s", hash.value(), pose.time);
  }

  RecordedMotion& motion_;
  ExportedRobot exported_;
  const Robot& robot_;
  const ExportChoices& choices_;
  std::shared_ptr<const RobotShape> shape_;
  std::size_t masses_ = 0;
  std::vector<std::int32_t> index_;  // of each mass of the robot in the page; -1 = it has none
  float step_;
  std::array<double, 3> first_center_{}, last_center_{};  // of mass [m]
  PageNumbers numbers_;
  ordered_json materials_ = ordered_json::array();
};

std::string_view page_file(std::string_view name) {
  for (const EmbeddedFile& file : page_files())
    if (file.name == name) return file.contents;
  throw std::logic_error("no file of pages is named " + std::string(name));
}

// Without indentation, empty lines and lines of comments.
std::string compact(std::string_view source) {
  std::string text;
  for (std::size_t begin = 0; begin < source.size();) {
    const std::size_t end = std::min(source.find('\n', begin), source.size());
    std::string_view line = source.substr(begin, end - begin);
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    if (!line.empty() && !line.starts_with("//") && !line.starts_with("/*")) text.append(line).append("\n");
    begin = end + 1;
  }
  return text;
}

// The shaders of the page, and those of the program that they include or that the page draws with.
std::string shaders_json() {
  ordered_json shaders = ordered_json::object();
  for (const EmbeddedFile& file : page_files())
    if (const auto dot = file.name.rfind('.'); dot != std::string_view::npos)
      for (const std::string_view extension : {".glsl", ".vert", ".frag"})
        if (file.name.substr(dot) == extension) shaders[std::string(file.name)] = compact(file.contents);
  constexpr std::array of_program{
      "fullscreen.vert", "sand.frag",      "backdrop.frag",  "caustics.vert", "caustics.frag", "particle.frag",
      "frame.glsl",      "caustics.glsl",  "floor.glsl",     "shading.glsl",  "shadow.glsl",   "skin_light.glsl",
      "bevel.glsl",      "direction.glsl", "seen_face.glsl", "tone.glsl",     "ribbon.glsl",   "prints.glsl"};
  for (const render::ShaderSource& shader : render::shader_sources())
    if (std::ranges::find(of_program, shader.name) != of_program.end())
      shaders[std::string(shader.name)] = compact(shader.text);
  return shaders.dump();
}

// JSON that cannot end the element of the page that holds it.
std::string for_script(std::string json) {
  std::string text;
  for (const char letter : json)
    if (letter == '<')
      text += "\\u003c";
    else
      text += letter;
  return text;
}

std::string json_text(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string script() {
  std::string text;
  for (const std::string_view name : {"decoding.js", "camera.js", "bodies.js", "view.js", "chooser.js", "player.js"})
    text += compact(page_file(name));
  return text;
}

// The template with each {{name}} replaced by the part of that name.
void write_page(OutputStream& file, const std::vector<std::pair<std::string_view, std::string>>& parts) {
  const std::string_view page = page_file("page.html");
  for (std::size_t begin = 0; begin < page.size();) {
    const std::size_t open = std::min(page.find("{{", begin), page.size());
    file.text(page.substr(begin, open - begin));
    if (open == page.size()) return;
    const std::size_t close = page.find("}}", open);
    const std::string_view name = page.substr(open + 2, close - open - 2);
    const auto part = std::ranges::find(parts, name, &std::pair<std::string_view, std::string>::first);
    file.text(part->second);
    begin = close + 2;
  }
}

ordered_json facts_of(const TrajectoryReader& recording) {
  const Configuration& configuration = recording.configuration();
  ordered_json facts = ordered_json::array();
  const auto add = [&](const char* name, const std::string& text) { facts.push_back({name, text}); };
  add("environment", environment_text(configuration));
  add("solver", solver_text(configuration));
  if (recording.seed()) add("seed", std::to_string(*recording.seed()));
  add("computed by", fmt::format("{} on {}", recording.program(), recording.device_name()));
  return facts;
}

ordered_json json_of(const BoardAxis& axis) { return {{"title", axis.title}, {"ticks", axis.ticks}}; }

// A map of elites: per cell its color and its robot, row by row from the upper left.
ordered_json json_of(const Board& board) {
  const render::Scale& scale = *board.legend.scale;
  ordered_json cells = ordered_json::array();
  for (const std::optional<float>& value : board.values) {
    if (!value) {
      cells.push_back(nullptr);
      continue;
    }
    cells.push_back(
        {{"color", hex(render::color_at(scale.map, *value, scale.low, scale.high))}, {"value", shortest(*value)}});
  }
  for (std::size_t robot = 0; robot < board.cell_of.size(); ++robot) cells[board.cell_of[robot]]["robot"] = robot;
  ordered_json colors = ordered_json::array();
  for (int i = 0; i < 8; ++i) colors.push_back(hex(render::color_at(scale.map, static_cast<float>(i) / 7)));
  return {{"columns", board.grid.columns},
          {"rows", board.grid.rows},
          {"cells", cells},
          {"across", json_of(board.across)},
          {"upward", json_of(board.upward)},
          {"score",
           {{"title", board.legend.title},
            {"unit", board.legend.unit},
            {"low", shortest(scale.low)},
            {"high", shortest(scale.high)},
            {"colors", colors}}}};
}

// A row per individual: id, generation, score, robot or null, parents.
ordered_json json_of(const std::vector<ExportedIndividual>& family) {
  ordered_json members = ordered_json::array();
  for (const ExportedIndividual& member : family) {
    ordered_json row{member.id, member.generation, nullptr, nullptr, member.parents};
    if (std::isfinite(member.score)) row[2] = shortest(static_cast<float>(member.score));
    if (member.robot) row[3] = *member.robot;
    members.push_back(row);
  }
  return members;
}

std::string title_of(std::span<RecordedMotion> motions, const ExportNotes& notes) {
  if (!notes.title.empty()) return notes.title;
  std::string title;
  for (std::size_t i = 0; i < motions.size() && i < 4; ++i)
    title += (i > 0 ? ", " : "") + motions[i].robot().robot.name;
  if (motions.size() > 4) title += fmt::format(" and {} more", motions.size() - 4);
  return title;
}

}  // namespace

void write_html(std::span<RecordedMotion> motions, const std::filesystem::path& path, const ExportChoices& choices) {
  const TrajectoryReader& recording = motions.front().recording();
  const Environment& environment = recording.configuration().environment;
  const render::Surroundings surroundings = surroundings_of(environment);
  const bool land = surroundings == render::Surroundings::land;
  const render::Orbit view = direction_of({}, land);
  ordered_json colormap = ordered_json::array(), robots = ordered_json::array();
  for (int i = 0; i < colors_of_map; ++i)
    colormap.push_back(hex(render::color_at(render::Colormap::diverging, static_cast<float>(i) / (colors_of_map - 1))));
  std::size_t total = 0, done = 0;
  double coordinates = 0;
  for (RecordedMotion& motion : motions) {
    const std::size_t frames = EvenFrames(motion).count();
    total += frames;
    coordinates += 3.0 * static_cast<double>(frames) * static_cast<double>(motion.robot().robot.masses.size());
  }
  if (coordinates > most_coordinates)
    throw InputError(path.string(),
                     fmt::format("{:.3g} million coordinates are more than browsers take, {:.0f} million; export fewer "
                                 "robots, a part of the time, or fewer frames",
                                 coordinates / 1e6, most_coordinates / 1e6));
  std::string data;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const bool has_caption = i < choices.notes.captions.size();
    PageRobot robot =
        PageRobotWriter(motions[i], choices)
            .write(has_caption ? choices.notes.captions[i] : std::vector<std::string>(),
                   i < choices.notes.final_states.size() ? choices.notes.final_states[i] : "", done, total);
    robots.push_back(std::move(robot.description));
    data += fmt::format("<script type=\"text/plain\" id=\"robot-{}\">{}</script>\n", i, robot.data);
  }
  const std::string title = title_of(motions, choices.notes);
  const Vec3 flow = flow_of(environment);
  const ordered_json page{{"format", "mercury-page"},
                          {"version", 1},
                          {"title", title},
                          {"subtitle", choices.notes.subtitle},
                          {"command", choices.notes.command},
                          {"facts", facts_of(recording)},
                          {"surroundings", land ? "land" : "water"},
                          {"ground", has_ground(environment)},
                          {"flow", {shortest(flow.x), shortest(flow.y), shortest(flow.z)}},
                          {"view",
                           {{"azimuth", shortest(view.azimuth)},
                            {"elevation", shortest(view.elevation)},
                            {"field_of_view", shortest(view.field_of_view)}}},
                          {"styles", styles_of(surroundings)},
                          {"colormap", colormap},
                          {"robots", robots},
                          {"board", choices.notes.board ? json_of(*choices.notes.board) : ordered_json()},
                          {"family", json_of(choices.notes.family)}};
  OutputStreams files;
  write_page(files.add(path), {{"program", program_version},
                               {"title", markup_text(title)},
                               {"style", compact(page_file("page.css"))},
                               {"shaders", for_script(shaders_json())},
                               {"page", for_script(json_text(page))},
                               {"robots", data},
                               {"script", script()}});
  files.keep();
}

void write_html_motion(const ExportedRobot&, RecordedMotion& motion, const std::filesystem::path& path,
                       const ExportChoices& choices) {
  write_html(std::span(&motion, 1), path, choices);
}

}  // namespace mercury
