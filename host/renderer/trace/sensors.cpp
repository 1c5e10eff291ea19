#include "trace/sensors.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <optional>
#include <utility>
#include <vector>

#include "photile/errors.hpp"
#include "trace/eye_path.hpp"
#include "trace/hit_batch.hpp"
#include "trace/hot_spots.hpp"
#include "trace/random_stream.hpp"
#include "trace/ray_query.hpp"
#include "trace/surface.hpp"

namespace photile::trace {

PrimaryHits sensor_hits(const RayScene& rays, std::span<const Sensor> sensors) {
  constexpr double reach = 1e-3;  // metres
  const Scene& scene = rays.scene();
  EyeRecord record;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Sensor& sensor = sensors[i];
    const glm::vec3 down(-sensor.normal);
    const auto hit = intersect(rays, glm::vec3(sensor.position + reach * sensor.normal), down);
    const auto point = hit ? std::optional(surface_hit(scene, *hit, down)) : std::nullopt;
    if (!point || glm::length(glm::dvec3(point->position) - sensor.position) > reach ||
        material_of(scene, *point).interaction != Interaction::opaque) {
      throw InputError(fmt::format(
          "{}: no opaque surface within {} m of the sensor at ({}, {}, {})", scene.source.string(),
          reach, sensor.position.x, sensor.position.y, sensor.position.z));
    }
    append_hit(impl_of(rays), *point,
               {glm::vec3(sensor.position), down, glm::vec3(1.0f), static_cast<std::uint32_t>(i)},
               record);
  }
  return hits_of({&record, 1});
}

namespace {

/// All rays of a row's sensor.
class Gatherer {
 public:
  Gatherer(const RayScene& rays, const LightSampler& light_sampler, const EyeSetup& setup,
           const Photometer& photometer, std::uint32_t pixel)
      : rays_(rays),
        light_sampler_(light_sampler),
        setup_(setup),
        photometer_(photometer),
        pixel_(pixel) {}

  void trace(EyeRecord& record, std::vector<VisibleEmission>& emission) {
    const PrimaryHitParameters& film = *setup_.parameters;
    const auto number = [&](int sample) {
      return std::uint64_t{pixel_} * static_cast<std::uint64_t>(film.samples_per_pixel) +
             static_cast<std::uint64_t>(sample);
    };
    const RandomBlock scramble =
        RandomStream(film.seed, number(0), 0).block(Purpose::sensor_direction, 0);
    // One number for all choices of lights: each is sampled as often as its probability says.
    const double shift =
        RandomStream(film.seed, number(0), 0).block(Purpose::sensor_light, 2).uniform_double(0);
    const HotSpotAim aim(hot_spots_of(rays_), photometer_.origin(), photometer_.one_side());
    for (int sample = film.pass; sample < film.samples_per_pixel; sample += film.passes) {
      const RandomStream random(film.seed, number(sample), 0);
      glm::dvec2 spread = sobol_point(static_cast<std::uint32_t>(sample), scramble);
      if (spread.x < aim.fraction()) {
        follow_to_hot_spot(aim, {spread.x / aim.fraction(), spread.y}, record);
      } else {
        spread.x = (spread.x - aim.fraction()) / (1 - aim.fraction());
        follow(random, spread, aim, record);
      }
      sample_light(random, (sample + shift) / film.samples_per_pixel, emission);
    }
  }

 private:
  glm::vec3 weight() const {
    return glm::vec3(1.0f / static_cast<float>(setup_.parameters->samples_per_pixel));
  }

  void follow_to_hot_spot(const HotSpotAim& aim, const glm::dvec2& u, EyeRecord& record) const {
    const auto target = aim.sample(u);
    if (!target) return;
    const float density = photometer_.density(target->direction);
    if (!(density > 0.0f)) return;
    const glm::vec3 passes = transmittance(rays_, photometer_.origin(),
                                           target->point.origin_towards(-target->direction));
    if (passes == glm::vec3(0.0f)) return;
    const auto counts = static_cast<float>(aim.weight(double{density}, *target));
    append_eye_hit(setup_, target->point,
                   {photometer_.origin(), target->direction, counts * passes * weight(), pixel_},
                   record);
  }

  void follow(const RandomStream& random, const glm::dvec2& spread, const HotSpotAim& aim,
              EyeRecord& record) const {
    const RandomBlock own = random.block(Purpose::sensor_direction, 1);
    const glm::vec3 direction = photometer_.sample(spread, own.uniform(0), own.uniform(1));
    const float density = photometer_.density(direction);
    if (!(density > 0.0f)) return;
    const LightTechnique looking{light_sampler_, density, false, by_power_alone,
                                 !photometer_.sees_lights()};
    const BesideHotSpots beside{aim, double{density}};
    EyeRay ray{photometer_.origin(), direction, weight(), pixel_};
    if (aim.fraction() > 0) {
      ray.throughput /= static_cast<float>(1 - aim.fraction());
      ray.beside = &beside;
    }
    follow_eye_ray(setup_, ray, random, record, &looking);
  }

  void sample_light(const RandomStream& random, double choice,
                    std::vector<VisibleEmission>& emission) const {
    const auto light = light_sampler_.sample(photometer_.origin(), RandomBlock::of(choice),
                                             random.block(Purpose::sensor_light, 1));
    if (!light || !(photometer_.sees_lights() || light->distant)) return;
    const float density = photometer_.density(light->direction);
    if (!(density > 0.0f)) return;
    const glm::vec3 arrives = density * weight() * light->received *
                              transmittance(rays_, photometer_.origin(), light->target);
    if (arrives == glm::vec3(0.0f)) return;
    emission.push_back({pixel_, light->layer, arrives * light->weight_beside(density)});
  }

  const RayScene& rays_;
  const LightSampler& light_sampler_;
  const EyeSetup& setup_;
  const Photometer& photometer_;
  std::uint32_t pixel_;
};

}  // namespace

PrimaryHitBatch gather_rays(const RayScene& rays, std::span<const Sensor> sensors,
                            SensorResponse response, const LightSampler& light_sampler,
                            bool adds_hot_spots, const PrimaryHitParameters& film, int first_row,
                            int last_row, std::span<const std::uint32_t> map_of) {
  const std::vector<glm::vec3> radiance = emitted_radiance_at_unit_power(rays.scene());
  const DistantLights distant(rays.scene());
  const EyeSetup setup{.rays = &impl_of(rays),
                       .parameters = &film,
                       .emitted_radiance = &radiance,
                       .distant = &distant,
                       .hot_spots = adds_hot_spots ? &light_sampler : nullptr};
  const auto count = static_cast<std::size_t>(last_row - first_row);
  std::vector<EyeRecord> rows(count);
  std::vector<std::vector<VisibleEmission>> seen(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const FlushDenormals flush_denormals;
    const auto pixel = static_cast<std::uint32_t>(first_row) + static_cast<std::uint32_t>(i);
    const Photometer photometer(sensors[pixel], sensors[pixel].response.value_or(response));
    Gatherer(rays, light_sampler, setup, photometer, pixel).trace(rows[i], seen[i]);
  });
  PrimaryHitBatch batch = batch_of(rays, std::move(rows), film.runs, map_of);
  for (const auto& row : seen) {
    batch.emission.insert(batch.emission.end(), row.begin(), row.end());
  }
  return batch;
}

}  // namespace photile::trace
