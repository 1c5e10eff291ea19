#include "render/hit_source.hpp"

#include <glm/gtc/constants.hpp>
#include <memory>
#include <string>
#include <utility>

#include "light/pixel_light.hpp"
#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "trace/eye_path.hpp"
#include "trace/hit_batch.hpp"
#include "trace/hot_spots.hpp"
#include "trace/light_sampler.hpp"
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

PrimaryHitBatch trace_sensor_hits(const RayScene& rays, std::span<const Sensor> sensors,
                                  FindsHotSpots finds_hot_spots, const PrimaryHitParameters& film) {
  const PrimaryHits once = trace::sensor_hits(rays, sensors);
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
  if (finds_hot_spots == FindsHotSpots::yes && film.pass == 0 &&
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

Film film_of(std::span<const Sensor> sensors, const GatherParameters& gathering) {
  if (gathering.rays < 1 || gathering.rays > limits::max_samples_per_pixel) {
    throw UsageError("rays: " + std::to_string(gathering.rays) + " is not between 1 and " +
                     std::to_string(limits::max_samples_per_pixel));
  }
  if (sensors.empty() || sensors.size() > limits::max_sensors) {
    throw UsageError("sensors: " + std::to_string(sensors.size()) + " is not between 1 and " +
                     std::to_string(limits::max_sensors));
  }
  return {1, static_cast<int>(sensors.size()), gathering.rays};
}

/// Replaces the illuminance of the film, which is that of the surfaces seen, by that of the
/// sensors.
LightLayers with_own_illuminance(LightLayers layers) {
  for (std::size_t y = 0; y < static_cast<std::size_t>(layers.height); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(layers.width); ++x) {
      for_each_light(layers, x, y, [](std::size_t, float& illuminance, const glm::vec3& radiance) {
        illuminance = static_cast<float>(glm::pi<double>() * luminance(glm::dvec3(radiance)));
      });
    }
  }
  return layers;
}

}  // namespace

HitSource camera_hits(const Camera& camera, LightLayers* errors) {
  return {.trace =
              [&camera](const RayScene& rays, const auto& film, int first, int last, auto map_of) {
                return trace_primary_hits(rays, camera, film, first, last, map_of);
              },
          .add_to = [&camera](ContentHash& hash) { add_camera(camera, hash); },
          .dense = true,
          .errors = errors};
}

HitSource reflected_hits(const Camera& camera) {
  HitSource hits = camera_hits(camera);
  hits.trace = [&camera](const RayScene& rays, const auto& film, int first, int last, auto map_of) {
    return trace::trace_reflected_hits(rays, camera, film, first, last, map_of);
  };
  return hits;
}

HitSource sensor_hits(std::span<const Sensor> sensors, FindsHotSpots finds_hot_spots) {
  return {.trace = [=](const RayScene& rays, const auto& film, int, int,
                       auto) { return trace_sensor_hits(rays, sensors, finds_hot_spots, film); },
          .add_to = [=](ContentHash& hash) { add_sensors(sensors, hash); }};
}

HitSource gathered_hits(const Scene& scene, std::span<const Sensor> sensors,
                        SensorResponse response, FindsHotSpots finds_hot_spots) {
  const auto lights = std::make_shared<const trace::LightSampler>(scene);
  return {.trace =
              [=](const RayScene& rays, const auto& film, int first, int last, auto map_of) {
                return trace::gather_rays(rays, sensors, response, *lights,
                                          finds_hot_spots == FindsHotSpots::yes, film, first, last,
                                          map_of);
              },
          .add_to =
              [=](ContentHash& hash) {
                hash.add(response);
                add_sensors(sensors, hash);
              }};
}

RenderResult measure(const Scene& scene, std::span<const Sensor> sensors, std::span<Device> devices,
                     const RenderParameters& parameters, Progress& progress) {
  return render_hits(scene, sensor_hits(sensors, FindsHotSpots::yes), one_row(sensors, 1), devices,
                     parameters, progress);
}

PathTracerResult measure_by_paths(const Scene& scene, std::span<const Sensor> sensors, int paths,
                                  std::uint64_t seed, Progress& progress) {
  return trace_paths_of_hits(scene, sensor_hits(sensors, FindsHotSpots::no),
                             eye_rays({.seed = seed, .film = one_row(sensors, paths)}), progress);
}

RenderResult gather(const Scene& scene, std::span<const Sensor> sensors,
                    const GatherParameters& gathering, std::span<Device> devices,
                    const RenderParameters& parameters, Progress& progress) {
  RenderResult result =
      render_hits(scene, gathered_hits(scene, sensors, gathering.response, FindsHotSpots::yes),
                  film_of(sensors, gathering), devices, parameters, progress);
  result.layers = with_own_illuminance(std::move(result.layers));
  return result;
}

PathTracerResult gather_by_paths(const Scene& scene, std::span<const Sensor> sensors,
                                 const GatherParameters& gathering, std::uint64_t seed,
                                 Progress& progress) {
  PathTracerResult result = trace_paths_of_hits(
      scene, gathered_hits(scene, sensors, gathering.response, FindsHotSpots::no),
      eye_rays({.seed = seed, .film = film_of(sensors, gathering)}), progress);
  result.layers = with_own_illuminance(std::move(result.layers));
  return result;
}

}  // namespace photile
