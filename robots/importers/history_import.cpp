// SPDX-License-Identifier: Apache-2.0
// Motions that voxcraft-sim recorded (.history): what its program prints (VX3_SimulationManager.cu), as voxcraft-viz
// plays it. A line per frame,
//
//   <<<Step42 Time:0.010265>>>x,y,z,angle,ax,ay,az,nx,ny,nz,px,py,pz,material,signal,;...<<<>>>
//
// with the voxels of the surface: place of the middle, rotation [degrees] around an axis, the corners at the low and
// the high end as seen from the middle, in the voxel's own axes. Lengths are multiples of the setting `rescale` [m].
//
// The voxels become bodies of voxels, whose masses are the corners: each is where the voxels that share it have it in
// the mean.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "mercury/error.h"
#include "robots/importers/calibration.h"
#include "robots/importers/report_builder.h"
#include "robots/importers/xml_document.h"

namespace mercury {
namespace {

using Vector = std::array<double, 3>;

struct HistoryVoxel {
  Vector middle{};                         // [m]
  std::array<double, 4> turn{1, 0, 0, 0};  // quaternion
  Vector low{}, high{};                    // corners, in the voxel's axes [m]
  int material = 0;
};

struct HistoryFrame {
  double time = 0;  // [s]
  std::vector<HistoryVoxel> voxels;
};

struct History {
  double unit = 1e-3, edge = 0;  // [m]
  std::vector<HistoryFrame> frames;
};

Vector rotated(const std::array<double, 4>& q, const Vector& v) {
  const auto [w, x, y, z] = q;
  const Vector t{2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])};
  return {v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
          v[2] + w * t[2] + x * t[1] - y * t[0]};
}

// The numbers of a voxel; false for a text that is none.
bool read_voxel(std::string_view text, double unit, HistoryVoxel& voxel) {
  std::array<double, 14> numbers{};
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < text.size() && count < numbers.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::optional<double> number = number_from(trimmed(text.substr(begin, end - begin)));
    if (!number) return false;
    numbers[count++] = *number;
    begin = end + 1;
  }
  if (count < numbers.size()) return false;
  const double angle = numbers[3] * std::numbers::pi / 180;
  const double length = std::hypot(numbers[4], numbers[5], numbers[6]);
  if (length > 0) {
    const double scale = std::sin(angle / 2) / length;
    voxel.turn = {std::cos(angle / 2), scale * numbers[4], scale * numbers[5], scale * numbers[6]};
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    voxel.middle[axis] = unit * numbers[axis];
    voxel.low[axis] = unit * numbers[7 + axis];
    voxel.high[axis] = unit * numbers[10 + axis];
  }
  voxel.material = static_cast<int>(std::clamp(numbers[13], 0.0, 250.0));
  return true;
}

// The number of an element such as <rescale>0.001</rescale>.
std::optional<double> setting_in(std::string_view line, std::string_view name) {
  const std::string open = fmt::format("<{}>", name);
  const std::size_t begin = line.find(open);
  if (begin == std::string_view::npos) return std::nullopt;
  const std::string_view rest = line.substr(begin + open.size());
  return number_from(trimmed(rest.substr(0, rest.find('<'))));
}

HistoryFrame frame_in(std::string_view line, std::size_t number, double unit, double before) {
  const auto refuse = [&](const char* problem) { throw InputError(fmt::format("line {}: {}", number, problem)); };
  const std::size_t head = line.find(">>>");
  if (head == std::string_view::npos) refuse("the frame breaks off");
  HistoryFrame frame;
  constexpr std::string_view time = "Time:";
  const std::size_t place = line.substr(0, head).find(time);
  const std::optional<double> value =
      place == std::string_view::npos
          ? std::nullopt
          : number_from(trimmed(line.substr(place + time.size(), head - place - time.size())));
  if (!value) refuse("the frame has no time");
  frame.time = *value;
  if (!(frame.time > before)) refuse("times do not rise");
  std::string_view voxels = line.substr(head + 3);
  voxels = voxels.substr(0, voxels.find("<<<"));
  for (std::size_t begin = 0; begin < voxels.size();) {
    const std::size_t end = std::min(voxels.find(';', begin), voxels.size());
    const std::string_view one = trimmed(voxels.substr(begin, end - begin));
    begin = end + 1;
    if (one.empty()) continue;
    if (!read_voxel(one, unit, frame.voxels.emplace_back())) refuse("a voxel is not 14 numbers");
  }
  return frame;
}

