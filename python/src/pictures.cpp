// Pictures with a layer for each light: rendered, or read from a file, and mixed.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "arrays.hpp"
#include "image/white.hpp"
#include "parts.hpp"
#include "photile/layered_picture.hpp"
#include "photile/renderer.hpp"
#include "view/moods.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

using Changes = std::vector<std::pair<std::string, std::string>>;

std::vector<LightChange> listed(const Changes& changes) {
  std::vector<LightChange> list;
  for (const auto& [name, value] : changes) list.push_back({name, value});
  return list;
}

/// What a mood changes in a mix; nothing where none is asked for.
///   given    the file of moods; "" = the first that exists
///   beside   the files beside which it may lie
std::vector<LightChange> changes_of_mood(const std::string& mood,
                                         const std::filesystem::path& given,
                                         const std::vector<std::filesystem::path>& beside,
                                         const LightMix& mix) {
  if (mood.empty()) return {};
  std::vector<std::filesystem::path> files{given};
  if (given.empty()) {
    files.clear();
    for (const auto& file : beside) files.push_back(view::Moods::file_of(file));
  }
  const auto found = std::ranges::find_if(
      files, [](const auto& file) { return std::filesystem::is_regular_file(file); });
  if (found == files.end()) {
    throw UsageError(files.front().string() +
                     ": there is no such moods file; save moods on the live page, or give " +
                     "moods=FILE");
  }
  return view::Moods(*found).changes(mood, mix);
}

/// Layers at a power of 1, and what the file that they are written to says of them.
class Picture {
 public:
  LightLayers layers;
  LightMix own;                       ///< powers of the scene, or of the file
  bool from_file = false;             ///< what is off there cannot be turned up
  PictureHeader header;               ///< attributes
  std::filesystem::path file, scene;  ///< that it is of, beside which moods may lie
  RunStatistics statistics;           ///< of its rendering
  RenderParameters settings;          ///< that it was rendered with

  /// Errors: UsageError as change_lights and relight have them.
  LightMix mix_of(const Changes& changes) const {
    if (from_file) return relit_mix(header, listed(changes));
    LightMix mix = own;
    change_lights(mix, listed(changes));
    return mix;
  }

  std::size_t index_of(const std::string& light) const {
    for (std::size_t i = 0; i < layers.layers.size(); ++i) {
      if (layers.layers[i].light == light) return i;
    }
    throw py::key_error(light);
  }

  std::unique_ptr<LayeredPicture> mixed(const LightMix& mix) const {
    std::unique_ptr<LayeredPicture> picture = mixed_picture(layers, mix);
    PictureHeader& to = picture->header();
    for (const auto& [name, value] : header.attributes) to.attributes.try_emplace(name, value);
    for (const auto& [name, value] : header.matrices) to.matrices.try_emplace(name, value);
    for (const auto& [name, value] : header.numbers) to.numbers.try_emplace(name, value);
    return picture;
  }

  std::vector<py::ssize_t> shape(py::ssize_t components) const {
    std::vector<py::ssize_t> sizes{layers.height, layers.width};
    if (components > 1) sizes.push_back(components);
    return sizes;
  }
};

RenderParameters parameters_of(const Camera& camera, const std::optional<std::pair<int, int>>& size,
                               const py::dict& settings) {
  RenderParameters parameters;
  set_all(parameters, settings);
  if (size) {
    parameters.film.width = size->first;
    parameters.film.height = size->second;
  } else if (camera.aspect_ratio > 0) {
    const double width = std::round(camera.aspect_ratio * parameters.film.height);
    parameters.film.width = std::max(1, static_cast<int>(std::min(width, 1e6)));
  }
  return parameters;
}

