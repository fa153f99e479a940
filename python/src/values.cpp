// SPDX-License-Identifier: Apache-2.0
#include "python/src/values.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "mercury/error.h"

namespace mercury::python {
namespace {

std::string named_type(nb::handle value) { return nb::cast<std::string>(nb::type_name(value.type())); }

// The int of a whole number, of any size.
nb::object integer_from(const std::string& parameter, nb::handle value) {
  if (PyBool_Check(value.ptr())) refuse_type(parameter, "a whole number", value);
  PyObject* number = PyNumber_Index(value.ptr());
  if (!number) {
    if (!PyErr_ExceptionMatches(PyExc_TypeError)) throw nb::python_error();
    PyErr_Clear();
    refuse_type(parameter, "a whole number", value);
  }
  return nb::steal(number);
}

[[noreturn]] void refuse_range(const std::string& parameter, nb::handle number, const std::string& wanted) {
  std::string given = "a number this large";
  if (PyObject* text = PyObject_Str(number.ptr())) {
    if (nb::len(nb::handle(text)) <= 40) given = nb::cast<std::string>(nb::handle(text));
    Py_DECREF(text);
  } else {
    PyErr_Clear();  // numbers with thousands of digits have no text
  }
  throw ParameterError(parameter, given + " is not accepted; give " + wanted);
}

}  // namespace

void refuse_type(const std::string& parameter, const std::string& wanted, nb::handle given) {
  throw nb::type_error((parameter + ": must be " + wanted + ", not " + named_type(given)).c_str());
}

std::int64_t whole_from(const std::string& parameter, nb::handle value, std::int64_t lowest, std::int64_t highest) {
  const nb::object number = integer_from(parameter, value);
  std::int64_t result = 0;
  if (nb::try_cast(number, result) && result >= lowest && result <= highest) return result;
  const bool open = highest == std::numeric_limits<std::int64_t>::max();
  refuse_range(parameter, number,
               lowest == std::numeric_limits<std::int64_t>::min() ? "a whole number of at most 64 bits"
               : open                                             ? std::to_string(lowest) + " or more"
                      : std::to_string(lowest) + " to " + std::to_string(highest));
}

std::uint64_t seed_from(const std::string& parameter, nb::handle value) {
  const nb::object number = integer_from(parameter, value);
  std::uint64_t result = 0;
  if (!nb::try_cast(number, result)) refuse_range(parameter, number, "a whole number of 0 to 18446744073709551615");
  return result;
}

double number_from(const std::string& parameter, nb::handle value) {
  if (PyBool_Check(value.ptr()) || PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr()))
    refuse_type(parameter, "a number", value);
  const double number = PyFloat_AsDouble(value.ptr());
  if (number == -1.0 && PyErr_Occurred()) {
    const bool too_large = PyErr_ExceptionMatches(PyExc_OverflowError);
    if (!too_large && !PyErr_ExceptionMatches(PyExc_TypeError) && !PyErr_ExceptionMatches(PyExc_ValueError))
      throw nb::python_error();
    PyErr_Clear();
    if (too_large) throw ParameterError(parameter, "a number this large is not accepted; give a finite number");
    refuse_type(parameter, "a number", value);
  }
  return number;
}

bool bool_from(const std::string& parameter, nb::handle value) {
  if (PyBool_Check(value.ptr())) return value.ptr() == Py_True;
  if (nb::isinstance(value, nb::module_::import_("numpy").attr("bool_"))) return PyObject_IsTrue(value.ptr()) == 1;
  refuse_type(parameter, "True or False", value);
}

std::string text_from(const std::string& parameter, nb::handle value) {
  if (!PyUnicode_Check(value.ptr())) refuse_type(parameter, "a text", value);
  std::string text;
  if (!nb::try_cast(value, text)) throw InputError(parameter, "is not valid Unicode");
  return text;
}

std::filesystem::path path_from(const std::string& parameter, nb::handle value) {
  std::filesystem::path path;
  if (!nb::try_cast(value, path)) refuse_type(parameter, "a path (str or os.PathLike)", value);
  return path;
}

}  // namespace mercury::python