// A line that breaks off at the end of the file, as of a program that was stopped, is left out.
History read_history(std::string_view text) {
  History history;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = text.substr(begin, end - begin);
    const bool is_last = end == text.size();
    begin = end + 1;
    ++number;
    if (const auto unit = setting_in(line, "rescale"); unit && *unit > 0) history.unit = *unit;
    if (const auto edge = setting_in(line, "voxel_size"); edge && *edge > 0) history.edge = *edge;
    const std::size_t frame = line.find("<<<Step");
    if (frame == std::string_view::npos) continue;
    if (is_last && line.find("<<<>>>") == std::string_view::npos) break;
    const double before = history.frames.empty() ? -1 : history.frames.back().time;
    history.frames.push_back(frame_in(line.substr(frame), number, history.unit, before));
  }
  if (history.frames.empty() || history.frames.front().voxels.empty())
    throw InputError("holds no frame with voxels (<<<Step...>>>)");
  if (history.edge <= 0) throw InputError("does not say the size of its voxels (<voxel_size>)");
  return history;
}

class HistoryImport {
 public:
  HistoryImport(std::string_view text, std::string name, const ImportOptions& options)
      : history_(read_history(text)), name_(std::move(name)), options_(options) {
    scale_ = imported_edge / history_.edge;
    time_scale_ = gravity_time_scale(history_.edge);
  }

  Import run() {
    import_.report.format = "history of voxcraft-sim";
    import_.report.length_scale = scale_;
    import_.report.time_scale = time_scale_;
    import_.settings = {.environment = "land", .gravity = -9.81, .stiffness_scale = land_stiffness_scale};
    import_.motion.emplace();
    keep_frames_of_the_same_voxels();
    for (const VoxelBody& body : separate_bodies(lattice())) add(body);
    for (const HistoryFrame& frame : history_.frames) import_.motion->times.push_back(time_scale_ * frame.time);
    import_.report.decisive.emplace_back(
        "a motion to play, not a robot to simulate: the file says where voxels were, not what they are made of or what "
        "drove them");
    import_.report.elements.push_back(
        {"/frames", fmt::format("{}", history_.frames.size()), ImportOutcome::mapped, "frames of the recording"});
    import_.report.elements.push_back({"/voxels", fmt::format("{}", history_.frames.front().voxels.size()),
                                       ImportOutcome::approximated,
                                       "those of the surface; masses are their corners, in the mean where voxels share "
                                       "one"});
    import_.report.elements.push_back({"/voxels/material", fmt::format("{} materials", materials_.size()),
                                       ImportOutcome::approximated, "colors; all have the same made-up stiffness"});
    import_.report.elements.push_back(
        {"/voxels/signal", "", ImportOutcome::ignored, "electrical signals have no counterpart"});
    return std::move(import_);
  }

 private:
  // Only their order distinguishes voxels.
  void keep_frames_of_the_same_voxels() {
    const std::vector<HistoryVoxel>& first = history_.frames.front().voxels;
    const auto same = [&](const HistoryFrame& frame) {
      return std::ranges::equal(frame.voxels, first, {}, &HistoryVoxel::material, &HistoryVoxel::material);
    };
    const auto end = std::ranges::find_if_not(history_.frames, same);
    if (end == history_.frames.end()) return;
    import_.report.decisive.push_back(
        fmt::format("the motion ends at {:.4g} s of {:.4g} s of the file, where voxels come or go",
                    std::prev(end)->time, history_.frames.back().time));
    history_.frames.erase(end, history_.frames.end());
  }