std::shared_ptr<Picture> render_picture(const std::shared_ptr<Scene>& scene, const py::object& view,
                                        const py::dict& options, const py::dict& settings,
                                        const py::object& progress) {
  const Camera camera = chosen_camera(*scene, view);
  const RenderParameters parameters =
      parameters_of(camera, field<std::optional<std::pair<int, int>>>(options, "size"), settings);
  const auto device = field<std::string>(options, "device");
  const auto lumen_per_watt = field<double>(options, "lumen_per_watt");
  const bool by_paths = is_by_paths(options);
  mix_of(*scene, options);  // refuses moods and changes that cannot be done before it works
  return run(progress, [&](Progress& told) {
    auto picture = std::make_shared<Picture>();
    picture->scene = scene->source;
    picture->own = LightMix::of(*scene, lumen_per_watt);
    picture->settings = parameters;
    if (by_paths) {
      PathTracerResult result = trace_paths(*scene, camera, eye_rays(parameters), told);
      picture->layers = std::move(result.layers);
      picture->statistics = std::move(result.statistics);
    } else {
      const auto open = devices_of(device);
      const std::lock_guard lock(open->mutex);
      RenderResult result = render(*scene, camera, open->devices, parameters, told);
      picture->layers = std::move(result.layers);
      picture->statistics = std::move(result.statistics);
      picture->settings = result.used;
    }
    if (picture->layers.sparse()) picture->layers = picture->layers.dense();
    set_camera_attributes(picture->header, in_world(*scene, camera), picture->layers.width,
                          picture->layers.height);
    image::keep_white(picture->header, image::white_of(picture->layers, picture->own));
    return picture;
  });
}

std::shared_ptr<Picture> read_picture(const std::filesystem::path& file) {
  const Unlocked unlocked;
  const Image image = read_image(file);
  auto picture = std::make_shared<Picture>();
  try {
    picture->own = read_light_mix(image);
    picture->layers = light_layers(image);
    picture->header = image;
    if (!image::kept_white(image)) {
      image::keep_white(picture->header, image::white_of(picture->layers, picture->own));
    }
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  picture->from_file = true;
  picture->file = file;
  if (const auto scene = image.attributes.find("photile.scene"); scene != image.attributes.end())
    picture->scene = file.parent_path() / std::filesystem::path(scene->second).filename();
  return picture;
}

py::object unit_layer(const py::object& owner, const std::string& light) {
  const auto& picture = owner.cast<const Picture&>();
  const auto& layer = picture.layers.layers[picture.index_of(light)];
  return view<float>(owner, picture.shape(3), layer.radiance.data());
}

py::object unit_illuminance(const py::object& owner, const std::string& light) {
  const auto& picture = owner.cast<const Picture&>();
  const auto& layer = picture.layers.layers[picture.index_of(light)];
  return view<float>(owner, picture.shape(1), layer.illuminance.data());
}

/// The sum of the layers, shape (height, width, 3).
py::object mixed_layers(const Picture& picture, const Changes& changes) {
  std::vector<glm::vec3> sum(static_cast<std::size_t>(picture.layers.width) *
                             static_cast<std::size_t>(picture.layers.height));
  {
    const Unlocked unlocked;
    combine_layers(picture.layers, picture.mix_of(changes), sum);
  }
  return taken<float>(std::move(sum), picture.shape(3));
}

ToneMapping tone_mapping(const Picture& picture, const py::dict& display) {
  return {.automatic_exposure = field<bool>(display, "automatic"),
          .exposure = field<double>(display, "exposure"),
          .view = named(all_display_views, field<std::string>(display, "view"), "view"),
          .white = *image::kept_white(picture.header)};
}

/// Display-referred and linear, shape (height, width, 3).
py::object displayed(const Picture& picture, const Changes& changes, const py::dict& display) {
  const ToneMapping parameters = tone_mapping(picture, display);
  std::vector<glm::vec3> pixels;
  {
    const Unlocked unlocked;
    const Image image = tone_map(picture.mixed(picture.mix_of(changes))->root(), parameters);
    pixels.resize(image.pixels());
    for (int c = 0; c < 3; ++c) {
      const std::vector<float>& plane = *image.find(std::string(1, "RGB"[c]));
      for (std::size_t p = 0; p < pixels.size(); ++p) pixels[p][c] = plane[p];
    }
  }
  return taken<float>(std::move(pixels), picture.shape(3));
}

/// What a mood changes in a picture.
Changes mood_of(const Picture& picture, const std::string& mood, const std::string& moods) {
  std::vector<std::filesystem::path> beside;
  for (const auto& file : {picture.scene, picture.file}) {
    if (!file.empty()) beside.push_back(file);
  }
  Changes changes;
  for (const LightChange& change : changes_of_mood(mood, moods, beside, picture.own))
    changes.emplace_back(change.name, change.value);
  return changes;
}

void save_exr(const Picture& picture, const std::filesystem::path& file, const Changes& changes) {
  const Unlocked unlocked;
  write_exr(file, *picture.mixed(picture.mix_of(changes)));
}

void save_png(const Picture& picture, const std::filesystem::path& file, const Changes& changes,
              const py::dict& display) {
  const ToneMapping parameters = tone_mapping(picture, display);
  const Unlocked unlocked;
  write_png(file, tone_map(picture.mixed(picture.mix_of(changes))->root(), parameters));
}

/// Per light: name, power, unit, colour, tint, names of the lights of a group.
py::list lights_of_picture(const Picture& picture, const Changes& changes) {
  py::list list;
  const LightMix mix = picture.mix_of(changes);
  for (const MixedLight& light : mix.lights) {
    py::dict row;
    row["name"] = light.name;
    row["power"] = light.power;
    row["unit"] = light.unit == PowerUnit::lumen ? "lumen" : "watt";
    row["power_in_picture"] = mix.power_in_picture(light);
    row["color"] = py::make_tuple(light.color.x, light.color.y, light.color.z);
    row["tint"] = py::make_tuple(light.tint.x, light.tint.y, light.tint.z);
    row["members"] = light.members;
    list.append(row);
  }
  return list;
}

py::list statistics_of(const Picture& picture) {
  py::list list;
  for (const StageStatistics& stage : picture.statistics) {
    py::dict row;
    row["stage"] = stage.stage;
    row["seconds"] = stage.seconds;
    row["processor_seconds"] = stage.processor_seconds;
    row["host_bytes"] = stage.host_bytes;
    row["device_bytes"] = stage.device_bytes;
    py::dict figures;
    for (const auto& [name, value] : stage.figures) figures[py::str(name)] = value;
    row["figures"] = figures;
    list.append(row);
  }
  return list;
}

}  // namespace

