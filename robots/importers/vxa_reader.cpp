// SPDX-License-Identifier: Apache-2.0
#include "robots/importers/vxa_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "mercury/error.h"
#include "robots/importers/encodings.h"
#include "robots/importers/report_builder.h"
#include "robots/importers/voxel_body.h"

namespace mercury {
namespace {

using enum ImportOutcome;

class VxaReader {
 public:
  VxaReader(XmlDocument& document, bool is_voxcraft) : document_(document) { model_.is_voxcraft = is_voxcraft; }

  VxaModel read() {
    const pugi::xml_node root = document_.root();
    const std::string_view name = root.name();
    if (name != "VXA" && name != "VXC")
      refuse(root, fmt::format("a file of another kind; its outermost element must be VXA or VXC"));
    mark_version(root, name == "VXA" ? 1.1 : 0.94);
    const pugi::xml_node simulator = root.child("Simulator"), environment = root.child("Environment");
    const pugi::xml_node vxc = name == "VXC" ? root : root.child("VXC");
    if (!vxc) refuse(root, "has no element VXC, which holds the voxels");
    if (vxc != root) mark_version(vxc, 0.94);
    find_program(root, simulator);
    read_simulator(simulator);
    read_environment(environment);
    read_lattice(vxc.child("Lattice"));
    read_palette(vxc.child("Palette"));
    read_structure(vxc.child("Structure"), environment);
    read_regions(environment);
    add_decisive_notes(simulator, environment, vxc.child("Structure"));
    return std::move(model_);
  }

 private:
  void mark(const pugi::xml_node& parent, const char* child, ImportOutcome outcome, const std::string& reason) {
    document_.mark(parent.child(child), outcome, reason);
  }

  void mark_version(const pugi::xml_node& node, double newest) {
    const pugi::xml_attribute version = node.attribute("Version");
    if (!version) return;
    const std::optional<double> number = number_from(version.value());
    if (!number) refuse(node, fmt::format("version \"{}\" is not a number", version.value()));
    if (*number > newest)
      document_.mark(version, ignored, "newer than the versions that are known; what changed is not known");
    else
      document_.mark(version, mapped, "how the file is read");
  }

  void find_program(const pugi::xml_node& root, const pugi::xml_node& simulator) {
    for (const char* child : {"RecordHistory", "AttachDetach", "EnableExpansion", "ForceField", "FitnessFunction",
                              "SavePositionOfAllVoxels", "EnableCilia", "EnableSignals"})
      model_.is_voxcraft = model_.is_voxcraft || simulator.child(child);
    model_.is_voxcraft = model_.is_voxcraft || root.child("GPU") || root.child("RawPrint") ||
                         simulator.child("StopCondition").child("StopConditionFormula");
    if (!model_.is_voxcraft) return;
    model_.half_wave = !switch_in(simulator, "EnableExpansion").value_or(false);
    mark(simulator, "EnableExpansion", mapped,
         model_.half_wave ? "temperatures above the base are cut off: half_wave" : "the whole wave acts");
  }

  void read_simulator(const pugi::xml_node& simulator) {
    const pugi::xml_node damping = simulator.child("Damping");
    if (damping) {
      model_.slow_damping = number_in(damping, "SlowDampingZ").value_or(1.0);
      mark(damping, "SlowDampingZ", approximated, "damping, the mean over the voxels");
      model_.bond_damping = number_in(damping, "BondDampingZ").value_or(0.1);
      mark(damping, "BondDampingZ", approximated, "relaxation time of all springs, the mean over the voxels");
    }
    model_.self_collision = switch_in(simulator.child("Collisions"), "SelfColEnabled").value_or(model_.is_voxcraft);
    mark(simulator.child("Collisions"), "SelfColEnabled", mapped, "self-collision on land");
    const pugi::xml_node stop = simulator.child("StopCondition");
    read_stop(stop);
    if (const std::optional<double> start = number_in(stop, "InitCmTime"); start && *start > 0) {
      model_.start_time = start;
      mark(stop, "InitCmTime", approximated, "settle; muscles move in this time too");
    }
  }

