// SPDX-License-Identifier: Apache-2.0
// Worlds and robots of EvoGym (evogym/world.py): flat voxels in the plane of x and z, extruded along y.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <tuple>
#include <utility>

#include "mercury/error.h"
#include "robots/file/document.h"
#include "robots/importers/calibration.h"
#include "robots/importers/encodings.h"
#include "robots/importers/report_builder.h"

namespace mercury {
namespace {

using Json = nlohmann::json;
using enum ImportOutcome;

enum Type : std::uint32_t { empty, rigid, soft, horizontal, vertical, fixed, type_count };
constexpr std::array<std::string_view, type_count> type_names{
    "empty", "rigid", "soft", "horizontal actuator", "vertical actuator", "fixed"};

// Constants of EvoGym's simulator (ObjectCreator.h, PhysicsEngine.h), in its units: cells of 0.1 m, points of 1 kg.
constexpr double pull = 0.006;  // share of an edge's deviation that acts in a step (PhysicsEngine::update_actuators)
struct Stiffness {
  double edge, diagonal;  // [N/m]
};
constexpr double full = 3e8 * pull;
constexpr std::array<Stiffness, type_count> stiffnesses{{{0, 0},
                                                         {full / 3.5, full / 7},
                                                         {full / 6, full / 24},
                                                         {full / 5, full / 10},
                                                         {full / 5, full / 10},
                                                         {full / 3.5, full / 7}}};
constexpr double evogym_gravity = 110;  // [m/s2]
constexpr double evogym_drag = 0.1;     // viscous_drag [1/s]
constexpr double earth_gravity = 9.81;  // [m/s2]
// Of the ground (get_pos_vel_slope): 10 dynamic_friction_const, reached at speeds of some mm/s. static_friction_const
// is not used there.
constexpr double friction = 2;
// An edge has a new length at rest once per step of 1e-4 s, near the length that it has then. Within the step the edge
// resists what moves it from there: by k v dt / 2 in the mean, beside k pull times its deviation.
constexpr double relaxation_time = 1e-4 / 2 / pull;  // [s]
// Diagonals that leave the plane have no counterpart there, and every muscle would have to stretch them. So they are
// soft, but not so soft that robots fold sideways, as they do at 0.1.
constexpr double share_across = 0.3;

// Actuators go from 0.6 to 1.6 of their length there.
constexpr double actuator_amplitude = 0.4, actuator_frequency = 2 * std::numbers::pi;
constexpr std::size_t most_actuators = 200;

struct Object {
  std::string name;
  VoxelBody body;  // cells are types
  int x = 0, z = 0;
  std::array<std::size_t, type_count> count{};
  std::size_t gaps = 0;  // neighbors that are not connected
  bool is_robot() const { return count[horizontal] + count[vertical] > 0; }
  bool is_terrain() const {
    return count[fixed] > 0 && count[rigid] + count[soft] + count[horizontal] + count[vertical] == 0;
  }
};

class EvogymImport {
 public:
  EvogymImport(std::string_view text, std::string name, const ImportOptions& options)
      : EvogymImport(parsed(text), "world of EvoGym", std::move(name), options) {}

  EvogymImport(Json world, const char* format, std::string name, const ImportOptions& options)
      : name_(std::move(name)), options_(options), world_(std::move(world)) {
    time_ = std::sqrt(evogym_gravity / earth_gravity);
    import_.report.format = format;
  }

  Import run() {
    import_.report.time_scale = time_;
    import_.settings = {.environment = "land",
                        .gravity = -earth_gravity,
                        .stiffness_scale = land_stiffness_scale,
                        .friction = friction,
                        .damping = evogym_drag / time_};
    if (!world_.is_object()) throw InputError("/", "a world of EvoGym is a JSON object");
    width_ = size_in("grid_width");
    size_in("grid_height");
    if (!world_.contains("objects") || !world_["objects"].is_object())
      throw InputError("/objects", "a world of EvoGym has an object of objects");
    for (const auto& [key, value] : world_.items())
      if (key != "grid_width" && key != "grid_height" && key != "objects") add("/" + key, value, ignored, "unknown");
    for (const auto& [name, data] : world_["objects"].items()) take(read(name, data), data);
    add_notes();
    import_.settings.dt = stable_time_step(import_.robots, land_stiffness_scale);
    return std::move(import_);
  }

