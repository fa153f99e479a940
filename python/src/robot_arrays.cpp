// SPDX-License-Identifier: Apache-2.0
#include "python/src/robot_arrays.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mercury/error.h"
#include "mercury/names.h"
#include "python/src/values.h"

namespace mercury::python {
namespace {

// str(value)
std::string as_text(const nb::object& value) { return nb::cast<std::string>(nb::steal(PyObject_Str(value.ptr()))); }

nb::module_ numpy() { return nb::module_::import_("numpy"); }

// numpy.asarray, with one line for what it refuses: ragged lists, memory of a GPU.
nb::object as_array(const std::string& what, nb::handle given) {
  try {
    return numpy().attr("asarray")(given);
  } catch (const nb::python_error& error) {
    const bool is_type = error.matches(PyExc_TypeError);
    if (!is_type && !error.matches(PyExc_ValueError)) throw;
    std::string reason = as_text(nb::borrow(error.value()));
    reason = what + ": must be an array of numbers: " + reason.substr(0, reason.find('\n'));
    if (is_type) throw nb::type_error(reason.c_str());
    throw InputError(reason);
  }
}

char kind_of(nb::handle array) { return nb::cast<std::string>(array.attr("dtype").attr("kind"))[0]; }

void require_numbers(const std::string& what, nb::handle array) {
  const char kind = kind_of(array);
  if (kind != 'i' && kind != 'u' && kind != 'f')
    throw nb::type_error((what + ": must be an array of numbers, not of " + as_text(array.attr("dtype"))).c_str());
}

std::string shape_of(nb::handle array) { return as_text(array.attr("shape")); }

// A copy in double precision, which no other thread changes.
nb::object copied(nb::handle array, const char* order) {
  return numpy().attr("array")(array, nb::arg("dtype") = "float64", nb::arg("order") = order);
}

// Numbers row after row, in double precision, which holds every index and every float exactly.
class Table {
 public:
  // Fields of a structured array become columns; the last `optional` ones may be missing.
  Table(const std::string& what, nb::handle given, const std::vector<std::string>& fields, std::size_t optional = 0) {
    nb::object array = as_array(what, given);
    if (!array.attr("dtype").attr("names").is_none()) array = columns(what, array, fields, optional);
    require_numbers(what, array);
    const auto dimensions = nb::cast<std::size_t>(array.attr("ndim"));
    const auto shape = nb::cast<std::vector<std::size_t>>(nb::list(array.attr("shape")));
    if (dimensions == 1 && shape[0] == 0) return;  // [] is a table without rows
    if (dimensions != 2 || shape[1] > fields.size() || shape[1] + optional < fields.size()) {
      std::string wanted = "(n, " + std::to_string(fields.size() - optional) + ")";
      if (optional > 0) wanted += (optional > 1 ? " to (n, " : " or (n, ") + std::to_string(fields.size()) + ")";
      throw InputError(what, "must have the shape " + wanted + ", not " + shape_of(array));
    }
    numbers_ = nb::cast<Numbers>(copied(array, "C"));
    rows_ = numbers_.shape(0);
    columns_ = numbers_.shape(1);
  }
  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  const double* row(std::size_t i) const { return numbers_.data() + i * columns_; }

 private:
  using Numbers = nb::ndarray<nb::numpy, const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

  static nb::object columns(const std::string& what, nb::handle array, const std::vector<std::string>& fields,
                            std::size_t optional) {
    const auto names = nb::cast<std::vector<std::string>>(nb::list(array.attr("dtype").attr("names")));
    for (const std::string& name : names)
      if (std::ranges::find(fields, name) == fields.end())
        throw InputError(what, "has no field \"" + name + "\"" + suggestion(name, fields));
    nb::list columns;
    const std::size_t rows = nb::len(array);
    // An optional field that is missing before one that is there is a column of zeros.
    std::size_t last = 0;
    for (std::size_t i = 0; i < fields.size(); ++i)
      if (std::ranges::find(names, fields[i]) != names.end()) last = i;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (std::ranges::find(names, fields[i]) == names.end()) {
        if (i + optional < fields.size()) throw InputError(what, "the field \"" + fields[i] + "\" is missing");
        if (i < last) columns.append(numpy().attr("zeros")(rows));
        continue;
      }
      const nb::object column = array[fields[i].c_str()];
      require_numbers(what + "[\"" + fields[i] + "\"]", column);
      if (nb::cast<std::size_t>(column.attr("ndim")) != 1)
        throw InputError(what, "a structured array must have the shape (n,), with one number per field");
      columns.append(column.attr("astype")("float64"));
    }
    return numpy().attr("column_stack")(columns);
  }

