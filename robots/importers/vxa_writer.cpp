// SPDX-License-Identifier: Apache-2.0
// Voxel robots as VXA, in the form that VoxCAD, evosoro and voxcraft-sim read.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mercury/error.h"
#include "mercury/import.h"
#include "mercury/names.h"
#include "mercury/origin.h"
#include "mercury/real_body.h"
#include "robots/file/whole_file.h"
#include "robots/importers/calibration.h"
#include "robots/importers/encodings.h"
#include "robots/importers/report_builder.h"
#include "robots/importers/voxel_body.h"

namespace mercury {
namespace {

constexpr double density = 1000;        // one mass of 1 kg for each voxel of 0.1 m [kg/m3]
constexpr double temperature = 1;       // amplitude: CTE is the amplitude of the muscle [degrees]
constexpr double usual_drag = 500;      // AggregateDragCoefficient
constexpr std::size_t most_ascii = 78;  // up to "~"

// The grid with substances grouped by what a palette holds: stiffness and amplitude. Phase and period are layers.
struct Palette {
  std::vector<std::size_t> number_of_substance;  // from 1
  std::vector<std::size_t> substances;           // the first substance of each material
};

Palette palette_of(const VoxelBody& body) {
  Palette palette;
  const bool each_its_own = body.substances.size() <= base_material_count;
  for (std::size_t i = 0; i < body.substances.size(); ++i) {
    const auto same = [&](std::size_t other) {
      const Substance &a = body.substances[i], &b = body.substances[other];
      return !each_its_own && a.stiffness == b.stiffness && a.amplitude == b.amplitude &&
             body.names[i] == body.names[other];
    };
    auto known = std::ranges::find_if(palette.substances, same);
    if (known == palette.substances.end()) known = palette.substances.insert(known, i);
    palette.number_of_substance.push_back(static_cast<std::size_t>(known - palette.substances.begin()) + 1);
  }
  if (palette.substances.size() > 255)
    throw InputError("a palette has at most 255 materials, this robot needs " +
                     std::to_string(palette.substances.size()));
  return palette;
}

// A world in the terms of the format.
struct World {
  bool has_floor = false, in_fluid = false;
  bool self_collision = true;
  double gravity = 0;          // along z [m/s2]
  double friction = 0.8;       // of all materials
  double static_friction = 0;  // 0 = that of motion
  // C_N of one-sided water, times its density over 1000 kg/m3; none = usual_drag
  std::optional<double> normal_coefficient;
  double stiffness_scale = 1;
  double damping = 0;  // [1/s]
  std::optional<double> seconds, settle;
};

class VxaWriter {
 public:
  VxaWriter(const VoxelBody& body, const World& world, double relaxation_time, double mass)
      : body_(body), palette_(palette_of(body)), world_(world), scale_(world.stiffness_scale),
        relaxation_time_(relaxation_time), mass_(mass) {}

  std::string document() {
    text_ = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<VXA Version=\"1.1\">\n";
    write_world();
    text_ += "<VXC Version=\"0.94\">\n";
    text_ += fmt::format("<Lattice>\n<Lattice_Dim>{}</Lattice_Dim>\n</Lattice>\n", imported_edge);
    write_palette();
    write_structure();
    text_ += "</VXC>\n</VXA>\n";
    return std::move(text_);
  }

 private:
  bool moves(const Substance& substance) const { return substance.amplitude != 0; }

  // The period of the first muscle stands for all; others have theirs in a layer.
  double period() const {
    for (const Substance& substance : body_.substances)
      if (moves(substance) && substance.frequency != 0) return turn / substance.frequency;
    return 1;
  }

  double modulus(const Substance& substance) const { return substance.stiffness * scale_ / scaling_.stiffness(1); }

  // The inverse of what the importer makes of BondDampingZ.
  double bond_damping() const {
    if (relaxation_time_ == 0) return 0;
    double sum = 0;
    int voxels = 0;
    for (const std::uint32_t cell : body_.cells)
      if (cell != 0) {
        sum += std::sqrt(1 / modulus(body_.substances[cell - 1]));
        ++voxels;
      }
    return relaxation_time_ * voxels / (sum * imported_edge * std::sqrt(density) * scaling_.calibration.time_scale);
  }

  // What the importer makes of the damping.
  double slow_damping() const {
    if (world_.damping == 0) return 0;
    double stiffest = 0, sum = 0, voxels = 0;
    for (const std::uint32_t cell : body_.cells)
      if (cell != 0) stiffest = std::max(stiffest, modulus(body_.substances[cell - 1]));
    for (const std::uint32_t cell : body_.cells)
      if (cell != 0) {
        sum += std::sqrt(modulus(body_.substances[cell - 1]) / stiffest);
        ++voxels;
      }
    return world_.damping / Scaling(imported_edge, stiffest, density, world_.gravity).damping(1, sum / voxels);
  }