 private:
  static Json parsed(std::string_view text) {
    constexpr int deepest = 16;
    if (json_depth(text) > deepest) throw InputError(fmt::format("nested deeper than {} levels", deepest));
    try {
      return Json::parse(text);
    } catch (const Json::parse_error& error) {
      throw json_error(text, error.byte, error.id, error.what());
    } catch (const Json::out_of_range&) {
      throw InputError("a number is too large");
    }
  }

  void add(const std::string& place, const Json& value, ImportOutcome outcome, const std::string& reason) {
    std::string text = value.is_array()    ? fmt::format("{} values", value.size())
                       : value.is_object() ? fmt::format("{} members", value.size())
                                           : value.dump(-1, ' ', true, Json::error_handler_t::replace);
    constexpr std::size_t longest = 60;
    if (text.size() > longest) text = text.substr(0, longest) + "...";
    import_.report.elements.push_back({place, std::move(text), outcome, reason});
  }

  int size_in(const char* key) {
    const std::string place = fmt::format("/{}", key);
    if (!world_.contains(key)) throw InputError(place, "is missing; give the size of the world");
    const Json& value = world_[key];
    if (!value.is_number_integer() || value < 1 || value > 1'000'000)
      throw InputError(place, "give a whole number from 1 to 1000000");
    add(place, value, mapped, "places of the voxels");
    return value.get<int>();
  }

  static const Json& list_in(const Json& data, const char* key, const std::string& place) {
    if (!data.is_object() || !data.contains(key) || !data[key].is_array())
      throw InputError(place + "/" + key, "is missing; give a list of numbers");
    return data[key];
  }

  Object read(const std::string& name, const Json& data) {
    const std::string place = "/objects/" + name;
    const Json &indices = list_in(data, "indices", place), &types = list_in(data, "types", place);
    if (indices.empty()) throw InputError(place + "/indices", "the object has no voxels");
    if (indices.size() != types.size())
      throw InputError(place + "/types", fmt::format("has {} values, indices has {}", types.size(), indices.size()));
    std::map<std::int64_t, std::uint32_t> voxels;
    for (std::size_t i = 0; i < indices.size(); ++i) {
      const auto where = [&](const char* list) { return fmt::format("{}/{}/{}", place, list, i); };
      if (!indices[i].is_number_integer() || indices[i] < 0 || indices[i] > std::int64_t{1'000'000'000'000})
        throw InputError(where("indices"), "give a whole number of at least 0");
      if (!types[i].is_number_integer() || types[i] < 0 || types[i] >= static_cast<int>(type_count))
        throw InputError(where("types"), "is no type of voxel; give 0 (empty) to 5 (fixed)");
      if (!voxels.emplace(indices[i].get<std::int64_t>(), types[i].get<std::uint32_t>()).second)
        throw InputError(where("indices"), "the object has this voxel twice");
    }
    return object_of(name, place, voxels, data);
  }

  Object object_of(const std::string& name, const std::string& place,
                   const std::map<std::int64_t, std::uint32_t>& voxels, const Json& data) {
    std::int64_t left = width_, right = 0;
    for (const auto& [index, type] : voxels) {
      left = std::min(left, index % width_);
      right = std::max(right, index % width_);
    }
    const std::int64_t bottom = voxels.begin()->first / width_, top = voxels.rbegin()->first / width_;
    const double cells = static_cast<double>(right - left + 1) * static_cast<double>(top - bottom + 1) * options_.depth;
    if (cells > static_cast<double>(most_imported_cells))
      throw InputError(place, fmt::format("spans {:.3g} voxels; at most {} are accepted", cells, most_imported_cells));
    Object object{.name = name, .body = {}, .x = static_cast<int>(left), .z = static_cast<int>(bottom)};
    object.body.nx = static_cast<int>(right - left + 1);
    object.body.ny = options_.depth;
    object.body.nz = static_cast<int>(top - bottom + 1);
    object.body.cells.assign(static_cast<std::size_t>(cells), empty);
    for (const auto& [index, type] : voxels) {
      ++object.count[type];
      for (int y = 0; y < options_.depth; ++y)
        object.body.cells[object.body.index(static_cast<int>(index % width_ - left), y,
                                            static_cast<int>(index / width_ - bottom))] = type;
      if (type != empty && index % width_ != right && is_voxel(voxels, index + 1))
        object.gaps += is_connected(data, index, index + 1) ? 0 : 1;
      if (type != empty && is_voxel(voxels, index + width_))
        object.gaps += is_connected(data, index, index + width_) ? 0 : 1;
    }
    return object;
  }

