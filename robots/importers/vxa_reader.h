// SPDX-License-Identifier: Apache-2.0
// What a VXA file says, as VoxCAD, evosoro and voxcraft-sim read it (CVX_Sim::ReadXML, CVX_Environment::ReadXML,
// CVX_Object::ReadXML of these programs).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "robots/importers/xml_document.h"

namespace mercury {

struct VxaMaterial {
  std::string name;
  pugi::xml_node element;
  double elastic_modulus = 0;  // [Pa]
  double density = 0;          // [kg/m3]
  double expansion = 0;        // CTE [1/degree]
  double phase = 0;            // MaterialTempPhase [rad]
  double friction = 0;         // uDynamic [1]
  double static_friction = 0;  // uStatic [1]
  bool held = false;           // Fixed of voxcraft-sim
};

struct VxaModel {
  // Whether voxcraft-sim is its program, which has rules of its own about temperature.
  bool is_voxcraft = false;
  bool half_wave = false;  // voxcraft-sim without EnableExpansion: temperatures above the base are cut off

  double edge = 0.001;                 // Lattice_Dim [m]
  std::vector<VxaMaterial> materials;  // the palette; voxels count from 1
  int nx = 1, ny = 1, nz = 1;
  std::vector<std::uint8_t> cells;  // x fastest, then y; 0 = empty

  // One value per cell, or empty.
  std::vector<double> phase_offset;      // [turns]
  std::vector<double> elastic_modulus;   // in place of the material's [Pa]
  std::vector<double> amplitude_factor;  // TempAmpDamp [1]
  std::vector<double> period;            // in place of TempPeriod [s]
  std::vector<double> size;              // InitialVoxelSize, as a factor [1]
  std::vector<bool> held;                // by a region or its material; empty = none

  bool gravity_enabled = true, floor_enabled = true, self_collision = false;
  double gravity = -9.81;  // [m/s2]
  bool temperature_varies = false;
  double temperature_amplitude = 0;  // above the base [degrees]
  double temperature_period = 0.1;   // [s]
  bool in_fluid = false;
  double drag_coefficient = 0;                  // AggregateDragCoefficient, rho C_D / 2 [kg/m3]
  double slow_damping = 0;                      // SlowDampingZ [1]
  double bond_damping = 0;                      // BondDampingZ [1]
  std::optional<double> stop_time, start_time;  // [s]
  std::vector<std::string> decisive, notes;     // of the report
};

// Reads the document and marks what it used. Throws InputError with the place in the document.
VxaModel read_vxa(XmlDocument& document, bool is_voxcraft);

// Why an element of a VXA file is ignored that the reader does not use, although it is known; empty = unknown.
std::string_view known_vxa_element(std::string_view place);

}  // namespace mercury