  // What the importer makes of the drag, for as many masses per voxel as the robot has.
  double aggregate_drag() const {
    const auto voxels =
        static_cast<double>(std::ranges::count_if(body_.cells, [](std::uint32_t cell) { return cell != 0; }));
    return *world_.normal_coefficient / 2 * density * voxels / mass_;
  }

  void write_world() {
    const bool half = std::ranges::any_of(body_.substances, &Substance::half_wave);
    text_ += fmt::format(
        "<Simulator>\n<Damping>\n<BondDampingZ>{:.17g}</BondDampingZ>\n<ColDampingZ>0.8</ColDampingZ>\n"
        "<SlowDampingZ>{:.17g}</SlowDampingZ>\n</Damping>\n<Collisions>\n<SelfColEnabled>{}</SelfColEnabled>\n"
        "</Collisions>\n",
        bond_damping(), slow_damping(), world_.self_collision ? 1 : 0);
    if (world_.seconds || world_.settle) text_ += "<StopCondition>\n";
    if (world_.seconds)
      text_ +=
          fmt::format("<StopConditionType>2</StopConditionType>\n<StopConditionValue>{:.17g}</StopConditionValue>\n",
                      *world_.seconds);
    if (world_.settle) text_ += fmt::format("<InitCmTime>{:.17g}</InitCmTime>\n", *world_.settle);
    if (world_.seconds || world_.settle) text_ += "</StopCondition>\n";
    // Only voxcraft-sim cuts waves off; it does so unless this forbids it.
    text_ += fmt::format("<EnableExpansion>{}</EnableExpansion>\n</Simulator>\n<Environment>\n", half ? 0 : 1);
    if (world_.in_fluid)
      text_ += fmt::format(
          "<FluidEnvironment>1</FluidEnvironment>\n<AggregateDragCoefficient>{:.17g}</AggregateDragCoefficient>\n",
          world_.normal_coefficient ? aggregate_drag() : usual_drag);
    text_ += fmt::format(
        "<Gravity>\n<GravEnabled>{}</GravEnabled>\n<GravAcc>{:.17g}</GravAcc>\n"
        "<FloorEnabled>{}</FloorEnabled>\n</Gravity>\n",
        world_.gravity != 0 ? 1 : 0, world_.gravity != 0 ? world_.gravity : -9.81, world_.has_floor ? 1 : 0);
    text_ += fmt::format(
        "<Thermal>\n<TempEnabled>1</TempEnabled>\n<TempAmplitude>{}</TempAmplitude>\n"
        "<TempBase>25</TempBase>\n<VaryTempEnabled>1</VaryTempEnabled>\n"
        "<TempPeriod>{:.17g}</TempPeriod>\n</Thermal>\n</Environment>\n",
        temperature, period());
  }

  void write_palette() {
    text_ += "<Palette>\n";
    for (std::size_t i = 0; i < palette_.substances.size(); ++i) {
      const Substance& substance = body_.substances[palette_.substances[i]];
      const double shade = static_cast<double>(i % 4) / 4;
      text_ += fmt::format(
          "<Material ID=\"{}\">\n<Name>{}</Name>\n<Display>\n<Red>{}</Red>\n<Green>{}</Green>\n"
          "<Blue>{}</Blue>\n<Alpha>1</Alpha>\n</Display>\n",
          i + 1, markup_text(body_.names[palette_.substances[i]]), moves(substance) ? 1 : 0, shade,
          moves(substance) ? 0 : 1);
      text_ += fmt::format(
          "<Mechanical>\n<MatModel>0</MatModel>\n<Elastic_Mod>{:.17g}</Elastic_Mod>\n"
          "<Density>{}</Density>\n<Poissons_Ratio>0.35</Poissons_Ratio>\n<CTE>{:.17g}</CTE>\n"
          "<uStatic>{}</uStatic>\n<uDynamic>{}</uDynamic>\n</Mechanical>\n</Material>\n",
          modulus(substance), density, substance.amplitude / temperature,
          std::max(world_.friction, world_.static_friction), world_.friction);
    }
    text_ += "</Palette>\n";
  }

  template <class Write>
  void write_layers(const Write& write) {
    for (int z = 0; z < body_.nz; ++z) {
      text_ += "<Layer><![CDATA[";
      write(body_.index(0, 0, z), body_.index(0, 0, z) + body_.index(0, body_.ny, 0));
      text_ += "]]></Layer>\n";
    }
  }