  static bool is_voxel(const std::map<std::int64_t, std::uint32_t>& voxels, std::int64_t index) {
    const auto found = voxels.find(index);
    return found != voxels.end() && found->second != empty;
  }

  // Whether either names the other as its neighbor. Without the list all are connected.
  static bool is_connected(const Json& data, std::int64_t a, std::int64_t b) {
    const auto neighbors = data.find("neighbors");
    if (neighbors == data.end() || !neighbors->is_object()) return true;
    const auto names = [&](std::int64_t from, std::int64_t to) {
      const auto list = neighbors->find(std::to_string(from));
      return list != neighbors->end() && list->is_array() && std::ranges::find(*list, Json(to)) != list->end();
    };
    return names(a, b) || names(b, a);
  }

  void take(Object object, const Json& data) {
    const std::string place = "/objects/" + object.name;
    const auto voxels = std::ranges::count_if(object.body.cells, [](std::uint32_t type) { return type != empty; });
    ImportOutcome outcome = mapped;
    std::string became;
    if (voxels == 0) {
      outcome = ignored;
      became = "has no voxel that is not empty";
    } else if (object.is_terrain()) {
      outcome = ignored;
      became = "fixed terrain: the floor of Mercury is flat, and nothing else stands on it";
    } else {
      const std::size_t before = import_.robots.size();
      try {
        make(object);
      } catch (const InputError& error) {
        throw InputError(place, error.what());
      }
      became = before + 1 == import_.robots.size() ? "robot " + import_.report.robots.back()
                                                   : fmt::format("{} robots", import_.robots.size() - before);
    }
    add(place + "/indices", data["indices"], outcome, outcome == ignored ? became : became + ": its grid");
    add(place + "/types", data["types"], outcome,
        outcome == ignored ? became : fmt::format("{}: {}", became, types_text(object)));
    for (const auto& [key, value] : data.items()) {
      if (key == "neighbors")
        add(place + "/neighbors", value,
            outcome == ignored ? ignored
            : object.gaps > 0  ? approximated
                               : mapped,
            outcome == ignored ? became
            : object.gaps > 0  ? fmt::format("{} pairs of neighbors that are apart there are joined here", object.gaps)
                               : "all neighbors are joined");
      else if (key != "indices" && key != "types")
        add(place + "/" + key, value, ignored, "unknown");
    }
  }

  static std::string types_text(const Object& object) {
    std::string text;
    for (std::size_t type = rigid; type < type_count; ++type)
      if (object.count[type] > 0)
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", object.count[type], type_names[type]);
    if (object.count[fixed] > 0) text += " (their masses are fixed)";
    return text;
  }

  std::string robot_name(const Object& object) {
    std::string name = object.is_robot() && robots_ == 0 ? name_ : name_ + "-" + object.name;
    robots_ += object.is_robot() ? 1 : 0;
    while (!names_.insert(name).second) name += "-";
    return name;
  }

  double spring(double there) const { return there / (time_ * time_) / land_stiffness_scale; }

  Provenance provenance() const {
    return {.file = name_,
            .format = import_.report.format,
            .length_scale = 1,
            .time_scale = time_,
            .environment = import_.settings.environment};
  }

