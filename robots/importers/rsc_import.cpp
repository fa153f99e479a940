// SPDX-License-Identifier: Apache-2.0
// RSC files of RISE, as its configuration guide describes them: a file of the world (palette, gravity), a file of the
// robot (bodies of voxels, joints), or both in one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "mercury/error.h"
#include "robots/importers/calibration.h"
#include "robots/importers/report_builder.h"
#include "robots/importers/xml_document.h"

namespace mercury {
namespace {

using enum ImportOutcome;

constexpr double rigid_stiffness = 10;  // of rigid segments, in relation to soft ones of the material
constexpr double expansion_frequency = 2 * std::numbers::pi;

std::string_view known_element(std::string_view place) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 21> known{{
      {"/Constraints/", "joints have no counterpart: bodies become robots of their own"},
      {"/Integration/", "the time step of the configuration follows from the stiffest spring"},
      {"/RigidSolver/", "rigid segments become stiff springs"},
      {"/Condition/", "of a run and its results, not of the robot"},
      {"/RecordHistory/", "of a run and its results, not of the robot"},
      {"/Save/", "of a run and its results, not of the robot"},
      {"/InternalDampingZ", "springs of Mercury have no damping of their own"},
      {"/CollisionDampingZ", "contacts of Mercury have no damping of their own"},
      {"/FloorElevation/", "the floor of Mercury is flat"},
      {"/ControlFrequency", "programs drive actuators as often as they like"},
      {"/RotationNum", "joints have no counterpart"},
      {"/ExpansionNum", "the signals that voxels name become actuators"},
      {"/Display/", "Mercury colors materials by what they do"},
      {"/MatModel", "springs of Mercury are linear and do not yield or break"},
      {"/PoissonsRatio", "the lattice of springs has a Poisson ratio of its own, about 0.35"},
      {"/FrictionStatic", "static friction is that of motion"},
      {"/Orientation", "each body is a robot of its own, in its own axes"},
      {"/OriginPosition", "each body is a robot of its own, in its own axes"},
      {"/SegmentID/", "only their types matter"},
      {"/Body/@ID", "only joints name bodies"},
      {"/@Version", "there is one version"},
  }};
  const std::string closed = fmt::format("{}/", place);
  for (const auto& [part, reason] : known)
    if (closed.find(part) != std::string::npos) return reason;
  if (place.find("/@ID") != std::string_view::npos) return "only joints name bodies";
  return {};
}

struct RscMaterial {
  std::string name;
  double elastic_modulus = 0, density = 0, friction = 0, expansion = 0;
};

class RscImport {
 public:
  RscImport(std::string_view text, std::string_view base, std::string name, const ImportOptions& options)
      : own_(text), name_(std::move(name)), options_(options) {
    if (!base.empty()) base_.emplace(base, "base: ");
  }

  Import run() {
    const std::string_view root = own_.root().name();
    if (root != "RSC" && root != "VXC")
      refuse(own_.root(), "a file of another kind; its outermost element must be RSC");
    read_palette();
    read_world();
    import_.report.format = "RSC of RISE";
    import_.report.length_scale = scaling_->calibration.length_scale;
    import_.report.time_scale = scaling_->calibration.time_scale;
    const auto [structure, document] = part("Structure");
    if (!structure) throw InputError("/RSC", "has no element Structure, which holds the bodies");
    std::size_t bodies = 0;
    for (const pugi::xml_node& body : structure.child("Bodies").children("Body")) {
      if (++bodies > most_bodies) refuse(structure, fmt::format("has more than {} bodies", most_bodies));
      read_body(body, *document, bodies == 1 ? name_ : fmt::format("{}-{}", name_, bodies));
    }
    if (bodies == 0) refuse(structure, "has no element Bodies/Body");
    if (structure.child("Constraints").child("Constraint"))
      import_.report.notes.push_back("joints have no counterpart: each body is a robot of its own");
    import_.settings.friction = voxels_ > 0 ? friction_ / voxels_ : 0;
    import_.settings.damping = voxels_ > 0 ? scaling_->damping(damping_, root_modulus_ / voxels_) : 0;
    import_.settings.dt = stable_time_step(import_.robots, import_.settings.stiffness_scale);
    import_.report.elements = own_.elements(known_element);
    if (base_)
      for (ImportedElement& element : base_->elements(known_element)) {
        element.place = "base" + element.place;
        import_.report.elements.push_back(std::move(element));
      }
    return std::move(import_);
  }