  std::size_t rows_ = 0, columns_ = 0;
  Numbers numbers_;
};

std::string text_of(double number) { return as_text(nb::float_(number)); }

bool is_index(double number, std::size_t count) {
  return number >= 0 && number < static_cast<double>(count) && number == std::floor(number);
}

// Says what is wrong with an index that is none of `count` things. "/springs/7: mass 912 is out of range, the robot has
// 300"
[[noreturn]] void refuse_index(const std::string& where, const char* thing, double number, const char* owner,
                               std::size_t count) {
  if (!std::isfinite(number) || number != std::floor(number))
    throw InputError(where, std::string(thing) + " " + text_of(number) + " is not a whole number");
  std::string digits = std::to_string(number);
  digits.resize(digits.find('.'));
  throw InputError(
      where, std::string(thing) + " " + digits + " is out of range, the " + owner + " has " + std::to_string(count));
}

std::uint16_t mass_from(const std::string& list, std::size_t row, double number, const Robot& robot) {
  if (!is_index(number, robot.masses.size()))
    refuse_index(list + std::to_string(row), "mass", number, "robot", robot.masses.size());
  return static_cast<std::uint16_t>(number);
}

// Indices of a robot's springs or masses, or a mask with one bool for each. `thing`: "spring".
std::vector<std::uint32_t> indices_from(const std::string& what, nb::handle given, const char* thing,
                                        const char* things, std::size_t count) {
  nb::object array = as_array(what, given);
  if (nb::cast<std::size_t>(array.attr("ndim")) != 1)
    throw InputError(what,
                     std::string("must be a list of ") + thing + " indices, or a mask with one bool per " + thing);
  if (kind_of(array) == 'b') {
    if (nb::len(array) != count)
      throw InputError(what, "a mask of " + std::to_string(nb::len(array)) + " " + things +
                                 " is not accepted, the robot has " + std::to_string(count));
    array = numpy().attr("flatnonzero")(array);
  }
  require_numbers(what, array);
  using Numbers = nb::ndarray<nb::numpy, const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
  const auto numbers = nb::cast<Numbers>(copied(array, "C"));
  std::vector<std::uint32_t> indices(numbers.shape(0));
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const double number = numbers.data()[i];
    if (!is_index(number, count)) refuse_index(what, thing, number, "robot", count);
    indices[i] = static_cast<std::uint32_t>(number);
  }
  return indices;
}

// One number or row per mass. A single one stands for all.
nb::object for_all_masses(const std::string& what, nb::handle given, const nb::tuple& shape) {
  const nb::object array = as_array(what, given);
  require_numbers(what, array);
  const auto dimensions = nb::cast<std::size_t>(array.attr("ndim"));
  if (dimensions + 1 == nb::len(shape)) {
    if (dimensions == 0 || array.attr("shape")[nb::int_(-1)].equal(shape[nb::len(shape) - 1]))
      return copied(numpy().attr("broadcast_to")(array, shape), "C");
  } else if (array.attr("shape").equal(shape)) {
    return copied(array, "C");
  }
  throw InputError(what, "must have the shape " + as_text(shape) + ", one per mass, not " + shape_of(array));
}

// A read-only array over `rows` structs.
template <class Struct>
nb::object view(nb::handle owner, const Struct* data, std::size_t rows, nb::handle dtype) {
  const nb::ndarray<nb::numpy, const std::uint8_t, nb::ndim<1>> bytes(reinterpret_cast<const std::uint8_t*>(data),
                                                                      {rows * sizeof(Struct)}, owner);
  return nb::cast(bytes).attr("view")(dtype);
}

template <class Struct>
nb::object view(nb::handle owner, const Struct* data, std::size_t rows, const char* dtype, std::size_t columns) {
  return view(owner, data, rows, nb::str(dtype)).attr("reshape")(rows, columns);
}

}  // namespace

std::vector<Vec3> masses_from(nb::handle array) {
  const Table table("masses", array, {"x", "y", "z"});
  if (table.rows() == 0) throw InputError("/masses", "a robot needs at least one mass");
  if (table.rows() > max_masses)
    throw InputError("/masses", std::to_string(table.rows()) + " masses, at most 65535 are accepted");
  std::vector<Vec3> masses(table.rows());
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const double* row = table.row(i);
    masses[i] = {static_cast<float>(row[0]), static_cast<float>(row[1]), static_cast<float>(row[2])};
  }
  return masses;
}

