// Arrays of numpy as spans of the library, and the library's vectors as arrays, without copies.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "photile/errors.hpp"

namespace photile::python {

namespace py = pybind11;

/// C-contiguous; other arrays are converted when they are passed.
template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// "(5, 2)".
inline std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  }
  return text + ")";
}

/// The rows of an array of shape (n, sizeof(Row) / sizeof(T)), which has to outlive them.
/// Errors: InputError for another shape.
template <class Row, class T>
std::span<const Row> rows_of(const Array<T>& array, const char* name) {
  constexpr auto columns = static_cast<py::ssize_t>(sizeof(Row) / sizeof(T));
  if (array.ndim() != 2 || array.shape(1) != columns) {
    throw InputError(std::string(name) + ": the array has shape " + shape_text(array) +
                     ", and has to have (n, " + std::to_string(columns) + ")");
  }
  return {reinterpret_cast<const Row*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

/// The values of an array of shape (n,). Errors: InputError for another shape.
template <class T>
std::span<const T> values_of(const Array<T>& array, const char* name) {
  if (array.ndim() != 1) {
    throw InputError(std::string(name) + ": the array has shape " + shape_text(array) +
                     ", and has to have (n,)");
  }
  return {array.data(), static_cast<std::size_t>(array.shape(0))};
}

/// A read-only array over memory that `owner` keeps.
template <class T>
py::array view(const py::object& owner, std::vector<py::ssize_t> shape, const void* data) {
  py::array array(py::dtype::of<T>(), std::move(shape), data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// A read-only array of shape (n, components) over a vector that `owner` keeps.
template <class T, class Row>
py::array view_rows(const py::object& owner, const std::vector<Row>& rows) {
  const auto count = static_cast<py::ssize_t>(rows.size());
  if constexpr (sizeof(Row) == sizeof(T)) {
    return view<T>(owner, {count}, rows.data());
  } else {
    constexpr auto columns = static_cast<py::ssize_t>(sizeof(Row) / sizeof(T));
    return view<T>(owner, {count, columns}, rows.data());
  }
}

/// An array that takes a vector over.
template <class T, class Row>
py::array taken(std::vector<Row> rows, std::vector<py::ssize_t> shape) {
  auto kept = std::make_unique<std::vector<Row>>(std::move(rows));
  const void* const data = kept->data();
  const py::capsule owner(kept.get(),
                          [](void* memory) { delete static_cast<std::vector<Row>*>(memory); });
  kept.release();
  return py::array(py::dtype::of<T>(), std::move(shape), data, owner);
}

}  // namespace photile::python
