// The parts of the module, each defined in the file of its name.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "photile/camera.hpp"
#include "photile/device.hpp"
#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/renderer.hpp"
#include "photile/scene.hpp"

namespace photile::python {

void define_work(pybind11::module_& module);
void define_devices(pybind11::module_& module);
void define_scenes(pybind11::module_& module);
void define_photons(pybind11::module_& module);
void define_pictures(pybind11::module_& module);
void define_grids(pybind11::module_& module);
void define_measuring(pybind11::module_& module);
void define_glare(pybind11::module_& module);
void define_daylight(pybind11::module_& module);
void define_outlooks(pybind11::module_& module);

using SharedScene = std::shared_ptr<Scene>;

/// Devices stay open while the process lives, with their kernels. One thread works with them at a
/// time.
struct OpenDevices {
  std::vector<Device> devices;
  std::mutex mutex;
};

/// What a value is called that cannot be a T.
template <class T>
constexpr const char* expected() {
  if constexpr (std::is_same_v<T, bool>) return "True or False";
  if constexpr (std::is_same_v<T, std::string>) return "text";
  if constexpr (std::is_integral_v<T>) return "a whole number in its range";
  if constexpr (std::is_floating_point_v<T>) return "a number";
  return "as many numbers as it needs";
}

/// A value of Python's. Errors: UsageError that names it and what it is instead.
template <class T>
T value_of(const pybind11::handle& value, const std::string& name) {
  try {
    return value.cast<T>();
  } catch (const pybind11::cast_error&) {
    constexpr std::size_t most = 80;
    auto found = pybind11::repr(value).cast<std::string>();
    if (found.size() > most) found = found.substr(0, most) + " ...";
    throw UsageError(name + ": " + found + " is not " + expected<T>());
  }
}

/// A field of a dictionary, which has to be there; `of` is what its name begins with.
template <class T>
T field(const pybind11::dict& fields, const char* name, const std::string& of = "") {
  return value_of<T>(fields[name], of + name);
}

/// The enumerator of a name. Errors: UsageError that names all of them.
template <class Enum, std::size_t count>
Enum named(const std::array<Enum, count>& all, const std::string& name, const std::string& what) {
  std::string names;
  for (const Enum one : all) {
    if (name_of(one) == name) return one;
    names += (names.empty() ? "" : ", ") + std::string(name_of(one));
  }
  throw UsageError(what + ": '" + name + "' is not one of " + names);
}

/// The devices that a selector means, opened when they are first asked for. Errors: DeviceError.
std::shared_ptr<OpenDevices> devices_of(const std::string& selector);

/// Does work with the devices of a selector, or with none where it follows paths.
template <class Work>
auto with_devices(bool by_paths, const std::string& selector, const Work& work) {
  if (by_paths) return work(std::span<Device>());
  const auto open = devices_of(selector);
  const std::lock_guard lock(open->mutex);
  return work(std::span<Device>(open->devices));
}

/// A tuple (name, position, forward, up, vertical field of view in radians), in the file's world,
/// as a camera of the scene.
Camera camera_of(const Scene& scene, const pybind11::tuple& parts);

/// Whether the option "integrator" is "path", and not "photon-map". Errors: UsageError for another
/// word.
bool is_by_paths(const pybind11::dict& options);

/// A number of the scene's cameras, or a tuple as camera_of takes it.
Camera chosen_camera(const Scene& scene, const pybind11::object& camera);

/// The scene's lights with the option "mood" of the file "moods" ("" = beside the scene), then the
/// changes "light", a list of names and what the command's --light takes. Errors: UsageError where
/// there is no such file, mood or light; InputError for a damaged file.
LightMix mix_of(const Scene& scene, const pybind11::dict& options);

/// Settings by name, from a dictionary of numbers and strings; "quality" is set first. Errors:
/// UsageError that names the setting.
void set_all(RenderParameters& parameters, const pybind11::dict& settings);

}  // namespace photile::python