 private:
  // The element of this name in the file, else in its base, and its document.
  std::pair<pugi::xml_node, XmlDocument*> part(const char* name) {
    for (XmlDocument* document : {&own_, base_ ? &*base_ : nullptr}) {
      if (!document) continue;
      for (const pugi::xml_node& root : document->tree().children())
        if (const pugi::xml_node found = root.child(name)) return {found, document};
    }
    return {pugi::xml_node(), &own_};
  }

  void read_palette() {
    const auto [voxel, document] = part("Voxel");
    if (!voxel)
      throw InputError("/RSC",
                       "has no element Voxel with the palette, and no base has one; name the file of the world with "
                       "--base");
    const double edge = number_in(voxel, "Size").value_or(0.01);
    if (edge < 1e-9 || edge > 1e3) refuse(voxel.child("Size"), "give 1e-9 to 1000 m");
    document->mark(voxel.child("Size"), mapped, "scaled to voxels of 0.1 m");
    double stiffest = 0, density = 0;
    for (const pugi::xml_node& node : voxel.child("Palette").children("Material")) {
      const std::optional<double> id = number_from(node.attribute("ID").value());
      if (!id || *id != std::floor(*id) || *id < 1 || *id > 255) refuse(node, "needs an ID from 1 to 255");
      document->mark(node.attribute("ID"), mapped, "MaterialID names it");
      const pugi::xml_node mechanical = node.child("Mechanical");
      RscMaterial material{.name = text_of(node.child("Name"))};
      material.elastic_modulus = number_in(mechanical, "ElasticMod").value_or(0);
      material.density = number_in(mechanical, "Density").value_or(0);
      material.friction = number_in(mechanical, "FrictionDynamic").value_or(0);
      material.expansion = std::min(std::abs(number_in(mechanical, "MaxExpansion").value_or(0)),
                                    std::abs(number_in(mechanical, "MinExpansion").value_or(0)));
      if (!(material.elastic_modulus > 0) || !(material.density > 0) || material.friction < 0)
        refuse(node, "needs an ElasticMod and a Density above 0, and no FrictionDynamic below 0");
      if (material.name.empty()) material.name = fmt::format("material {}", *id);
      document->mark(node.child("Name"), mapped, "name of the material");
      document->mark(mechanical.child("ElasticMod"), mapped, "stiffness of springs");
      document->mark(mechanical.child("Density"), approximated,
                     "every mass is 1 kg: the mean of the palette goes into the stiffness");
      document->mark(mechanical.child("FrictionDynamic"), approximated, "friction, the mean over the voxels");
      for (const char* child : {"MaxExpansion", "MinExpansion"})
        document->mark(mechanical.child(child), approximated, "amplitude of actuators, the smaller of the two");
      stiffest = std::max(stiffest, material.elastic_modulus);
      density += material.density;
      palette_[static_cast<int>(*id)] = std::move(material);
    }
    if (palette_.empty()) refuse(voxel, "has no element Palette/Material");
    try {
      scaling_.emplace(edge, stiffest, density / static_cast<double>(palette_.size()), 9.81);
    } catch (const InputError& error) {
      refuse(voxel, error.what());
    }
  }

  void read_world() {
    ImportedSettings& settings = import_.settings;
    settings = {.environment = "land", .gravity = -9.81, .stiffness_scale = land_stiffness_scale};
    for (XmlDocument* world : {&own_, base_ ? &*base_ : nullptr}) {
      if (!world) continue;
      for (const pugi::xml_node& root : world->tree().children()) read_simulator(root.child("Simulator"), *world);
    }
    if (!says_gravity_ || !says_floor_)
      import_.report.decisive.push_back(fmt::format("assumed: {}, which no file of this robot says",
                                                    says_floor_     ? "gravity of 9.81 m/s2"
                                                    : says_gravity_ ? "a floor"
                                                                    : "gravity of 9.81 m/s2 and a floor"));
    if (settings.environment != "land") settings.stiffness_scale = 1;
    settings.contact_stiffness = scaling_->calibration.contact_stiffness / settings.stiffness_scale;
  }

