// The module photile._photile, on which the package photile stands: everything that needs the
// library. What users see, with its documentation, is in python/photile/*.py.
#include <pybind11/pybind11.h>

#include "arrays.hpp"
#include "parts.hpp"
#include "photile/defaults.hpp"
#include "photile/errors.hpp"

namespace py = pybind11;

namespace {

/// Raises the exception of this name in photile/errors.py.
void raise(const char* name, const photile::Error& error, const char* log = nullptr) {
  const py::object type = py::module_::import("photile.errors").attr(name);
  py::object exception = type(error.what());
  if (log) exception.attr("build_log") = log;
  PyErr_SetObject(type.ptr(), exception.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const photile::KernelBuildError& error) {
    raise("KernelBuildError", error, error.build_log.c_str());
  } catch (const photile::DeviceMemoryError& error) {
    raise("DeviceMemoryError", error);
  } catch (const photile::DeviceError& error) {
    raise("DeviceError", error);
  } catch (const photile::UsageError& error) {
    raise("UsageError", error);
  } catch (const photile::InputError& error) {
    raise("InputError", error);
  } catch (const photile::OutputError& error) {
    raise("OutputError", error);
  } catch (const photile::Error& error) {
    raise("Error", error);
  } catch (const py::cast_error&) {
    raise("UsageError", photile::UsageError("a value has another type than its parameter"));
  }
}

}  // namespace

PYBIND11_MODULE(_photile, module) {
  py::register_exception_translator(&translate);
  module.attr("version") = PHOTILE_VERSION;
  module.attr("none") = 0xFFFF'FFFFu;
  module.attr("lumen_per_watt") = photile::defaults::lumen_per_watt;
  module.attr("ground_reflectance") = photile::defaults::ground_reflectance;
  module.attr("wall_band") = photile::defaults::wall_band;
  photile::python::define_array_memory(module);
  photile::python::define_work(module);
  photile::python::define_devices(module);
  photile::python::define_scenes(module);
  photile::python::define_photons(module);
  photile::python::define_pictures(module);
  photile::python::define_grids(module);
  photile::python::define_measuring(module);
  photile::python::define_glare(module);
  photile::python::define_daylight(module);
  photile::python::define_outlooks(module);
}
