// SPDX-License-Identifier: Apache-2.0
// Telemetry as a structured NumPy array.
#include "python/src/array.h"

#include <cstddef>
#include <cstdint>

namespace mercury::python {
namespace {

struct Row {
  float center_of_mass[3], velocity[3];
  double kinetic_energy, elastic_energy, muscle_power;
  float largest_strain, strained_share, inverted, overlap, upright;
  double exploded_at;
  std::int64_t culprit_spring;
  bool exploded;
};

struct Field {
  const char* name;
  const char* format;
  std::size_t offset;
};

constexpr Field fields[] = {
    {"center_of_mass", "(3,)f4", offsetof(Row, center_of_mass)},
    {"velocity", "(3,)f4", offsetof(Row, velocity)},
    {"kinetic_energy", "f8", offsetof(Row, kinetic_energy)},
    {"elastic_energy", "f8", offsetof(Row, elastic_energy)},
    {"muscle_power", "f8", offsetof(Row, muscle_power)},
    {"largest_strain", "f4", offsetof(Row, largest_strain)},
    {"strained_share", "f4", offsetof(Row, strained_share)},
    {"inverted", "f4", offsetof(Row, inverted)},
    {"overlap", "f4", offsetof(Row, overlap)},
    {"upright", "f4", offsetof(Row, upright)},
    {"exploded", "?", offsetof(Row, exploded)},
    {"exploded_at", "f8", offsetof(Row, exploded_at)},
    {"culprit_spring", "i8", offsetof(Row, culprit_spring)},
};

Row row_of(const Telemetry& from) {
  Row row{};
  const Vec3 x = from.center_of_mass, v = from.velocity;
  row.center_of_mass[0] = x.x, row.center_of_mass[1] = x.y, row.center_of_mass[2] = x.z;
  row.velocity[0] = v.x, row.velocity[1] = v.y, row.velocity[2] = v.z;
  row.kinetic_energy = from.kinetic_energy;
  row.elastic_energy = from.elastic_energy;
  row.muscle_power = from.muscle_power;
  row.largest_strain = from.largest_strain;
  row.strained_share = from.strained_share;
  row.inverted = from.inverted;
  row.overlap = from.overlap;
  row.upright = from.upright;
  row.exploded = from.exploded;
  row.exploded_at = from.exploded ? from.exploded_at : 0;
  row.culprit_spring = from.culprit_spring == no_spring ? -1 : static_cast<std::int64_t>(from.culprit_spring);
  return row;
}

nb::object row_type() {
  nb::list names, formats, offsets;
  for (const Field& field : fields) {
    names.append(field.name);
    formats.append(field.format);
    offsets.append(field.offset);
  }
  nb::dict description;
  description["names"] = names;
  description["formats"] = formats;
  description["offsets"] = offsets;
  description["itemsize"] = sizeof(Row);
  return nb::module_::import_("numpy").attr("dtype")(description);
}

}  // namespace

nb::object telemetry_array(std::span<const Telemetry> telemetry) {
  const nb::object array = nb::module_::import_("numpy").attr("zeros")(telemetry.size(), row_type());
  const auto address = nb::cast<std::uintptr_t>(array.attr("ctypes").attr("data"));
  for (std::size_t i = 0; i < telemetry.size(); ++i) reinterpret_cast<Row*>(address)[i] = row_of(telemetry[i]);
  return array;
}

}  // namespace mercury::python