  void make(Object& object) {
    const std::string name = robot_name(object);
    object.body.names.assign(type_names.begin() + 1, type_names.end());
    for (std::size_t type = rigid; type < type_count; ++type)
      object.body.substances.push_back({.stiffness = spring(stiffnesses[type].edge)});
    if (object.count[fixed] > 0) {
      for (const std::uint32_t cell : object.body.cells) object.body.held.push_back(cell == fixed);
      import_.report.decisive.push_back(
          fmt::format("{}: held in its place, by fixed masses: {} voxels", name, object.count[fixed]));
    }
    if (!object.is_robot()) {
      for (std::uint32_t& cell : object.body.cells) cell = cell == fixed ? std::uint32_t{rigid} : cell;
      const std::size_t before = import_.robots.size();
      add_bodies(object.body, name, provenance(), options_, import_);
      for (std::size_t i = before; i < import_.robots.size(); ++i)
        for (std::size_t id = 1; id < import_.robots[i].materials.size(); ++id)
          import_.robots[i].materials[id].relaxation_time = static_cast<float>(relaxation_time * time_);
      return;
    }
    const std::vector<VoxelBody> bodies = separate_bodies(object.body);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const std::string own = i == 0 ? name : fmt::format("{}-{}", name, i + 1);
      import_.robots.push_back(robot_of(bodies[i], own));
      fix_masses(import_.robots.back(), bodies[i]);
      import_.report.robots.push_back(own);
    }
  }

  // Which voxels of a spring are actuators along it; the direction is that of a corner to the next.
  static bool acts_along(std::uint32_t type, const std::array<int, 3>& direction) {
    if (direction[1] != 0 || (direction[0] != 0) == (direction[2] != 0)) return false;
    return type == (direction[0] != 0 ? horizontal : vertical);
  }

  // Springs along the axis of an actuator are muscles of their own; all others do not move. A spring that two actuators
  // share is two springs, each half as stiff: their forces add up to that of one spring with the mean of both lengths,
  // as in EvoGym. Passive springs of an actuator's voxel alone have its name, and so its color, as long as the table
  // has room for them.
  Robot robot_of(const VoxelBody& body, const std::string& name) {
    try {
      return robot_of(body, name, true);
    } catch (const TooManyMaterials&) {
      return robot_of(body, name, false);
    }
  }

  struct TooManyMaterials : InputError {
    using InputError::InputError;
  };

  Robot robot_of(const VoxelBody& body, const std::string& name, bool named_passive) {
    Robot robot = bare_robot(body, name);
    const SpringVoxels voxels(robot, body);
    std::map<std::size_t, std::size_t> actuators;  // by cell without its place along y: index in robot.actuators
    // By actuator + 1 (0 = none), whether it moves, stiffness.
    std::map<std::tuple<std::size_t, bool, float>, MaterialId> materials;
    robot.materials.assign(1, Material{});
    robot.material_names.assign(1, "air");
    for (std::size_t cell = 0; cell < body.cells.size(); ++cell)
      if (body.cells[cell] == horizontal || body.cells[cell] == vertical) actuators.try_emplace(flat(body, cell), 0);
    if (actuators.size() > most_actuators)
      throw InputError(
          fmt::format("{} has {} actuators; at most {} are accepted", name, actuators.size(), most_actuators));
    for (auto& [cell, number] : actuators) {
      const auto nx = static_cast<std::size_t>(body.nx);
      number = robot.actuators.size();
      const std::uint32_t type = body.cells[body.index(static_cast<int>(cell % nx), 0, static_cast<int>(cell / nx))];
      robot.actuators.push_back(
          {fmt::format("{} {},{}", type == horizontal ? "horizontal" : "vertical", cell % nx, cell / nx), {}});
    }
    const auto material_of = [&](std::size_t actuator, bool moves, double stiffness) {
      const auto own = static_cast<float>(spring(stiffness));
      const auto [known, is_new] = materials.try_emplace({actuator, moves, own}, MaterialId{0});
      if (is_new) {
        if (robot.materials.size() == max_materials)
          throw TooManyMaterials(fmt::format("{} needs more than 255 materials", name));
        known->second = static_cast<MaterialId>(robot.materials.size());
        robot.materials.push_back(moves ? muscle(own, body, actuators, actuator - 1) : Material{.stiffness = own});
        robot.materials.back().relaxation_time = static_cast<float>(relaxation_time * time_);
        robot.material_names.push_back(actuator == 0 ? "passive" : robot.actuators[actuator - 1].name);
        if (moves) robot.actuators[actuator - 1].materials.push_back(known->second);
      }
      return known->second;
    };
    std::vector<Spring> springs;
    for (Spring one : robot.springs) {
      const std::array<int, 3> direction = voxels.direction(one);
      const bool is_edge = direction[1] == 0 && (direction[0] == 0 || direction[2] == 0);
      const std::vector<std::size_t> shared = voxels.of(one);
      double stiffness = 0;
      std::set<std::size_t> moving;
      for (const std::size_t cell : shared) {
        const std::uint32_t type = body.cells[cell];
        stiffness +=
            (is_edge ? stiffnesses[type].edge : stiffnesses[type].diagonal) / static_cast<double>(shared.size());
        if (acts_along(type, direction)) moving.insert(actuators.at(flat(body, cell)) + 1);
      }
      if (direction[1] != 0 && (direction[0] != 0 || direction[2] != 0)) stiffness *= share_across;
      if (moving.empty()) {
        const bool is_named = named_passive && is_of_one_actuator(body, shared);
        one.material = material_of(is_named ? actuators.at(flat(body, shared[0])) + 1 : 0, false, stiffness);
        springs.push_back(one);
      }
      for (const std::size_t actuator : moving) {
        one.material = material_of(actuator, true, stiffness / static_cast<double>(moving.size()));
        springs.push_back(one);
      }
    }
    robot.springs = std::move(springs);
    std::erase_if(robot.actuators, [](const Actuator& actuator) { return actuator.materials.empty(); });
    robot.origin = import_origin(body, provenance());
    return robot;
  }