std::vector<Spring> springs_from(nb::handle array, const Robot& robot) {
  const Table table("springs", array, {"a", "b", "material", "rest_length"}, 1);
  const std::size_t materials = materials_of(robot).size();
  std::vector<Spring> springs(table.rows());
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const double* row = table.row(i);
    Spring& spring = springs[i];
    spring.a = mass_from("/springs/", i, row[0], robot);
    spring.b = mass_from("/springs/", i, row[1], robot);
    if (!is_index(row[2], materials))
      refuse_index("/springs/" + std::to_string(i), "material", row[2], "table", materials);
    spring.material = static_cast<MaterialId>(row[2]);
    spring.rest_length = table.columns() == 4 ? static_cast<float>(row[3]) : rest_distance(robot, spring.a, spring.b);
  }
  return springs;
}

std::vector<Face> faces_from(nb::handle array, const Robot& robot) {
  const Table table("faces", array, {"a", "b", "c"});
  std::vector<Face> faces(table.rows());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const double* row = table.row(i);
    const auto corner = [&](std::size_t k) { return mass_from("/faces/", i, row[k], robot); };
    faces[i] = {corner(0), corner(1), corner(2)};
  }
  return faces;
}

std::vector<Material> materials_from(nb::handle array) {
  const Table table("materials", array,
                    {"stiffness", "amplitude", "frequency", "phase", "half_wave", "relaxation_time"}, 2);
  if (table.rows() > max_materials)
    throw InputError("/materials", std::to_string(table.rows()) + " materials, at most 256 are accepted");
  if (table.rows() == 0) throw InputError("/materials", "a table needs at least row 0, which stands for air");
  std::vector<Material> materials(table.rows());
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const double* row = table.row(i);
    materials[i] = {static_cast<float>(row[0]), static_cast<float>(row[1]), static_cast<float>(row[2]),
                    static_cast<float>(row[3])};
    if (table.columns() < 5) continue;
    if (row[4] != 0 && row[4] != 1)
      throw InputError("/materials/" + std::to_string(i), "half_wave must be 0 or 1, not " + text_of(row[4]));
    materials[i].half_wave = row[4] != 0;
    if (table.columns() > 5) materials[i].relaxation_time = static_cast<float>(row[5]);
  }
  return materials;
}

std::vector<float> mass_from(nb::handle given, const Robot& robot) {
  using Numbers = nb::ndarray<nb::numpy, const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
  const auto numbers = nb::cast<Numbers>(for_all_masses("mass", given, nb::make_tuple(robot.masses.size())));
  std::vector<float> mass(numbers.shape(0));
  for (std::size_t i = 0; i < mass.size(); ++i) mass[i] = static_cast<float>(numbers.data()[i]);
  return mass;
}

std::vector<Vec3> velocity_from(nb::handle given, const Robot& robot) {
  using Numbers = nb::ndarray<nb::numpy, const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
  const auto numbers = nb::cast<Numbers>(for_all_masses("velocity", given, nb::make_tuple(robot.masses.size(), 3)));
  std::vector<Vec3> velocity(numbers.shape(0));
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const double* v = numbers.data() + 3 * i;
    velocity[i] = {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  }
  return velocity;
}

std::vector<std::uint16_t> fixed_from(nb::handle given, const Robot& robot) {
  const auto indices = indices_from("fixed", given, "mass", "masses", robot.masses.size());
  return {indices.begin(), indices.end()};
}

VoxelGrid grid_from(nb::handle given) {
  const nb::object array = as_array("grid", given);
  require_numbers("grid", array);
  if (nb::cast<std::size_t>(array.attr("ndim")) != 3)
    throw InputError("grid", "must have the shape (x, y, z), not " + shape_of(array));
  if (nb::cast<std::size_t>(array.attr("size")) > VoxelGrid::max_cells)
    throw InputError("grid", "a shape of " + shape_of(array) + " is too large");
  using Numbers = nb::ndarray<nb::numpy, const double, nb::ndim<3>, nb::f_contig, nb::device::cpu>;
  const auto numbers = nb::cast<Numbers>(copied(array, "F"));
  const auto size = [&](std::size_t axis) {
    return static_cast<int>(std::min(numbers.shape(axis), VoxelGrid::max_cells + 1));
  };
  VoxelGrid grid(size(0), size(1), size(2));
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    const double number = numbers.data()[i];
    if (!is_index(number, base_material_count + 1))
      throw InputError("grid", "material " + as_text(nb::float_(number)) + " is not accepted; give 0 to " +
                                   std::to_string(base_material_count));
    grid.cells[i] = static_cast<MaterialId>(number);
  }
  return grid;
}

