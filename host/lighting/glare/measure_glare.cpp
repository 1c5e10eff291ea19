#include "glare/measure_glare.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "measuring/measurement.hpp"
#include "photile/renderer.hpp"

namespace photile::glare {

namespace {

/// Sensors 2 i and 2 i + 1 are observer i's eye, without and with what hides lamps from it.
measuring::SensorGrid eyes_of(std::span<const Observer> observers) {
  measuring::SensorGrid grid{"eyes", {}, {}};
  for (const Observer& observer : observers) {
    for (const bool sees_lights : {true, false}) {
      grid.sensors.push_back({observer.position, observer.forward, sees_lights});
    }
  }
  return grid;
}

/// Per sensor and light whether any of that light is there.
std::vector<std::vector<bool>> reached_by(const measuring::Readings& readings) {
  const std::size_t lights = readings.lights().size();
  std::vector<std::vector<bool>> reached(readings.sensors(), std::vector<bool>(lights));
  for (std::size_t light = 0; light < lights; ++light) {
    for (const std::vector<float>& repeat : readings.repeats_of(light + 1)) {
      for (std::size_t sensor = 0; sensor < repeat.size(); ++sensor) {
        if (repeat[sensor] > 0) reached[sensor][light] = true;
      }
    }
  }
  return reached;
}

/// A rating of a measured value, and its error by the slope there.
template <class Rating>
Measured rated(const Measured& measured, const Rating& rating) {
  const double step = measured.value > 0 ? 1e-4 * measured.value : 1e-9;
  const double slope = (rating(measured.value + step) - rating(measured.value - step)) / (2 * step);
  return {rating(measured.value), std::abs(slope) * measured.standard_error};
}

void rate_luminaires(ObserverGlare& glare, double coverage) {
  std::vector<Source> sources;
  double direct = 0;
  bool large = false;
  for (const VisibleLuminaire& seen : glare.luminaires) {
    sources.push_back(seen.source());
    direct += seen.illuminance;
    large = large || seen.projected_area > defaults::large_source_area;
  }
  if (sources.empty() || !(glare.background.value > 0)) return;
  glare.ugr = rated(glare.background, [&](double background) { return ugr(sources, background); });
  if (large) {
    glare.ggr = ggr(glare.ugr->value, direct, glm::pi<double>() * glare.background.value, coverage);
  }
}

LuminancePicture luminance_of(const LightLayers& layers, const LightMix& mix) {
  std::vector<glm::vec3> rgb(static_cast<std::size_t>(layers.width) *
                             static_cast<std::size_t>(layers.height));
  combine_layers(layers, mix, rgb);
  const double candela = mix.unit() == PowerUnit::watt ? mix.lumen_per_watt : 1.0;
  LuminancePicture picture{layers.width, {}};
  for (const glm::vec3& pixel : rgb) {
    picture.luminance.push_back(static_cast<float>(candela * luminance(glm::dvec3(pixel))));
  }
  return picture;
}

void rate_picture(ObserverGlare& glare) {
  const std::vector<Source> sources = glare.picture->plain_sources();
  const auto rating = [&](double illuminance) { return dgp(sources, illuminance); };
  glare.dgp = rated(glare.illuminance, rating);
  glare.dgp_low_light = rated(glare.illuminance, [&](double illuminance) {
    return low_light_correction(illuminance) * rating(illuminance);
  });
  if (!sources.empty()) glare.dgi = dgi(sources, glare.picture->background);
}

/// Renders each observer's view, from one set of photon maps.
void take_pictures(const Scene& scene, const LightMix& mix, std::span<Device> devices,
                   const GlareParameters& parameters, const KeepPicture& keep,
                   std::vector<ObserverGlare>& all, Progress& progress) {
  RenderParameters render = parameters.measuring.photons;
  render.film.width = render.film.height = parameters.picture_side;
  std::optional<SceneRenderer> maps;
  if (!parameters.measuring.by_paths)
    maps.emplace(scene, devices, render, nullptr, KeepPhotons{}, progress);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Camera camera = eye_of(scene, all[i].observer);
    const LightLayers layers = maps ? maps->render(camera, render.film, progress).layers
                                    : trace_paths(scene, camera, eye_rays(render), progress).layers;
    if (keep) keep(i, camera, layers);
    all[i].picture = find_sources(luminance_of(layers, mix), parameters.search);
    rate_picture(all[i]);
  }
}

}  // namespace