  void read_stop(const pugi::xml_node& stop) {
    constexpr int simulated_time = 2;
    const std::optional<int> type = whole_number_in(stop, "StopConditionType");
    const std::optional<double> value = number_in(stop, "StopConditionValue");
    if (type == simulated_time && value && *value > 0) {
      model_.stop_time = value;
      mark(stop, "StopConditionType", mapped, "seconds of mercury run");
      mark(stop, "StopConditionValue", mapped, "seconds of mercury run");
    }
    // "t - c", which stops at the time c.
    const pugi::xml_node difference = stop.child("StopConditionFormula").child("mtSUB");
    if (text_of(difference.child("mtVAR")) != "t") return;
    const std::optional<double> constant = number_in(difference, "mtCONST");
    if (!constant || *constant <= 0) return;
    model_.stop_time = constant;
    mark(difference, "mtVAR", mapped, "seconds of mercury run");
    mark(difference, "mtCONST", mapped, "seconds of mercury run");
  }

  void read_environment(const pugi::xml_node& environment) {
    if (const pugi::xml_node gravity = environment.child("Gravity")) {
      model_.gravity_enabled = switch_in(gravity, "GravEnabled").value_or(false);
      model_.floor_enabled = switch_in(gravity, "FloorEnabled").value_or(false);
      model_.gravity = number_in(gravity, "GravAcc").value_or(-9.81);
      mark(gravity, "GravEnabled", mapped, "gravity of the configuration");
      mark(gravity, "GravAcc", mapped, "gravity of the configuration");
      mark(gravity, "FloorEnabled", mapped,
           model_.floor_enabled ? "environment land" : "an environment without a floor");
    }
    model_.in_fluid = switch_in(environment, "FluidEnvironment").value_or(false);
    mark(environment, "FluidEnvironment", mapped,
         model_.in_fluid ? "environment resistive, without gravity as in evosoro" : "no water");
    model_.drag_coefficient = number_in(environment, "AggregateDragCoefficient").value_or(0);
    if (model_.in_fluid)
      mark(environment, "AggregateDragCoefficient", mapped,
           "C_N of one-sided resistive water, twice this over the density");
    else
      mark(environment, "AggregateDragCoefficient", ignored, "the file is not in water");
    read_temperature(environment.child("Thermal"));
  }

  void read_temperature(const pugi::xml_node& thermal) {
    if (!thermal) return;
    const bool enabled = switch_in(thermal, "TempEnabled").value_or(false);
    const bool varies = switch_in(thermal, "VaryTempEnabled").value_or(false);
    const double base = number_in(thermal, "TempBase").value_or(25);
    // An older file has the highest temperature itself.
    if (const std::optional<double> amplitude = number_in(thermal, "TempAmplitude")) {
      model_.temperature_amplitude = *amplitude;
      mark(thermal, "TempAmplitude", mapped, "amplitude of muscles, times CTE");
    } else if (const std::optional<double> highest = number_in(thermal, "TempAmp")) {
      model_.temperature_amplitude = *highest - base;
      mark(thermal, "TempAmp", mapped, "amplitude of muscles, less TempBase, times CTE");
    }
    mark(thermal, "TempBase", mapped, "the temperature of the lattice's own size");
    model_.temperature_period = number_in(thermal, "TempPeriod").value_or(0.1);
    model_.temperature_varies = varies && (enabled || model_.is_voxcraft) && model_.temperature_period > 0;
    const char* still = "nothing moves";
    mark(thermal, "TempPeriod", mapped, model_.temperature_varies ? "frequency of muscles" : still);
    mark(thermal, "VaryTempEnabled", mapped, model_.temperature_varies ? "muscles move" : still);
    if (model_.is_voxcraft)
      mark(thermal, "TempEnabled", ignored, "voxcraft-sim looks at VaryTempEnabled alone");
    else
      mark(thermal, "TempEnabled", mapped, enabled ? "muscles move if VaryTempEnabled" : still);
    if (enabled && !varies && !model_.is_voxcraft && model_.temperature_amplitude != 0)
      for (const char* child : {"TempAmplitude", "TempAmp"})
        mark(thermal, child, ignored, "a constant temperature; the change of size that it makes is not kept");
  }