  // Where the voxels are in the first frame. A cell is 1 + the number of its voxel.
  VoxelBody lattice() {
    const std::vector<HistoryVoxel>& voxels = history_.frames.front().voxels;
    std::array<long, 3> low{}, high{};
    std::vector<std::array<long, 3>> places;
    for (const HistoryVoxel& voxel : voxels) {
      std::array<long, 3> place{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double at = voxel.middle[axis] / history_.edge;
        if (!(std::abs(at) < 1e6)) throw InputError("a voxel is too far away");
        place[axis] = std::lround(at);
        low[axis] = places.empty() ? place[axis] : std::min(low[axis], place[axis]);
        high[axis] = places.empty() ? place[axis] : std::max(high[axis], place[axis]);
      }
      places.push_back(place);
      materials_.insert(voxel.material);
    }
    double cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) cells *= static_cast<double>(high[axis] - low[axis] + 1);
    if (cells > static_cast<double>(most_imported_cells)) throw InputError("the voxels reach too far");
    VoxelBody body{.nx = static_cast<int>(high[0] - low[0] + 1),
                   .ny = static_cast<int>(high[1] - low[1] + 1),
                   .nz = static_cast<int>(high[2] - low[2] + 1),
                   .cells = std::vector<std::uint32_t>(static_cast<std::size_t>(cells), 0),
                   .substances = {},
                   .names = {},
                   .held = {}};
    for (std::size_t i = 0; i < places.size(); ++i) {
      std::uint32_t& cell =
          body.cells[body.index(static_cast<int>(places[i][0] - low[0]), static_cast<int>(places[i][1] - low[1]),
                                static_cast<int>(places[i][2] - low[2]))];
      if (cell != 0) throw InputError("two voxels of the first frame are at one place");
      cell = static_cast<std::uint32_t>(i + 1);
    }
    return body;
  }

  void add(const VoxelBody& body) {
    const std::string own = import_.robots.empty() ? name_ : fmt::format("{}-{}", name_, import_.robots.size() + 1);
    Robot robot = bare_robot(body, own);
    const SpringVoxels lattice(robot, body);
    color(robot, body, lattice);
    // The voxels at each mass, and which of their corners it is.
    std::vector<std::vector<std::pair<std::size_t, int>>> voxels_at(robot.masses.size());
    for (std::size_t mass = 0; mass < robot.masses.size(); ++mass) {
      const auto [x, y, z] = lattice.corner(static_cast<std::uint16_t>(mass));
      for (int corner = 0; corner < 8; ++corner) {
        const int cx = x - (corner & 1), cy = y - (corner >> 1 & 1), cz = z - (corner >> 2);
        if (cx < 0 || cy < 0 || cz < 0 || cx >= body.nx || cy >= body.ny || cz >= body.nz) continue;
        if (const std::uint32_t cell = body.cells[body.index(cx, cy, cz)]; cell > 0)
          voxels_at[mass].emplace_back(cell - 1, corner);
      }
    }
    std::vector<std::vector<Vec3>>& positions = import_.motion->positions;
    positions.resize(history_.frames.size());
    for (std::size_t frame = 0; frame < positions.size(); ++frame)
      for (const auto& voxels : voxels_at) positions[frame].push_back(mean_corner(history_.frames[frame], voxels));
    // At rest where the motion begins.
    robot.masses.assign(positions[0].end() - static_cast<std::ptrdiff_t>(robot.masses.size()), positions[0].end());
    import_.report.robots.push_back(own);
    import_.robots.push_back(std::move(robot));
  }

  Vec3 mean_corner(const HistoryFrame& frame, const std::vector<std::pair<std::size_t, int>>& voxels) const {
    Vector sum{};
    for (const auto& [number, corner] : voxels) {
      const HistoryVoxel& voxel = frame.voxels[number];
      const Vector own{(corner & 1) != 0 ? voxel.high[0] : voxel.low[0],
                       (corner >> 1 & 1) != 0 ? voxel.high[1] : voxel.low[1],
                       (corner >> 2) != 0 ? voxel.high[2] : voxel.low[2]};
      const Vector turned = rotated(voxel.turn, own);
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += voxel.middle[axis] + turned[axis];
    }
    const double share = scale_ / static_cast<double>(voxels.size());
    constexpr double farthest = 1e6;  // [m]
    for (const double along : sum)
      if (!(std::abs(share * along) < farthest)) throw InputError("a voxel is too far away");
    // voxcraft-sim has the middles of the lowest voxels at half an edge, or at 0 with its floor half an edge lower.
    return {static_cast<float>(share * sum[0]), static_cast<float>(share * sum[1]),
            static_cast<float>(share * sum[2] + imported_edge / 2)};
  }

  // A material per material of the file. Their stiffnesses only distinguish them, by colors.
  void color(Robot& robot, const VoxelBody& body, const SpringVoxels& lattice) const {
    robot.materials.assign(1, Material{});
    robot.material_names.assign(1, "air");
    std::map<int, MaterialId> ids;
    for (const int material : materials_) {
      ids[material] = static_cast<MaterialId>(robot.materials.size());
      robot.materials.push_back({.stiffness = 50.0f + static_cast<float>(ids[material])});
      robot.material_names.push_back(fmt::format("material {}", material));
    }
    for (Spring& spring : robot.springs) {
      const std::uint32_t voxel = body.cells[lattice.of(spring).front()] - 1;
      spring.material = ids.at(history_.frames.front().voxels[voxel].material);
    }
  }

  History history_;
  std::string name_;
  ImportOptions options_;
  Import import_;
  double scale_ = 1, time_scale_ = 1;
  std::set<int> materials_;
};

}  // namespace

ImportFormat history_format() {
  return {.name = "history",
          .extensions = ".history",
          .programs = "VoxCAD, evosoro and voxcraft-sim",
          .read = [](std::string_view text, std::string_view, const std::string& name, const ImportOptions& options) {
            return HistoryImport(text, name, options).run();
          }};
}

}  // namespace mercury