Camera eye_of(const Scene& scene, const Observer& in_file) {
  const Observer observer = in_scene(scene, in_file);
  Camera camera;
  camera.name = observer.name;
  camera.position = observer.position;
  camera.forward = observer.forward;
  camera.up = observer.up;
  camera.right = glm::cross(observer.forward, observer.up);
  camera.projection = Projection::angular;
  camera.vertical_field_of_view = glm::pi<double>();
  camera.aspect_ratio = 1;
  return camera;
}

double coverage_by_luminaires(const Scene& scene, const Observer& observer, int samples) {
  const trace::PlanAxes axes;
  const RayScene rays(scene);
  const double area = Luminaires(rays, samples).large_area(axes.up);
  if (!(area > 0)) return 1;
  const auto room = trace::Room::around(rays, axes, position_in_scene(scene, observer.position));
  if (!room) return 1;
  return area / (static_cast<double>(room->positions().size()) * room->cell_area());
}

std::vector<ObserverGlare> measure_glare(const Scene& scene, std::span<const Observer> observers,
                                         const LightMix& mix, double coverage,
                                         std::span<Device> devices,
                                         const GlareParameters& parameters, const KeepPicture& keep,
                                         Progress& progress) {
  const measuring::SensorGrid eyes = eyes_of(observers);
  const measuring::Readings readings = measuring::measure_grids(
      scene, std::span(&eyes, 1), mix, devices, parameters.measuring, progress);
  const std::vector<Measured> illuminance = measuring::means_of(readings.repeats_of(0));
  const RayScene rays(scene);
  const Luminaires luminaires(rays, parameters.samples);
  const std::vector<std::vector<bool>> reached = reached_by(readings);
  std::vector<ObserverGlare> all(observers.size());
  progress.begin("luminaires", observers.size(), "observers");
  for (std::size_t i = 0; i < observers.size(); ++i) {
    ObserverGlare& glare = all[i];
    glare.observer = observers[i];
    glare.illuminance = illuminance[2 * i];
    glare.reached_by = reached[2 * i];
    const Measured& indirect = illuminance[2 * i + 1];
    glare.background = {indirect.value / glm::pi<double>(),
                        indirect.standard_error / glm::pi<double>()};
    glare.luminaires = luminaires.seen_by(observers[i], mix);
    rate_luminaires(glare, coverage);
    progress.advance(1);
  }
  progress.end();
  if (parameters.by_pictures) take_pictures(scene, mix, devices, parameters, keep, all, progress);
  return all;
}

std::vector<Observer> observers_at(const measuring::SensorGrid& points,
                                   const trace::PlanAxes& axes) {
  std::vector<Observer> observers;
  for (std::size_t i = 0; i < points.sensors.size(); ++i) {
    const Sensor& point = points.sensors[i];
    observers.push_back(Observer::looking(fmt::format("{} {}", points.name, i + 1), point.position,
                                          point.normal, axes.up));
  }
  return observers;
}

std::vector<Observer> observers_on(const measuring::SensorGrid& plane, const trace::PlanAxes& axes,
                                   int directions) {
  std::vector<Observer> observers;
  for (std::size_t i = 0; i < plane.sensors.size(); ++i) {
    for (int direction = 0; direction < directions; ++direction) {
      const double turn = glm::two_pi<double>() * direction / directions;
      observers.push_back(Observer::looking(
          fmt::format("{} {}, {:g} degrees", plane.name, i + 1, 360.0 * direction / directions),
          plane.sensors[i].position, std::cos(turn) * axes.ahead + std::sin(turn) * axes.right,
          axes.up));
    }
  }
  return observers;
}

}  // namespace photile::glare