  template <class Value>
  void write_values(const char* name, const Value& value) {
    text_ += fmt::format("<{}>\n", name);
    write_layers([&](std::size_t begin, std::size_t end) {
      for (std::size_t cell = begin; cell < end; ++cell)
        text_ += fmt::format("{}{:.17g}", cell > begin ? "," : "",
                             body_.cells[cell] == 0 ? 0 : value(body_.substances[body_.cells[cell] - 1]));
    });
    text_ += fmt::format("</{}>\n", name);
  }

  void write_structure() {
    const bool readable = palette_.substances.size() <= most_ascii;
    text_ += fmt::format(
        "<Structure Compression=\"{}\">\n<X_Voxels>{}</X_Voxels>\n<Y_Voxels>{}</Y_Voxels>\n"
        "<Z_Voxels>{}</Z_Voxels>\n<Data>\n",
        readable ? "ASCII_READABLE" : "BASE64", body_.nx, body_.ny, body_.nz);
    write_layers([&](std::size_t begin, std::size_t end) {
      std::string layer;
      for (std::size_t cell = begin; cell < end; ++cell) {
        const std::size_t number = body_.cells[cell] == 0 ? 0 : palette_.number_of_substance[body_.cells[cell] - 1];
        layer += static_cast<char>(number + (readable ? '0' : 0));
      }
      text_ += readable ? layer : base64_encoded(layer);
    });
    text_ += "</Data>\n";
    write_values("PhaseOffset",
                 [&](const Substance& substance) { return moves(substance) ? substance.phase / turn : 0; });
    const double usual = period();
    const auto own = [&](const Substance& substance) {
      return moves(substance) && substance.frequency != 0 ? turn / substance.frequency : usual;
    };
    if (std::ranges::any_of(body_.substances, [&](const Substance& substance) { return own(substance) != usual; }))
      write_values("TempPeriod", own);
    text_ += "</Structure>\n";
  }

  const VoxelBody& body_;
  Palette palette_;
  Scaling scaling_{imported_edge, 1e6, density, 9.81};
  const World world_;
  std::string text_;
  double scale_, relaxation_time_, mass_;
};

World usual_world(const Robot& robot) {
  const bool land = environment_of(robot) == "land";
  return {.has_floor = land,
          .in_fluid = !land,
          .gravity = land ? -9.81 : 0,
          .stiffness_scale = land ? land_stiffness_scale : 1.0};
}

World world_of(const ImportedSettings& settings) {
  World world{.has_floor = settings.environment == "land",
              .in_fluid = settings.environment == "resistive",
              .self_collision = settings.self_collision,
              .gravity = settings.gravity,
              .stiffness_scale = settings.stiffness_scale,
              .damping = settings.damping,
              .seconds = settings.seconds,
              .settle = settings.settle};
  if (world.has_floor) {
    world.friction = settings.friction;
    world.static_friction = settings.static_friction;
  }
  if (world.in_fluid) world.normal_coefficient = settings.drag_coefficient;
  return world;
}

}  // namespace

std::string vxa_document(const Robot& robot, const std::optional<ImportedSettings>& world) {
  // The grid of a real body is of the materials that it was made of.
  const Robot paper = real_material_of(robot) ? without_real_body(robot) : robot;
  const std::optional<VoxelBody> body = voxel_body_of(paper);
  if (!body)
    throw InputError(robot.name,
                     "has no grid of voxels in its origin, which VXA needs; voxel, painted and imported robots have");
  // Of a beam, as the importer sets it: of all springs, or, in bodies that stand, half, all and 3/2 of it.
  double relaxation_time = 0, shortest = std::numeric_limits<double>::infinity();
  for (const Material& material : materials_of(robot)) {
    if (!(material.relaxation_time > 0)) continue;
    relaxation_time = std::max(relaxation_time, static_cast<double>(material.relaxation_time));
    shortest = std::min(shortest, static_cast<double>(material.relaxation_time));
  }
  if (relaxation_time > 2 * shortest) relaxation_time = 2 * shortest;
  double mass = 0;
  for (std::size_t i = 0; i < paper.masses.size(); ++i) mass += static_cast<double>(mass_of(paper, i));
  return VxaWriter(*body, world ? world_of(*world) : usual_world(robot), relaxation_time, mass).document();
}

void write_vxa(const Robot& robot, const std::filesystem::path& path, const std::optional<ImportedSettings>& world) {
  write_whole_file(path, vxa_document(robot, world));
}

}  // namespace mercury
