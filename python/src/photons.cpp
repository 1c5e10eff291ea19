// Photons of a scene, and photon maps over any photons.
#include "photile/photons.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "arrays.hpp"
#include "parts.hpp"
#include "photile/light_layers.hpp"
#include "photile/neighbour_groups.hpp"
#include "photile/photon_cloud.hpp"
#include "work.hpp"

namespace photile::python {
namespace {

std::shared_ptr<PhotonTracerResult> trace(const std::shared_ptr<Scene>& scene,
                                          const py::dict& options, const py::object& progress) {
  PhotonTracerParameters parameters;
  parameters.emitted_photons = field<std::uint64_t>(options, "photons");
  parameters.seed = field<std::uint64_t>(options, "seed");
  parameters.store_direct = field<bool>(options, "store_direct");
  parameters.max_path_length = field<int>(options, "max_path_length");
  parameters.quota = named(all_photon_quotas, field<std::string>(options, "quota"), "quota");
  return run(progress, [&](Progress& told) {
    return std::make_shared<PhotonTracerResult>(trace_photons(RayScene(*scene), parameters, told));
  });
}

/// The unit normal of the side that each photon lies on.
py::object normals_of(const PhotonTracerResult& traced, const Scene& scene) {
  const Photons& photons = traced.photons;
  std::vector<glm::vec3> normals(photons.size());
  {
    const Unlocked unlocked;
    for (std::uint32_t s = 0; s + 1 < photons.first_of.size(); ++s) {
      if (photons.first_of[s] == photons.first_of[s + 1]) continue;
      std::fill(normals.begin() + photons.first_of[s], normals.begin() + photons.first_of[s + 1],
                glm::vec3(face_normal(scene, s)));
    }
  }
  const auto count = static_cast<py::ssize_t>(normals.size());
  return taken<float>(std::move(normals), {count, 3});
}

/// Arrays that may be empty: a span of nothing.
template <class Row, class T>
std::span<const Row> rows_or_none(const std::optional<Array<T>>& array, const char* name) {
  return array ? rows_of<Row>(*array, name) : std::span<const Row>();
}

/// PhotonCloud with its device, and the radius that it was built with.
class Maps {
 public:
  Maps(const Array<float>& positions, const std::optional<Array<float>>& normals,
       const std::optional<Array<float>>& flux, const std::optional<Array<std::uint16_t>>& lights,
       const py::dict& options, const py::object& progress) {
    const auto neighbours = field<int>(options, "neighbours");
    const auto device = field<std::string>(options, "device");
    const CloudPhotons photons{
        .position = rows_of<glm::vec3>(positions, "positions"),
        .normal = rows_or_none<glm::vec3>(normals, "normals"),
        .flux = rows_or_none<glm::vec3>(flux, "flux"),
        .light = lights ? values_of(*lights, "lights") : std::span<const std::uint16_t>()};
    CloudParameters parameters{.radius = field<double>(options, "radius"),
                               .angle_degrees = field<double>(options, "angle"),
                               .photons_per_cell = field<float>(options, "photons_per_cell")};
    run_in_thread(progress, [&](Progress& told) {
      if (parameters.radius == 0) {
        Photons copied;
        copied.position.assign(photons.position.begin(), photons.position.end());
        parameters.radius = automatic_radius(copied, neighbours);
      }
      devices_ = devices_of(device);
      const std::lock_guard lock(devices_->mutex);
      cloud_.emplace(devices_->devices.front(), photons, parameters, told);
    });
    radius_ = parameters.radius;
    for (const std::uint16_t light : photons.light) {
      light_count_ = std::max(light_count_, std::size_t{light} + 1);
    }
  }

  ~Maps() {
    if (!devices_) return;
    if (is_forked()) {
      static_cast<void>(new auto(std::move(cloud_)));  // the device is the parent's
      return;
    }
    // Maps may live until the interpreter ends, when nobody is allowed to begin work.
    const py::gil_scoped_release release;
    const std::lock_guard lock(devices_->mutex);
    cloud_.reset();
  }

  std::size_t size() const { return cloud_->size(); }
  double radius() const { return radius_; }

  py::tuple nearest(const Array<float>& points, const std::optional<Array<float>>& normals,
                    const py::dict& options) {
    const auto k = field<int>(options, "k");
    const auto radius = field<double>(options, "radius");
    const auto where = rows_of<glm::vec3>(points, "points");
    const auto facing = rows_or_none<glm::vec3>(normals, "normals");
    CloudNeighbours found = [&] {
      const Unlocked unlocked;
      const std::lock_guard lock(devices_->mutex);
      return cloud_->nearest(where, facing, k, radius);
    }();
    const std::vector<py::ssize_t> shape{points.shape(0), k};
    return py::make_tuple(taken<std::uint32_t>(std::move(found.photons), shape),
                          taken<float>(std::move(found.squared_distance), shape));
  }

