// SPDX-License-Identifier: Apache-2.0
// VXA files: from what they say to robots and settings. docs/import.md describes the mapping.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "mercury/error.h"
#include "robots/importers/calibration.h"
#include "robots/importers/report_builder.h"
#include "robots/importers/vxa_reader.h"

namespace mercury {
namespace {

// Spheres of 1.5 voxels around the middles of voxels touch where sides are 0.44 of an edge apart, in the mean over all
// ways in which two walls can face each other. Walls of corners and middles touch so at this distance.
constexpr double contact_distance = 0.615;  // [edges]

class VxaImport {
 public:
  VxaImport(XmlDocument& document, bool is_voxcraft, std::string name, const ImportOptions& options)
      : document_(document), model_(read_vxa(document, is_voxcraft)), name_(std::move(name)), options_(options) {
    for (const std::uint8_t cell : model_.cells)
      if (cell > 0) ++voxels_;
    if (voxels_ == 0) return;
    density_ = mean([&](std::size_t cell) { return material_of_cell(cell).density; });
    for (std::size_t cell = 0; cell < model_.cells.size(); ++cell)
      if (model_.cells[cell] > 0) stiffest_ = std::max(stiffest_, modulus_of_cell(cell));
    try {
      scaling_.emplace(model_.edge, stiffest_, density_, model_.gravity);
    } catch (const InputError& error) {
      throw InputError("/VXA/VXC/Palette", error.what());
    }
  }

  Import run() {
    Import import;
    import.report.format = model_.is_voxcraft ? "VXA of voxcraft-sim" : "VXA of VoxCAD or evosoro";
    import.report.decisive = model_.decisive;
    if (voxels_ == 0) {
      import.report.notes.emplace_back("it has no voxels: a base, for .vxd files to say them");
      import.report.elements = document_.elements(known_vxa_element);
      return import;
    }
    import.report.length_scale = scaling_->calibration.length_scale;
    import.report.time_scale = scaling_->calibration.time_scale;
    import.settings = settings();
    stiffness_scale_ = import.settings.stiffness_scale;
    const Provenance provenance{.file = name_,
                                .format = import.report.format,
                                .length_scale = scaling_->calibration.length_scale,
                                .time_scale = scaling_->calibration.time_scale,
                                .environment = import.settings.environment};
    try {
      add_bodies(body(import.report), name_, provenance, options_, import, rule(), relaxation_time());
    } catch (const InputError& error) {
      throw InputError("/VXA/VXC/Structure", error.what());
    }
    set_relaxation_time(import.robots);
    if (import.settings.environment == "land") set_contact_distance(import);
    import.settings.dt = stable_time_step(import.robots, import.settings.stiffness_scale);
    if (import.settings.environment == "resistive") set_drag(import);
    import.report.elements = document_.elements(known_vxa_element);
    return import;
  }

 private:
  const VxaMaterial& material_of_cell(std::size_t cell) const { return model_.materials[model_.cells[cell] - 1u]; }

  double modulus_of_cell(std::size_t cell) const {
    return model_.elastic_modulus.empty() ? material_of_cell(cell).elastic_modulus : model_.elastic_modulus[cell];
  }

  // Over the voxels.
  template <class Value>
  double mean(const Value& value) const {
    double sum = 0;
    for (std::size_t cell = 0; cell < model_.cells.size(); ++cell)
      if (model_.cells[cell] > 0) sum += value(cell);
    return sum / static_cast<double>(voxels_);
  }

  ImportedSettings settings() const {
    ImportedSettings settings;
    settings.self_collision = model_.self_collision;
    settings.gravity = model_.gravity_enabled ? std::copysign(scaling_->calibration.gravity, model_.gravity) : 0;
    settings.environment = model_.in_fluid ? "resistive" : model_.floor_enabled ? "land" : "ocean-simple";
    if (model_.in_fluid) settings.gravity = 0;
    if (settings.environment == "land") {
      settings.stiffness_scale = land_stiffness_scale;
      settings.friction = mean([&](std::size_t cell) { return material_of_cell(cell).friction; });
      const double at_rest = mean([&](std::size_t cell) { return material_of_cell(cell).static_friction; });
      settings.static_friction = at_rest > settings.friction ? at_rest : 0;
      settings.contact_stiffness = scaling_->calibration.contact_stiffness / settings.stiffness_scale;
    }
    settings.damping = scaling_->damping(
        model_.slow_damping, mean([&](std::size_t cell) { return std::sqrt(modulus_of_cell(cell) / stiffest_); }));
    if (model_.stop_time) settings.seconds = *model_.stop_time * scaling_->calibration.time_scale;
    if (model_.start_time) settings.settle = *model_.start_time * scaling_->calibration.time_scale;
    return settings;
  }

  // Swimmers bend and weigh nothing; on the floor legs carry a weight.
  SpringRule rule() const {
    if (model_.in_fluid) return SpringRule::bending;
    return model_.floor_enabled ? SpringRule::standing : SpringRule::stretching;
  }

  // A bond of modulus E between voxels of mass m resists its rate of length by zeta sqrt(k m), k = E edge:
  // CVXS_BondInternal of evosoro takes half of 2 zeta sqrt(k m). Over k, that is zeta edge sqrt(rho / E) [s].
  double relaxation_time() const {
    if (!(model_.bond_damping > 0)) return 0;
    const double share = mean([&](std::size_t cell) { return std::sqrt(1 / modulus_of_cell(cell)); });
    return model_.bond_damping * model_.edge * std::sqrt(density_) * share * scaling_->calibration.time_scale;
  }

