// The glare ratings of observers in a scene.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "glare/luminaires.hpp"
#include "glare/picture_sources.hpp"
#include "glare/ratings.hpp"
#include "measuring/sensor_grid.hpp"
#include "photile/device.hpp"
#include "photile/light_layers.hpp"
#include "photile/progress.hpp"
#include "photile/sensors.hpp"
#include "trace/room.hpp"

namespace photile::glare {

struct GlareParameters {
  MeasuringParameters measuring;  ///< of the illuminance at the eyes; its photons are the pictures'
  bool by_pictures = true;  ///< whether daylight ratings are asked for: they take a picture each
  int picture_side = defaults::glare_picture_side;  ///< pixels
  SourceSearch search;
  int samples = defaults::samples_of_luminaire;  ///< at each luminaire
};

/// The glare of one observer.
struct ObserverGlare {
  Observer observer;
  Measured illuminance;          ///< lux at the eye, on a plane that faces forward
  Measured background;           ///< cd/m2: without what comes straight from luminaires, over pi
  std::vector<bool> reached_by;  ///< per layer of the scene, whether its light is part of that
  std::vector<VisibleLuminaire> luminaires;
  std::optional<Measured> ugr;  ///< none where no luminaire is seen, or nothing lies behind them
  std::optional<double> ggr;    ///< where luminaires are larger than large_source_area
  std::optional<PictureGlare> picture;

  // Where there is a picture, with the illuminance above.
  std::optional<Measured> dgp;
  std::optional<Measured> dgp_low_light;  ///< times low_light_correction
  std::optional<double> dgi;              ///< none without glare sources
};

/// A picture of an observer's view, as it was rendered.
using KeepPicture =
    std::function<void(std::size_t observer, const Camera& camera, const LightLayers& layers)>;

/// Area of the luminaires over that of the ceiling of the observer's room; 1 where there is no such
/// room.
double coverage_by_luminaires(const Scene& scene, const Observer& observer, int samples);

/// Rates the glare of each observer.
///   coverage   as `ggr` takes it
///   devices    may be empty for paths
///   keep       is called with each picture
/// Errors: those of `gather` and `render`.
std::vector<ObserverGlare> measure_glare(const Scene& scene, std::span<const Observer> observers,
                                         const LightMix& mix, double coverage,
                                         std::span<Device> devices,
                                         const GlareParameters& parameters,
                                         const KeepPicture& keep = {},
                                         Progress& progress = Progress::none());

/// The camera of an observer's pictures: 180 degrees of the angular projection, in the scene's
/// coordinates.
Camera eye_of(const Scene& scene, const Observer& observer);

/// An observer at each point, looking in its direction. Names are the grid's with the number of the
/// point, from 1.
std::vector<Observer> observers_at(const measuring::SensorGrid& points,
                                   const trace::PlanAxes& axes);

/// At each point of a level plane an observer in each of several directions, which are spread
/// evenly round the horizon and begin with `ahead`: the four of EN 12464-1 are along the walls of a
/// room that stands along the axes. Names say "plane 3, 90 degrees", clockwise as seen from above.
std::vector<Observer> observers_on(const measuring::SensorGrid& plane, const trace::PlanAxes& axes,
                                   int directions);

}  // namespace photile::glare