  void read_simulator(const pugi::xml_node& simulator, XmlDocument& document) {
    const pugi::xml_node gravity = simulator.child("Gravity"), damping = simulator.child("Damping");
    if (const std::optional<double> value = number_in(gravity, "GravAcc")) import_.settings.gravity = *value;
    says_gravity_ = says_gravity_ || gravity.child("GravAcc");
    says_floor_ = says_floor_ || gravity.child("FloorEnabled");
    document.mark(gravity.child("GravAcc"), mapped, "gravity of the configuration");
    if (const std::optional<bool> floor = switch_in(gravity, "FloorEnabled"))
      import_.settings.environment = *floor ? "land" : "ocean-simple";
    document.mark(gravity.child("FloorEnabled"), mapped, "environment with a floor or without");
    if (const std::optional<double> value = number_in(damping, "GlobalDampingZ")) damping_ = *value;
    document.mark(damping.child("GlobalDampingZ"), approximated, "damping, the mean over the voxels");
  }

  // Whole numbers, one per voxel; empty if there is no such element.
  std::vector<int> values_of(const pugi::xml_node& body, const char* name, const VoxelBody& grid) {
    std::vector<int> values;
    const pugi::xml_node parent = body.child(name);
    if (!parent) return values;
    int layers = 0;
    const std::size_t size = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny);
    for (const pugi::xml_node& layer : parent.children("Layer")) {
      const std::string text = text_of(layer);
      ++layers;
      const std::size_t before = values.size();
      for (const std::string_view word : list_values(text)) {
        const std::optional<double> value = number_from(word);
        if (!value || *value != std::floor(*value) || std::abs(*value) > 1e6)
          refuse(layer, fmt::format("value {} is not a whole number", values.size() - before + 1));
        values.push_back(static_cast<int>(*value));
      }
      if (values.size() - before != size)
        refuse(layer, fmt::format("has {} values, X_Voxels times Y_Voxels is {}", values.size() - before, size));
    }
    if (layers != grid.nz) refuse(parent, fmt::format("has {} layers, Z_Voxels is {}", layers, grid.nz));
    return values;
  }

  void mark_layers(XmlDocument& document, const pugi::xml_node& parent, ImportOutcome outcome,
                   const std::string& reason) {
    for (const pugi::xml_node& layer : parent.children("Layer")) document.mark(layer, outcome, reason);
  }

  int size_in(const pugi::xml_node& body, const char* name, XmlDocument& document) {
    const int size = whole_number_in(body, name).value_or(0);
    if (size < 1 || static_cast<std::size_t>(size) > most_imported_cells)
      refuse(body.child(name) ? body.child(name) : body,
             fmt::format("{} of {} is not accepted; give 1 to {}", name, size, most_imported_cells));
    document.mark(body.child(name), mapped, "size of the grid");
    return size;
  }