  static bool is_of_one_actuator(const VoxelBody& body, const std::vector<std::size_t>& voxels) {
    return std::ranges::all_of(voxels, [&](std::size_t cell) {
      const std::uint32_t type = body.cells[cell];
      return (type == horizontal || type == vertical) && flat(body, cell) == flat(body, voxels[0]);
    });
  }

  static std::size_t flat(const VoxelBody& body, std::size_t cell) {
    const auto nx = static_cast<std::size_t>(body.nx), ny = static_cast<std::size_t>(body.ny);
    return cell % nx + nx * (cell / nx / ny);
  }

  // A wave along x, one length of the robot long.
  static Material muscle(float stiffness, const VoxelBody& body, const std::map<std::size_t, std::size_t>& actuators,
                         std::size_t number) {
    const auto cell = std::ranges::find(actuators, number, &std::pair<const std::size_t, std::size_t>::second)->first;
    const double place = static_cast<double>(cell % static_cast<std::size_t>(body.nx)) / body.nx;
    return {.stiffness = stiffness,
            .amplitude = static_cast<float>(actuator_amplitude),
            .frequency = static_cast<float>(actuator_frequency),
            .phase = static_cast<float>(2 * std::numbers::pi * place)};
  }

  void add_notes() {
    std::vector<std::string>& notes = import_.report.notes;
    if (import_.robots.empty()) {
      notes.push_back("no robot and no movable object: the world is terrain alone");
      return;
    }
    import_.report.decisive.push_back(
        fmt::format("assumed: gravity ({} m/s2 there), a flat floor, stiffness, drag and friction, which are constants "
                    "of EvoGym's program, in no file",
                    evogym_gravity));
    notes.push_back(fmt::format("the world is flat: robots are {} voxel{} thick and can tip over (--depth)",
                                options_.depth, options_.depth == 1 ? "" : "s"));
    if (std::ranges::any_of(import_.robots, [](const Robot& robot) { return !robot.actuators.empty(); }))
      notes.push_back(
          fmt::format("controllers are programs there: actuators have the names of their voxels, lengths "
                      "between {} and {} of that at rest, and a sine by default, a wave along x",
                      1 - actuator_amplitude, 1 + actuator_amplitude));
  }

