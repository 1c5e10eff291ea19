#include "render/hit_source.hpp"

#include <algorithm>
#include <vector>

#include "photile/errors.hpp"
#include "trace/eye_path.hpp"
#include "trace/hit_batch.hpp"
#include "trace/hot_spots.hpp"
#include "trace/ray_scene.hpp"
#include "trace/sensors.hpp"
#include "trace/shading_point.hpp"

namespace photile {
namespace {

Film one_row(std::span<const Sensor> sensors, int samples) {
  return {static_cast<int>(sensors.size()), 1, samples};
}

void add_camera(const Camera& camera, ContentHash& hash) {
  for (const glm::dvec3& vector : {camera.position, camera.forward, camera.up, camera.right}) {
    hash.add(vector);
  }
  hash.add(camera.vertical_field_of_view);
  hash.add(camera.projection);
  hash.add(camera.orthographic_height);
}

void add_sensors(std::span<const Sensor> sensors, ContentHash& hash) {
  for (const Sensor& sensor : sensors) {
    for (const glm::dvec3& vector : {sensor.position, sensor.normal, sensor.facing}) {
      hash.add(vector);
    }
    hash.add(sensor.sees_lights);
    hash.add(sensor.response.has_value() ? static_cast<int>(*sensor.response) : -1);
  }
}

}  // namespace

void CameraHits::add_to(ContentHash& hash) const { add_camera(camera_, hash); }
void ReflectedHits::add_to(ContentHash& hash) const { add_camera(camera_, hash); }
void SensorHits::add_to(ContentHash& hash) const { add_sensors(sensors_, hash); }
void GatherHits::add_to(ContentHash& hash) const {
  hash.add(response_);
  add_sensors(sensors_, hash);
}

PrimaryHitBatch CameraHits::trace(const RayScene& rays, const PrimaryHitParameters& film,
                                  int first_row, int last_row,
                                  std::span<const std::uint32_t> map_of) const {
  return trace_primary_hits(rays, camera_, film, first_row, last_row, map_of);
}

PrimaryHitBatch ReflectedHits::trace(const RayScene& rays, const PrimaryHitParameters& film,
                                     int first_row, int last_row,
                                     std::span<const std::uint32_t> map_of) const {
  return trace::trace_reflected_hits(rays, camera_, film, first_row, last_row, map_of);
}

PrimaryHitBatch SensorHits::trace(const RayScene& rays, const PrimaryHitParameters& film, int, int,
                                  std::span<const std::uint32_t>) const {
  const PrimaryHits once = trace::sensor_hits(rays, sensors_);
  PrimaryHitBatch batch;
  PrimaryHits& hits = batch.hits;
  for (std::uint32_t hit = 0; hit < once.size(); ++hit) {
    for (int sample = film.pass; sample < film.samples_per_pixel; sample += film.passes) {
      hits.position.push_back(once.position[hit]);
      hits.oriented_face.push_back(once.oriented_face[hit]);
      hits.pixel.push_back(once.pixel[hit]);
      hits.throughput.push_back(once.throughput[hit] / static_cast<float>(film.samples_per_pixel));
      hits.diffuse_albedo.push_back(once.diffuse_albedo[hit]);
      if (once.outgoing.empty()) continue;
      hits.outgoing.push_back(once.outgoing[hit]);
      hits.lobe.push_back(once.lobe[hit]);
    }
  }
  batch.rays = once.size();
  if (finds_hot_spots_ == FindsHotSpots::yes && film.pass == 0 &&
      !trace::hot_spots_of(rays).empty()) {
    const trace::LightSampler light_sampler(rays.scene());
    for (std::uint32_t hit = 0; hit < once.size(); ++hit) {
      const trace::SurfacePoint point = trace::point_of(rays.scene(), once, hit);
      const trace::OpaqueBsdf bsdf = trace::bsdf_of(rays.scene(), once, hit, point);
      trace::for_each_hot_light(
          impl_of(rays), light_sampler, point,
          [&](const trace::LightSample& light, const glm::vec3& arrives) {
            const double cosine = double{glm::dot(light.direction, point.normal)};
            batch.emission.push_back(
                {once.pixel[hit], light.layer,
                 once.throughput[hit] * bsdf.reflected(light.direction) * arrives,
                 static_cast<float>(cosine * luminance(glm::dvec3(arrives)))});
          });
    }
  }
  return batch;
}

RenderResult measure(const Scene& scene, std::span<const Sensor> sensors, std::span<Device> devices,
                     const RenderParameters& parameters, Progress& progress) {
  return render_hits(scene, SensorHits(sensors, FindsHotSpots::yes), one_row(sensors, 1), devices,
                     parameters, progress);
}

PathTracerResult measure_by_paths(const Scene& scene, std::span<const Sensor> sensors, int paths,
                                  std::uint64_t seed, Progress& progress) {
  return trace_paths_of_hits(scene, SensorHits(sensors, FindsHotSpots::no),
                             eye_rays({.seed = seed, .film = one_row(sensors, paths)}), progress);
}

}  // namespace photile