  /// Shape (points, lights, 3).
  py::object irradiance(const Array<float>& points, const std::optional<Array<float>>& normals,
                        const py::dict& options) {
    const auto where = rows_of<glm::vec3>(points, "points");
    const auto facing = rows_or_none<glm::vec3>(normals, "normals");
    const CloudEstimateParameters parameters{
        .neighbours = field<int>(options, "k"),
        .radius = field<double>(options, "radius"),
        .kernel = named(all_density_kernels, field<std::string>(options, "kernel"), "kernel")};
    LightTable found = [&] {
      const Unlocked unlocked;
      const std::lock_guard lock(devices_->mutex);
      return cloud_->irradiance(where, facing, parameters);
    }();
    if (!found.first.empty()) found.irradiance = dense(found);
    return taken<float>(std::move(found.irradiance),
                        {points.shape(0), static_cast<py::ssize_t>(light_count_), 3});
  }

  py::dict statistics() const {
    const PhotonMapStatistics& all = cloud_->statistics();
    py::dict row;
    row["photons"] = all.photons;
    row["references"] = all.references;
    row["maps"] = all.maps;
    row["cells"] = all.cells;
    row["largest_map"] = all.largest_map;
    row["device_bytes"] = all.device_bytes;
    row["seconds"] = all.seconds;
    return row;
  }

 private:
  /// One row for each point, of all lights, from those of the lights that it found.
  std::vector<glm::vec3> dense(const LightTable& sparse) const {
    const std::size_t points = sparse.first.size() - 1;
    std::vector<glm::vec3> rows(points * light_count_, glm::vec3(0.0f));
    for (std::size_t p = 0; p < points; ++p) {
      for (std::uint64_t i = sparse.first[p]; i < sparse.first[p + 1]; ++i) {
        rows[p * light_count_ + sparse.light[i]] = sparse.irradiance[i];
      }
    }
    return rows;
  }

  std::shared_ptr<OpenDevices> devices_;  ///< outlive the cloud
  std::optional<PhotonCloud> cloud_;
  double radius_ = 0;
  std::size_t light_count_ = 1;
};

/// (indices, distances), each of shape (queries, k); as many points as there are stand for none.
py::object neighbours_of(const Array<float>& points, const Array<float>& queries,
                         const std::optional<Array<float>>& normals,
                         const std::optional<Array<float>>& query_normals, const py::dict& options,
                         const py::object& progress) {
  const NeighbourSearch search{
      .points = rows_of<glm::vec3>(points, "points"),
      .queries = rows_of<glm::vec3>(queries, "queries"),
      .k = field<int>(options, "k"),
      .max_distance = field<double>(options, "max_distance"),
      .normals = rows_or_none<glm::vec3>(normals, "normals"),
      .query_normals = rows_or_none<glm::vec3>(query_normals, "query_normals"),
      .angle_degrees = field<double>(options, "angle")};
  const auto device = field<std::string>(options, "device");
  CloudNeighbours found = run(progress, [&](Progress& told) {
    const auto devices = devices_of(device);
    const std::lock_guard lock(devices->mutex);
    CloudNeighbours near = find_neighbours(devices->devices.front(), search, told);
    std::replace(near.photons.begin(), near.photons.end(), none,
                 static_cast<std::uint32_t>(search.points.size()));
    for (float& distance : near.squared_distance) distance = std::sqrt(distance);
    return near;
  });
  const std::vector<py::ssize_t> shape{queries.shape(0), found.k};
  return py::make_tuple(taken<std::uint32_t>(std::move(found.photons), shape),
                        taken<float>(std::move(found.squared_distance), shape));
}

}  // namespace

void define_photons(py::module_& module) {
  using Traced = PhotonTracerResult;
  const auto photons_of = [](const py::object& o) -> const Photons& {
    return o.cast<const Traced&>().photons;
  };
  py::class_<Traced, std::shared_ptr<Traced>>(module, "Photons")
      .def("__len__", [](const Traced& t) { return t.photons.size(); })
      .def_property_readonly(
          "position",
          [photons_of](const py::object& o) { return view_rows<float>(o, photons_of(o).position); })
      .def_property_readonly(
          "flux",
          [photons_of](const py::object& o) { return view_rows<float>(o, photons_of(o).flux); })
      .def_property_readonly(
          "incoming",
          [photons_of](const py::object& o) { return view_rows<float>(o, photons_of(o).incoming); })
      .def_property_readonly("light",
                             [photons_of](const py::object& o) {
                               return view_rows<std::uint16_t>(o, photons_of(o).light);
                             })
      .def_property_readonly("oriented_face",
                             [photons_of](const py::object& o) {
                               return view_rows<std::uint32_t>(o, photons_of(o).oriented_face);
                             })
      .def("normals", &normals_of)
      .def_property_readonly("emitted_per_light",
                             [](const Traced& t) { return t.photons.emitted_per_light; })
      .def_property_readonly("absorbed_flux_per_light",
                             [](const Traced& t) { return t.absorbed_flux_per_light; })
      .def_property_readonly("escaped_flux_per_light",
                             [](const Traced& t) { return t.escaped_flux_per_light; });
  module.def("trace", &trace);
  module.def("neighbours", &neighbours_of);

  py::class_<Maps>(module, "PhotonMaps")
      .def(py::init<const Array<float>&, const std::optional<Array<float>>&,
                    const std::optional<Array<float>>&, const std::optional<Array<std::uint16_t>>&,
                    const py::dict&, const py::object&>())
      .def("__len__", &Maps::size)
      .def_property_readonly("radius", &Maps::radius)
      .def("statistics", &Maps::statistics)
      .def("nearest", &Maps::nearest)
      .def("irradiance", &Maps::irradiance);
}

}  // namespace photile::python