  std::string name_;
  ImportOptions options_;
  Json world_;
  Import import_;
  std::int64_t width_ = 1;
  double time_ = 1;
  int robots_ = 0;
  std::set<std::string> names_;
};

// What decides is in the beginning of the files that EvoGym writes.
bool looks_like_evogym(std::string_view text) {
  const auto has = [&](std::string_view word) { return text.find(word) != std::string_view::npos; };
  return !has("mercury-robot") && (has("\"grid_width\"") || (has("\"objects\"") && has("\"indices\"")));
}

// A body as EvoGym's examples save it: an array of types, the upper row first, and pairs of connected voxels, which
// count through the rows (World.from_array). Both become an object of a world that just holds it.
Import import_body(std::string_view text, std::string_view, const std::string& name, const ImportOptions& options) {
  const std::vector<NumpyArray> arrays = numpy_arrays(text);
  if (arrays.empty() || arrays[0].shape.size() != 2 || arrays[0].values.empty())
    throw InputError(arrays.empty() ? "/" : "/" + arrays[0].name, "a body of EvoGym is a table of types of voxels");
  const NumpyArray& body = arrays[0];
  const auto rows = static_cast<std::int64_t>(body.shape[0]), columns = static_cast<std::int64_t>(body.shape[1]);
  const auto upright = [&](double voxel) {
    const auto index = static_cast<std::int64_t>(voxel);
    return (rows - 1 - index / columns) * columns + index % columns;
  };
  Json indices = Json::array(), types = Json::array(), neighbors = Json::object();
  for (std::size_t i = 0; i < body.values.size(); ++i) {
    const double type = body.values[i];
    if (!(type >= 0 && type < static_cast<double>(type_count)) || type != std::floor(type))
      throw InputError(fmt::format("/{}/{}", body.name, i), "is no type of voxel; give 0 (empty) to 5 (fixed)");
    if (type == 0) continue;
    indices.push_back(upright(static_cast<double>(i)));
    types.push_back(static_cast<int>(type));
  }
  if (indices.empty()) throw InputError("/" + body.name, "the body has no voxels");
  Json object{{"indices", std::move(indices)}, {"types", std::move(types)}};
  if (arrays.size() > 1) {
    const NumpyArray& pairs = arrays[1];
    const std::size_t count = pairs.shape.size() == 2 && pairs.shape[0] == 2 ? pairs.shape[1] : 0;
    if (pairs.values.size() != 2 * count) throw InputError("/" + pairs.name, "pairs of voxels are a table of two rows");
    for (std::size_t i = 0; i < count; ++i) {
      const double a = pairs.values[i], b = pairs.values[count + i], end = static_cast<double>(body.values.size());
      if (!(a >= 0 && a < end && b >= 0 && b < end))
        throw InputError(fmt::format("/{}/{}", pairs.name, i), "names a voxel that the body does not have");
      neighbors[std::to_string(upright(a))].push_back(upright(b));
    }
    object["neighbors"] = std::move(neighbors);
  }
  Json world{{"grid_width", columns}, {"grid_height", rows}, {"objects", {{"robot", std::move(object)}}}};
  Import import = EvogymImport(std::move(world), "body of EvoGym", name, options).run();
  // Elements of the file instead of those of the world that was made of it.
  std::vector<ImportedElement> elements;
  for (ImportedElement& element : import.report.elements) {
    const bool is_body = element.place.ends_with("/types"), is_pairs = element.place.ends_with("/neighbors");
    if (!is_body && !is_pairs) continue;
    const NumpyArray& array = arrays[is_body ? 0 : 1];
    elements.push_back(
        {"/" + array.name, fmt::format("{} values", array.values.size()), element.outcome, element.reason});
  }
  for (std::size_t i = 2; i < arrays.size(); ++i)
    elements.push_back({"/" + arrays[i].name, fmt::format("{} values", arrays[i].values.size()), ignored, "unknown"});
  import.report.elements = std::move(elements);
  return import;
}

// Archives begin with "PK"; those of NumPy name an array first.
bool looks_like_arrays(std::string_view text) {
  return text.starts_with("PK") && text.substr(0, 200).find(".npy") != std::string_view::npos;
}

}  // namespace

ImportFormat evogym_body_format() {
  return {
      .name = "npz", .extensions = ".npz", .programs = "EvoGym", .recognizes = looks_like_arrays, .read = import_body};
}

ImportFormat evogym_format() {
  return {.name = "evogym",
          .extensions = ".json",
          .programs = "EvoGym",
          .recognizes = looks_like_evogym,
          .read = [](std::string_view text, std::string_view, const std::string& name, const ImportOptions& options) {
            return EvogymImport(text, name, options).run();
          }};
}

}  // namespace mercury