  void read_lattice(const pugi::xml_node& lattice) {
    if (const std::optional<double> edge = number_in(lattice, "Lattice_Dim")) {
      if (*edge < 1e-9 || *edge > 1e3)
        refuse(lattice.child("Lattice_Dim"), fmt::format("an edge of {} m is not accepted; give 1e-9 to 1000", *edge));
      model_.edge = *edge;
    }
    mark(lattice, "Lattice_Dim", mapped, "scaled to voxels of 0.1 m");
    for (const char* child : {"X_Dim_Adj", "Y_Dim_Adj", "Z_Dim_Adj"})
      if (number_in(lattice, child).value_or(1) == 1)
        mark(lattice, child, mapped, "cubes");
      else
        mark(lattice, child, ignored, "voxels of Mercury are cubes");
    for (const char* child : {"X_Line_Offset", "Y_Line_Offset", "X_Layer_Offset", "Y_Layer_Offset"})
      if (number_in(lattice, child).value_or(0) == 0)
        mark(lattice, child, mapped, "a simple cubic lattice");
      else
        mark(lattice, child, ignored, "the lattice of Mercury is simple cubic");
  }

  void read_palette(const pugi::xml_node& palette) {
    for (const pugi::xml_node& node : palette.children("Material")) {
      document_.mark(node.attribute("ID"), ignored, "materials count from 1 in their order, as their programs do it");
      const pugi::xml_node mechanical = node.child("Mechanical");
      VxaMaterial material{.name = text_of(node.child("Name")), .element = node};
      mark(node, "Name", mapped, "name of the material");
      material.elastic_modulus = number_in(mechanical, "Elastic_Mod").value_or(0);
      material.density = number_in(mechanical, "Density").value_or(0);
      material.expansion = number_in(mechanical, "CTE").value_or(0);
      material.phase = number_in(mechanical, "MaterialTempPhase").value_or(0);
      material.friction = number_in(mechanical, "uDynamic").value_or(0);
      if (material.friction < 0) refuse(mechanical.child("uDynamic"), "give 0 or more");
      material.static_friction = number_in(mechanical, "uStatic").value_or(0);
      if (material.static_friction < 0) refuse(mechanical.child("uStatic"), "give 0 or more");
      material.held = number_in(mechanical, "Fixed").value_or(0) != 0;
      if (material.name.empty()) material.name = fmt::format("material {}", model_.materials.size() + 1);
      model_.materials.push_back(std::move(material));
    }
    if (model_.materials.size() > 255) refuse(palette, "has more than 255 materials");
  }

  // Throws unless there is such a material and it can be used.
  void mark_used(std::size_t number, bool needs_modulus) {
    const VxaMaterial& material = model_.materials[number - 1];
    const pugi::xml_node mechanical = material.element.child("Mechanical");
    const auto require = [&](const char* child, double value) {
      if (value > 0) return;
      const pugi::xml_node node = mechanical.child(child);
      refuse(node ? node : material.element,
             fmt::format("{} is {}, and voxels have this material; give more than 0", child, value));
    };
    if (needs_modulus) require("Elastic_Mod", material.elastic_modulus);
    require("Density", material.density);
  }

  int size_in(const pugi::xml_node& structure, const char* child) {
    const int size = whole_number_in(structure, child).value_or(1);
    if (size < 1 || static_cast<std::size_t>(size) > most_imported_cells)
      refuse(structure.child(child), fmt::format("{} is not accepted; give 1 to {}", size, most_imported_cells));
    mark(structure, child, mapped, "size of the grid");
    return size;
  }

  // A base for .vxd files has no structure, or an empty one.
  void read_structure(const pugi::xml_node& structure, const pugi::xml_node& environment) {
    if (!structure || !structure.child("Data")) return;
    model_.nx = size_in(structure, "X_Voxels");
    model_.ny = size_in(structure, "Y_Voxels");
    model_.nz = size_in(structure, "Z_Voxels");
    if (static_cast<double>(model_.nx) * model_.ny * model_.nz > static_cast<double>(most_imported_cells))
      refuse(structure, fmt::format("{}x{}x{} voxels are too many; at most {} are accepted", model_.nx, model_.ny,
                                    model_.nz, most_imported_cells));
    read_voxels(structure, structure.child("Data"));
    model_.phase_offset = values_of(structure.child("PhaseOffset"), mapped, "phase of muscles, in turns");
    model_.elastic_modulus =
        values_of(structure.child("Stiffness"), mapped, "stiffness, in place of the elastic modulus of the material");
    model_.amplitude_factor = values_of(structure.child("TempAmpDamp"), mapped, "factor of the amplitude");
    model_.period = values_of(structure.child("TempPeriod"), mapped, "frequency of each voxel");
    read_growth(structure, environment);
    leave_out_unknown_materials();
    std::array<bool, 256> used{};
    for (std::size_t i = 0; i < model_.cells.size(); ++i) {
      const std::size_t material = model_.cells[i];
      used[material] = true;
      if (material > 0 && !model_.elastic_modulus.empty() && !(model_.elastic_modulus[i] > 0))
        refuse(structure.child("Stiffness"),
               fmt::format("voxel {} has {}; give more than 0", i, model_.elastic_modulus[i]));
      if (material > 0 && !model_.period.empty() && !(model_.period[i] > 0))
        refuse(structure.child("TempPeriod"), fmt::format("voxel {} has {}; give more than 0", i, model_.period[i]));
    }
    for (std::size_t material = 1; material < used.size(); ++material)
      if (used[material]) mark_used(material, model_.elastic_modulus.empty());
    mark_materials(used);
  }

