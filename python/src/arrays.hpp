// Arrays of numpy as spans of the library, and the library's vectors as arrays, without copies.
// Both go through Python's buffer protocol, which is the same for every numpy: pybind11's own
// arrays read numpy's structs, whose layout changed with numpy 2.
#pragma once

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

/// A C-contiguous array of numpy, kept while this object or a copy lives. Other arrays are
/// converted when they are passed. Copies and the destructor need the interpreter's lock.
template <class T>
class Array {
 public:
  Array() = default;  ///< for pybind11, which assigns the passed array
  explicit Array(py::buffer_info buffer)
      : buffer_(std::make_shared<py::buffer_info>(std::move(buffer))) {}

  py::ssize_t ndim() const { return buffer_->ndim; }
  py::ssize_t shape(py::ssize_t axis) const {
    return buffer_->shape[static_cast<std::size_t>(axis)];
  }
  py::ssize_t size() const { return buffer_->size; }
  const T* data() const { return static_cast<const T*>(buffer_->ptr); }

 private:
  std::shared_ptr<py::buffer_info> buffer_;
};

/// "(5, 2)".
template <class T>
std::string shape_text(const Array<T>& array) {
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
                     "; it must have shape (n, " + std::to_string(columns) + ")");
  }
  return {reinterpret_cast<const Row*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

/// The values of an array of shape (n,). Errors: InputError for another shape.
template <class T>
std::span<const T> values_of(const Array<T>& array, const char* name) {
  if (array.ndim() != 1) {
    throw InputError(std::string(name) + ": the array has shape " + shape_text(array) +
                     "; it must have shape (n,)");
  }
  return {array.data(), static_cast<std::size_t>(array.shape(0))};
}

/// Memory that numpy makes an array of by the buffer protocol.
struct ArrayMemory {
  py::object owner;  ///< keeps the memory
  const void* data;
  py::ssize_t item_size;
  std::string format;  ///< as in Python's module struct
  std::vector<py::ssize_t> shape;
  bool read_only;
};

/// Defines ArrayMemory in the module.
inline void define_array_memory(py::module_& module) {
  py::class_<ArrayMemory>(module, "ArrayMemory", py::buffer_protocol())
      .def_buffer([](const ArrayMemory& memory) {
        return py::buffer_info(const_cast<void*>(memory.data), memory.item_size, memory.format,
                               static_cast<py::ssize_t>(memory.shape.size()), memory.shape,
                               py::detail::c_strides(memory.shape, memory.item_size),
                               memory.read_only);
      });
}

template <class T>
py::object array_over(py::object owner, std::vector<py::ssize_t> shape, const void* data,
                      bool read_only) {
  return py::module_::import("numpy").attr("asarray")(
      ArrayMemory{std::move(owner), data, sizeof(T), py::format_descriptor<T>::format(),
                  std::move(shape), read_only});
}

/// A read-only array over memory that `owner` keeps.
template <class T>
py::object view(const py::object& owner, std::vector<py::ssize_t> shape, const void* data) {
  return array_over<T>(owner, std::move(shape), data, true);
}

/// A read-only array of shape (n, components) over a vector that `owner` keeps.
template <class T, class Row>
py::object view_rows(const py::object& owner, const std::vector<Row>& rows) {
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
py::object taken(std::vector<Row> rows, std::vector<py::ssize_t> shape) {
  auto kept = std::make_unique<std::vector<Row>>(std::move(rows));
  const void* const data = kept->data();
  py::capsule owner(kept.get(),
                    [](void* memory) { delete static_cast<std::vector<Row>*>(memory); });
  kept.release();
  return array_over<T>(std::move(owner), std::move(shape), data, false);
}

}  // namespace photile::python

/// Anything that numpy makes an array of is an Array, its values converted to T.
template <class T>
struct pybind11::detail::type_caster<photile::python::Array<T>> {
  PYBIND11_TYPE_CASTER(photile::python::Array<T>, const_name("numpy.ndarray"));

  bool load(handle source, bool) {
    try {
      // Contiguous, aligned, and an array itself, not of a derived class.
      const object array =
          module_::import("numpy").attr("require")(source, format_descriptor<T>::format(), "CAE");
      value = photile::python::Array<T>(reinterpret_borrow<buffer>(array).request());
      return true;
    } catch (error_already_set& error) {
      for (PyObject* const type : {PyExc_TypeError, PyExc_ValueError, PyExc_OverflowError}) {
        if (error.matches(type)) return false;
      }
      throw;
    }
  }
};