void add_actuators(Robot& robot, nb::handle actuators) {
  if (!nb::isinstance<nb::dict>(actuators)) refuse_type("actuators", "a dict of names and spring indices", actuators);
  // A copy, since making arrays may run code that changes the dict.
  for (const nb::handle item : nb::list(actuators.attr("items")())) {
    const std::string name = text_from("actuators", item[0]);
    add_actuator(robot, name, indices_from("actuator " + name, item[1], "spring", "springs", robot.springs.size()));
  }
}

nb::object masses_view(nb::handle owner, const Robot& robot) {
  static_assert(sizeof(Vec3) == 12);
  return view(owner, robot.masses.data(), robot.masses.size(), "float32", 3);
}

nb::object springs_view(nb::handle owner, const Robot& robot) {
  const auto bytes = [](std::size_t count) { return nb::int_(count); };
  nb::dict layout;
  layout["names"] = nb::make_tuple("a", "b", "material", "rest_length");
  layout["formats"] = nb::make_tuple("uint16", "uint16", "uint8", "float32");
  layout["offsets"] = nb::make_tuple(bytes(offsetof(Spring, a)), bytes(offsetof(Spring, b)),
                                     bytes(offsetof(Spring, material)), bytes(offsetof(Spring, rest_length)));
  layout["itemsize"] = bytes(sizeof(Spring));
  return view(owner, robot.springs.data(), robot.springs.size(), numpy().attr("dtype")(layout));
}

nb::object faces_view(nb::handle owner, const Robot& robot) {
  static_assert(sizeof(Face) == 6);
  return view(owner, robot.faces.data(), robot.faces.size(), "uint16", 3);
}

nb::object materials_view(nb::handle owner, const Robot& robot) {
  static_assert(offsetof(Material, phase) == 12 && sizeof(Material) % sizeof(float) == 0);
  const std::span<const Material> materials = materials_of(robot);
  return nb::cast(nb::ndarray<nb::numpy, const float, nb::ndim<2>>(
      &materials.data()->stiffness, {materials.size(), 4}, owner,
      {static_cast<std::int64_t>(sizeof(Material) / sizeof(float)), 1}));
}

nb::object half_wave_view(nb::handle owner, const Robot& robot) {
  const std::span<const Material> materials = materials_of(robot);
  return nb::cast(nb::ndarray<nb::numpy, const bool, nb::ndim<1>>(
      &materials.data()->half_wave, {materials.size()}, owner, {static_cast<std::int64_t>(sizeof(Material))}));
}

nb::object relaxation_time_view(nb::handle owner, const Robot& robot) {
  const std::span<const Material> materials = materials_of(robot);
  return nb::cast(
      nb::ndarray<nb::numpy, const float, nb::ndim<1>>(&materials.data()->relaxation_time, {materials.size()}, owner,
                                                       {static_cast<std::int64_t>(sizeof(Material) / sizeof(float))}));
}

nb::object mass_view(nb::handle owner, const Robot& robot) {
  if (robot.mass.empty()) return numpy().attr("ones")(robot.masses.size(), nb::arg("dtype") = "float32");
  return nb::cast(nb::ndarray<nb::numpy, const float, nb::ndim<1>>(robot.mass.data(), {robot.mass.size()}, owner));
}

nb::object velocity_view(nb::handle owner, const Robot& robot) {
  if (robot.velocity.empty())
    return numpy().attr("zeros")(nb::make_tuple(robot.masses.size(), 3), nb::arg("dtype") = "float32");
  return view(owner, robot.velocity.data(), robot.velocity.size(), "float32", 3);
}

nb::object fixed_view(nb::handle owner, const Robot& robot) {
  return nb::cast(
      nb::ndarray<nb::numpy, const std::uint16_t, nb::ndim<1>>(robot.fixed.data(), {robot.fixed.size()}, owner));
}

}  // namespace mercury::python