  // voxcraft-sim says "No such material" of them, and has none either.
  void leave_out_unknown_materials() {
    std::set<int> unknown;
    std::size_t voxels = 0;
    for (std::uint8_t& material : model_.cells) {
      if (material <= model_.materials.size()) continue;
      unknown.insert(material);
      ++voxels;
      material = 0;
    }
    if (voxels > 0)
      model_.decisive.push_back(
          fmt::format("left out: {} voxel{} of material {}, which the palette of {} does not have", voxels,
                      voxels == 1 ? "" : "s", fmt::join(unknown, ", "), model_.materials.size()));
  }

  // Regions hold or push the voxels that they touch, in shares of the lattice (CVX_FRegion). A newer file has
  // Boundary_Conditions, an older one Fixed_Regions and Forced_Regions.
  void read_regions(const pugi::xml_node& environment) {
    bool is_partial = false, is_pushed = false;
    const auto read = [&](const char* parent) {
      for (const pugi::xml_node& region : environment.child(parent).children("FRegion")) {
        constexpr int translations = 7;
        const int held = whole_number_in(region, "DofFixed")
                             .value_or(switch_in(region, "Fixed").value_or(false) ? translations : 0) &
                         translations;
        for (const char* push :
             {"ForceX", "ForceY", "ForceZ", "TorqueX", "TorqueY", "TorqueZ", "DisplaceX", "DisplaceY", "DisplaceZ"})
          is_pushed = is_pushed || number_in(region, push).value_or(0) != 0;
        is_partial = is_partial || (held != 0 && held != translations);
        if (held == translations) hold(region);
      }
    };
    read("Boundary_Conditions");
    if (!environment.child("Boundary_Conditions"))
      for (const char* parent : {"Fixed_Regions", "Forced_Regions"}) read(parent);
    for (std::size_t i = 0; i < model_.cells.size(); ++i)
      if (model_.cells[i] > 0 && model_.materials[model_.cells[i] - 1u].held) hold(i);
    if (!model_.held.empty())
      model_.decisive.push_back(fmt::format("held in its place, by fixed masses: {} of {} voxels",
                                            std::ranges::count(model_.held, true),
                                            std::ranges::count_if(model_.cells, [](auto cell) { return cell > 0; })));
    if (is_partial) model_.decisive.push_back("not kept: regions that hold voxels along some axes only");
    if (is_pushed) model_.decisive.push_back("not kept: regions that push or move voxels");
  }

  void hold(std::size_t cell) {
    model_.held.resize(model_.cells.size());
    model_.held[cell] = true;
  }