  // Of the robots whose springs have none of their own.
  void set_relaxation_time(std::vector<Robot>& robots) const {
    for (Robot& robot : robots)
      for (std::size_t id = 1; id < robot.materials.size(); ++id)
        if (float& time = robot.materials[id].relaxation_time; time == 0) time = static_cast<float>(relaxation_time());
  }

  // Where bodies have masses in the middles of voxels.
  static void set_contact_distance(Import& import) {
    double shortest = imported_edge;
    for (const Robot& robot : import.robots)
      for (const Spring& spring : robot.springs) shortest = std::min(shortest, static_cast<double>(spring.rest_length));
    if (shortest < 0.9 * imported_edge)
      import.settings.contact_distance = std::clamp(contact_distance * imported_edge / shortest, 0.1, 1.5);
  }

  // The drag of the calibration, for the mass that the robots have per voxel.
  void set_drag(Import& import) const {
    double masses = 0;  // [kg]
    for (const Robot& robot : import.robots)
      for (std::size_t i = 0; i < robot.masses.size(); ++i) masses += static_cast<double>(mass_of(robot, i));
    BeamModel model = scaling_->model;
    model.aggregate_drag = model_.drag_coefficient;
    model.thickness = 0;  // 1 kg per voxel
    const Calibration bulk = calibrate(model, scaling_->calibration.time_scale);
    import.settings.drag_coefficient = bulk.drag_coefficient * masses / static_cast<double>(voxels_);
  }

  // The substance of a voxel, apart from its size.
  Substance substance_of_cell(std::size_t cell) const {
    const VxaMaterial& material = material_of_cell(cell);
    Substance substance{.stiffness = scaling_->stiffness(modulus_of_cell(cell)) / stiffness_scale_};
    if (!model_.size.empty()) substance.size = model_.size[cell];
    double amplitude = material.expansion * model_.temperature_amplitude;
    if (!model_.amplitude_factor.empty()) amplitude *= model_.amplitude_factor[cell];
    if (!model_.temperature_varies || amplitude == 0) return substance;
    const double period = model_.period.empty() ? model_.temperature_period : model_.period[cell];
    substance.amplitude = std::clamp(amplitude, -largest_amplitude, largest_amplitude);
    substance.frequency = turn / (period * scaling_->calibration.time_scale);
    substance.half_wave = model_.half_wave;
    if (!model_.phase_offset.empty())
      substance.phase = turn * model_.phase_offset[cell];
    else if (!model_.is_voxcraft)
      substance.phase = material.phase;
    return substance;
  }

  // The grid. Where all voxels of a material have one substance, substances have the numbers of the palette.
  VoxelBody body(ImportReport& report) {
    VoxelBody body{.nx = model_.nx,
                   .ny = model_.ny,
                   .nz = model_.nz,
                   .cells = {},
                   .substances = {},
                   .names = {},
                   .held = model_.held};
    for (const VxaMaterial& material : model_.materials) {
      body.substances.emplace_back();
      body.names.push_back(material.name);
    }
    using Key = std::tuple<std::size_t, double, double, double, double, double>;
    std::map<Key, std::uint32_t> known;
    std::vector<bool> is_taken(model_.materials.size(), false);
    bool is_clamped = false;
    body.cells.reserve(model_.cells.size());
    for (std::size_t cell = 0; cell < model_.cells.size(); ++cell) {
      const std::size_t material = model_.cells[cell];
      if (material == 0) {
        body.cells.push_back(0);
        continue;
      }
      const Substance substance = substance_of_cell(cell);
      is_clamped = is_clamped || std::abs(substance.amplitude) == largest_amplitude;
      const auto [place, is_new] = known.try_emplace(
          Key{material, substance.stiffness, substance.amplitude, substance.frequency, substance.phase, substance.size},
          std::uint32_t{0});
      if (is_new && !is_taken[material - 1]) {
        is_taken[material - 1] = true;
        body.substances[material - 1] = substance;
        place->second = static_cast<std::uint32_t>(material);
      } else if (is_new) {
        body.substances.push_back(substance);
        body.names.push_back(model_.materials[material - 1].name);
        place->second = static_cast<std::uint32_t>(body.substances.size());
      }
      body.cells.push_back(place->second);
    }
    if (is_clamped)
      report.notes.push_back(fmt::format("amplitudes were limited to {}: a spring needs a length", largest_amplitude));
    return body;
  }

  XmlDocument& document_;
  VxaModel model_;
  std::optional<Scaling> scaling_;
  std::string name_;
  ImportOptions options_;
  std::size_t voxels_ = 0;
  double density_ = 0;          // mean over the voxels [kg/m3]
  double stiffest_ = 0;         // elastic modulus [Pa]
  double stiffness_scale_ = 1;  // of the environment
};

Import import_vxa(std::string_view text, std::string_view, const std::string& name, const ImportOptions& options) {
  XmlDocument document(text);
  return VxaImport(document, false, name, options).run();
}

Import import_vxd(std::string_view text, std::string_view base, const std::string& name, const ImportOptions& options) {
  const XmlDocument changes(text);
  XmlDocument document(base, "base: ");
  std::vector<ImportedElement> unused;
  merge_vxd(changes, document, unused);
  Import import = VxaImport(document, true, name, options).run();
  import.report.format = "VXD of voxcraft-sim";
  import.report.elements.insert(import.report.elements.begin(), unused.begin(), unused.end());
  return import;
}

constexpr std::string_view programs = "VoxCAD, evosoro and voxcraft-sim";

}  // namespace

ImportFormat vxa_format() {
  return {.name = "vxa", .extensions = ".vxa .vxc", .programs = programs, .read = import_vxa};
}

ImportFormat vxd_format() {
  return {.name = "vxd",
          .extensions = ".vxd",
          .programs = programs,
          .base_name = "base.vxa",
          .needs_base = true,
          .read = import_vxd};
}

}  // namespace mercury