  void read_body(const pugi::xml_node& node, XmlDocument& document, const std::string& name) {
    VoxelBody grid{.nx = size_in(node, "X_Voxels", document),
                   .ny = size_in(node, "Y_Voxels", document),
                   .nz = size_in(node, "Z_Voxels", document),
                   .cells = {},
                   .substances = {},
                   .names = {},
                   .held = {}};
    if (static_cast<double>(grid.nx) * grid.ny * grid.nz > static_cast<double>(most_imported_cells))
      refuse(node, fmt::format("has too many voxels; at most {} are accepted", most_imported_cells));
    const std::vector<int> materials = values_of(node, "MaterialID", grid),
                           types = values_of(node, "SegmentType", grid),
                           signals = values_of(node, "ExpansionSignalID", grid);
    if (materials.empty()) refuse(node, "has no element MaterialID");
    mark_layers(document, node.child("MaterialID"), mapped, "voxels, x fastest, then y");
    mark_layers(document, node.child("SegmentType"), approximated, "rigid segments have springs ten times as stiff");
    mark_layers(document, node.child("ExpansionSignalID"), approximated,
                "voxels of one signal move together: muscles of one phase");
    std::map<std::tuple<int, bool, int>, std::uint32_t> known;
    std::vector<int> signal_of_substance;
    for (std::size_t cell = 0; cell < materials.size(); ++cell) {
      if (materials[cell] == 0) {
        grid.cells.push_back(0);
        continue;
      }
      const auto material = palette_.find(materials[cell]);
      if (material == palette_.end())
        refuse(node.child("MaterialID"),
               fmt::format("voxel {} has material {}, which the palette has not", cell, materials[cell]));
      const bool is_rigid = !types.empty() && types[cell] == 1;
      const int signal = signals.empty() || is_rigid ? -1 : signals[cell];
      const auto [place, is_new] = known.try_emplace({materials[cell], is_rigid, signal}, std::uint32_t{0});
      if (is_new) {
        grid.substances.push_back(substance_of_voxel(material->second, is_rigid, signal));
        grid.names.push_back(material->second.name + (is_rigid ? ", rigid" : ""));
        signal_of_substance.push_back(signal);
        place->second = static_cast<std::uint32_t>(grid.substances.size());
      }
      grid.cells.push_back(place->second);
      friction_ += material->second.friction;
      root_modulus_ += std::sqrt(material->second.elastic_modulus / scaling_->model.elastic_modulus);
      ++voxels_;
    }
    if (grid.substances.empty()) refuse(node.child("MaterialID"), "all voxels are empty");
    const Provenance provenance{.file = name_,
                                .format = "RSC of RISE",
                                .length_scale = scaling_->calibration.length_scale,
                                .time_scale = scaling_->calibration.time_scale,
                                .environment = import_.settings.environment};
    const std::size_t before = import_.robots.size();
    try {
      add_bodies(grid, name, provenance, options_, import_);
    } catch (const InputError& error) {
      refuse(node, error.what());
    }
    for (std::size_t i = before; i < import_.robots.size(); ++i) name_actuators(import_.robots[i]);
  }

  // Signals differ in phase, so that each has materials of its own.
  Substance substance_of_voxel(const RscMaterial& material, bool is_rigid, int signal) const {
    Substance substance{.stiffness = scaling_->stiffness(material.elastic_modulus) * (is_rigid ? rigid_stiffness : 1) /
                                     import_.settings.stiffness_scale};
    if (signal < 0 || material.expansion == 0) return substance;
    constexpr double largest_amplitude = 0.9, golden = 0.618033988749895;
    substance.amplitude = std::min(material.expansion, largest_amplitude);
    substance.frequency = expansion_frequency;
    substance.phase = 2 * std::numbers::pi * std::fmod(golden * signal, 1.0);
    return substance;
  }

  // Muscles of one phase are one signal; without names they are actuators too.
  void name_actuators(Robot& robot) {
    if (actuators_of(robot).empty() || has_note_) return;
    has_note_ = true;
    import_.report.notes.push_back(
        "controllers are programs there: voxels of one ExpansionSignalID move together, with a sine of 1 Hz by "
        "default");
  }

  XmlDocument own_;
  std::optional<XmlDocument> base_;
  std::string name_;
  ImportOptions options_;
  Import import_;
  std::optional<Scaling> scaling_;
  std::map<int, RscMaterial> palette_;
  double damping_ = 0;
  double friction_ = 0, root_modulus_ = 0, voxels_ = 0;  // sums over the voxels, and their number
  bool has_note_ = false, says_gravity_ = false, says_floor_ = false;
};

}  // namespace

ImportFormat rsc_format() {
  return {.name = "rsc",
          .extensions = ".rsc",
          .programs = "RISE",
          .base_name = "env.rsc",
          .read = [](std::string_view text, std::string_view base, const std::string& name,
                     const ImportOptions& options) { return RscImport(text, base, name, options).run(); }};
}

}  // namespace mercury