  // The voxels that a box or a sphere touches, as IsTouching() of these programs says: a voxel reaches half an edge
  // around its middle, of a sphere half a diagonal. A cylinder or mesh touches what has its middle in its box.
  void hold(const pugi::xml_node& region) {
    enum { box, cylinder, sphere };
    const int kind = whole_number_in(region, "PrimType").value_or(box);
    const std::array<double, 3> size{double(model_.nx), double(model_.ny), double(model_.nz)};
    std::array<double, 3> low{}, extent{};
    constexpr std::array<const char*, 3> places{"X", "Y", "Z"}, lengths{"dX", "dY", "dZ"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = size[axis] * number_in(region, places[axis]).value_or(0);  // in voxels from here on
      extent[axis] = size[axis] * number_in(region, lengths[axis]).value_or(0);
      document_.mark(region.child(places[axis]), mapped, "where voxels are held");
      document_.mark(region.child(lengths[axis]), mapped, "where voxels are held");
    }
    const double radius = *std::ranges::max_element(size) * number_in(region, "Radius").value_or(0);
    if (kind == sphere) document_.mark(region.child("Radius"), mapped, "where voxels are held");
    document_.mark(region.child("PrimType"), kind == box || kind == sphere ? mapped : approximated,
                   "where voxels are held");
    for (const char* child : {"DofFixed", "Fixed"})
      document_.mark(region.child(child), mapped, "the masses of these voxels are fixed");
    for (std::size_t i = 0; i < model_.cells.size(); ++i) {
      if (model_.cells[i] == 0) continue;
      const auto nx = static_cast<std::size_t>(model_.nx), ny = static_cast<std::size_t>(model_.ny);
      const std::array<double, 3> middle{double(i % nx) + 0.5, double(i / nx % ny) + 0.5, double(i / nx / ny) + 0.5};
      bool touches = true;
      double square = 0;
      const double reach = kind == box ? 0.5 : 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        touches = touches && middle[axis] + reach > low[axis] && middle[axis] - reach < low[axis] + extent[axis];
        square += (middle[axis] - low[axis]) * (middle[axis] - low[axis]);
      }
      if (kind == sphere ? std::sqrt(square) < radius + std::sqrt(0.75) : touches) hold(i);
    }
  }

  // What decides how the robot moves, and is not kept.
  void add_decisive_notes(const pugi::xml_node& simulator, const pugi::xml_node& environment,
                          const pugi::xml_node& structure) {
    const auto filled = [](const pugi::xml_node& node) {
      return !text_of(node).empty() && text_of(node).find_first_of("123456789") != std::string::npos;
    };
    bool has_cilia = switch_in(simulator, "EnableCilia").value_or(false);
    bool has_force = false;
    for (const VxaMaterial& material : model_.materials)
      has_force = has_force || number_in(material.element.child("Mechanical"), "Cilia").value_or(0) != 0;
    for (const pugi::xml_node& layer : structure.child("BaseCiliaForce").children("Layer"))
      has_force = has_force || filled(layer);
    has_cilia = has_cilia && has_force;
    if (has_cilia)
      model_.decisive.push_back(
          "not kept: cilia, which drive voxels of this file and have no counterpart; it will not move as there");
    if (switch_in(environment, "StickyFloor").value_or(false))
      model_.decisive.push_back("not kept: voxels stick to the floor there; here it has friction alone");
    if (simulator.child("AttachDetach") && switch_in(simulator.child("AttachDetach"), "EnableAttach").value_or(false))
      model_.decisive.push_back("not kept: voxels that touch stick together there");
    if (!environment.child("Gravity") && !model_.in_fluid)
      model_.decisive.push_back("assumed: gravity of 9.81 m/s2 and a floor, which the file does not say");
  }

  void mark_materials(const std::array<bool, 256>& used) {
    for (std::size_t i = 0; i < model_.materials.size(); ++i) {
      const pugi::xml_node mechanical = model_.materials[i].element.child("Mechanical");
      if (!used[i + 1]) {
        for (const char* child : {"Elastic_Mod", "Density", "CTE", "MaterialTempPhase", "uStatic", "uDynamic"})
          mark(mechanical, child, ignored, "no voxel has this material");
        continue;
      }
      if (model_.elastic_modulus.empty())
        mark(mechanical, "Elastic_Mod", mapped, "stiffness of springs; springs between two materials have the mean");
      else
        mark(mechanical, "Elastic_Mod", ignored, "Structure/Stiffness replaces it");
      mark(mechanical, "Density", approximated,
           "all voxels weigh the same: the mean over them goes into the stiffness");
      mark(mechanical, "CTE", mapped,
           model_.temperature_varies ? "amplitude of muscles, times the amplitude of the temperature"
                                     : "nothing moves: the temperature does not vary");
      mark(mechanical, "uStatic", approximated, "static friction, the mean over the voxels");
      mark(mechanical, "uDynamic", approximated, "friction, the mean over the voxels");
      mark(mechanical, "Fixed", mapped,
           model_.materials[i].held ? "the masses of these voxels are fixed" : "no voxel is held");
      if (uses_material_phase())
        mark(mechanical, "MaterialTempPhase", mapped, "phase of muscles");
      else
        mark(mechanical, "MaterialTempPhase", ignored,
             model_.is_voxcraft ? "voxcraft-sim does not use it" : "the phase of each voxel replaces it");
    }
  }