bool is_by_paths(const py::dict& options) {
  const auto integrator = field<std::string>(options, "integrator");
  if (integrator == "path" || integrator == "photon-map") return integrator == "path";
  throw UsageError("integrator: '" + integrator + "' is not one of photon-map, path");
}

LightMix mix_of(const Scene& scene, const py::dict& options) {
  LightMix mix = LightMix::of(scene, field<double>(options, "lumen_per_watt"));
  std::vector<LightChange> changes =
      changes_of_mood(field<std::string>(options, "mood"), field<std::string>(options, "moods"),
                      {scene.source}, mix);
  for (LightChange& change : listed(field<Changes>(options, "light")))
    changes.push_back(std::move(change));
  change_lights(mix, changes);
  return mix;
}

Camera chosen_camera(const Scene& scene, const py::object& camera) {
  if (py::isinstance<py::tuple>(camera)) return camera_of(scene, camera.cast<py::tuple>());
  return scene.cameras.at(camera.cast<std::size_t>());
}

void set_all(RenderParameters& parameters, const py::dict& settings) {
  if (settings.contains("quality")) {
    set_quality(parameters,
                named(all_qualities, field<std::string>(settings, "quality"), "quality"));
  }
  for (const auto& [key, value] : settings) {
    const auto name = key.cast<std::string>();
    if (name == "quality") continue;
    if (py::isinstance<py::str>(value)) {
      const auto text = value_of<std::string>(value, name);
      set_by_name(parameters, name, std::string_view(text));
      continue;
    }
    // Whole numbers of numpy are some, too; those below 0 and beyond 64 bits are in no range.
    if (const auto number = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()))) {
      const std::uint64_t whole = PyLong_AsUnsignedLongLong(number.ptr());
      if (PyErr_Occurred() == nullptr) {
        set_by_name(parameters, name, whole);
        continue;
      }
    }
    PyErr_Clear();
    set_by_name(parameters, name, value_of<double>(value, name));
  }
}

void define_pictures(py::module_& module) {
  py::class_<Picture, std::shared_ptr<Picture>>(module, "Picture")
      .def_property_readonly("width", [](const Picture& p) { return p.layers.width; })
      .def_property_readonly("height", [](const Picture& p) { return p.layers.height; })
      .def_property_readonly("lumen_per_watt",
                             [](const Picture& p) { return p.own.lumen_per_watt; })
      .def_property_readonly("statistics", &statistics_of)
      .def_property_readonly("radius", [](const Picture& p) { return p.settings.radius; })
      .def("lights", &lights_of_picture)
      .def("unit_layer", &unit_layer)
      .def("unit_illuminance", &unit_illuminance)
      .def("mix", &mixed_layers)
      .def("mood", &mood_of)
      .def("displayed", &displayed)
      .def("save_exr", &save_exr)
      .def("save_png", &save_png);
  module.def("render", &render_picture);
  module.def("read_picture", &read_picture);
  module.def("setting_names", &setting_names);
}

}  // namespace photile::python