  bool uses_material_phase() const { return !model_.is_voxcraft && model_.phase_offset.empty(); }

  // The elements Layer of a parent, one per layer of the grid.
  std::vector<pugi::xml_node> layers_of(const pugi::xml_node& parent) {
    std::vector<pugi::xml_node> layers;
    for (const pugi::xml_node& layer : parent.children("Layer")) layers.push_back(layer);
    if (layers.size() != static_cast<std::size_t>(model_.nz))
      refuse(parent, fmt::format("has {} layers, Z_Voxels is {}", layers.size(), model_.nz));
    return layers;
  }

  std::size_t layer_size() const { return static_cast<std::size_t>(model_.nx) * static_cast<std::size_t>(model_.ny); }

  void read_voxels(const pugi::xml_node& structure, const pugi::xml_node& data) {
    if (!data) refuse(structure, "has no element Data");
    const pugi::xml_attribute compression = structure.attribute("Compression");
    const std::string_view kind = compression.value();
    if (kind != "ASCII_READABLE" && kind != "ZLIB" && kind != "BASE64" && compression)
      refuse(structure, fmt::format("compression \"{}\" is not accepted; give ASCII_READABLE, BASE64 or ZLIB", kind));
    document_.mark(compression, mapped, "how the layers are read");
    for (const pugi::xml_node& layer : layers_of(data)) {
      std::string voxels;
      try {
        voxels = layer_voxels(text_of(layer), kind);
      } catch (const InputError& error) {
        refuse(layer, error.what());
      }
      if (voxels.size() != layer_size())
        refuse(layer, fmt::format("has {} voxels, X_Voxels times Y_Voxels is {}", voxels.size(), layer_size()));
      model_.cells.insert(model_.cells.end(), voxels.begin(), voxels.end());
      document_.mark(layer, mapped, "voxels, x fastest, then y");
    }
  }

  std::string layer_voxels(std::string text, std::string_view compression) const {
    if (compression == "ZLIB") return inflated(base64_decoded(text), layer_size());
    if (compression != "ASCII_READABLE") return base64_decoded(text);
    for (char& letter : text) {
      if (static_cast<unsigned char>(letter) < '0') throw InputError("holds a character below \"0\"");
      letter = static_cast<char>(static_cast<unsigned char>(letter) - '0');
    }
    return text;
  }

  std::vector<double> values_of(const pugi::xml_node& parent, ImportOutcome outcome, const std::string& reason) {
    std::vector<double> values;
    if (!parent) return values;
    for (const pugi::xml_node& layer : layers_of(parent)) {
      const std::string text = text_of(layer);
      std::size_t count = 0;
      for (const std::string_view word : list_values(text)) {
        const std::optional<double> value = number_from(word);
        if (!value) refuse(layer, fmt::format("value {} is not a number", ++count));
        values.push_back(*value);
        ++count;
      }
      if (count != layer_size())
        refuse(layer, fmt::format("has {} values, X_Voxels times Y_Voxels is {}", count, layer_size()));
      document_.mark(layer, outcome, reason);
    }
    return values;
  }

  // Sizes are 1 + GrowthAmplitude times the value; robots that grow keep the size that they begin with.
  void read_growth(const pugi::xml_node& structure, const pugi::xml_node& environment) {
    const double amplitude = number_in(environment, "GrowthAmplitude").value_or(0);
    model_.size = values_of(structure.child("InitialVoxelSize"), approximated,
                            "rest lengths of springs; the robot stretches into this size when it starts");
    if (model_.size.empty()) {
      mark(environment, "GrowthAmplitude", ignored, "robots of Mercury do not grow");
      return;
    }
    constexpr double least = 0.1;  // MinTempFact
    for (double& size : model_.size) size = std::max(least, 1 + amplitude * size);
    mark(environment, "GrowthAmplitude", approximated, "factor of InitialVoxelSize");
  }

  XmlDocument& document_;
  VxaModel model_;
};

}  // namespace

VxaModel read_vxa(XmlDocument& document, bool is_voxcraft) { return VxaReader(document, is_voxcraft).read(); }

}  // namespace mercury
