#include <algorithm>
#include <memory>
#include <utility>

#include "photile/errors.hpp"
#include "photile/layered_picture.hpp"
#include "photile/quiet_progress.hpp"
#include "photile/settings.hpp"
#include "tools/trade/trade.hpp"

namespace photile {
namespace {

/// Stages of render() that a further frame repeats.
bool is_of_frame(const std::string& stage) {
  return stage == "primary hits" || stage == "radiance estimate" ||
         stage == "film";
}

std::uint64_t programs_built(std::span<const Device> devices) {
  std::uint64_t count = 0;
  for (const Device& device : devices) count += device.programs_built();
  return count;
}

class Trade {
 public:
  Trade(const TradeSubject& subject, const RenderParameters& base, const TradeAxes& axes,
        Progress& progress)
      : subject_(subject), base_(base), axes_(axes), progress_(progress) {}

  std::vector<TradePoint> run() {
    const std::vector<TradePoint> planned = plan();
    progress_.begin("measure settings", planned.size() + axes_.radius_scales.size(), "settings");
    for (const TradePoint& point : planned) add(point.varied, point.parameters);
    for (const double scale : axes_.radius_scales) {
      RenderParameters parameters = base_;
      parameters.radius = scale * automatic_radius_;
      add("radius", parameters);
    }
    progress_.end();
    mark_front(points_);
    return std::move(points_);
  }

 private:
  struct Timed {
    RenderResult result;
    double seconds;
  };

  /// Without the compilation of kernels, which a user pays once: where there was any, again.
  Timed timed_render(const RenderParameters& parameters) const {
    QuietProgress quiet(progress_);
    for (bool again = true;; again = false) {
      const std::uint64_t built = programs_built(subject_.devices);
      const Stopwatch stopwatch;
      RenderResult result =
          render(subject_.scene, subject_.camera, subject_.devices, parameters, quiet);
      const double seconds = stopwatch.seconds();
      if (!again || programs_built(subject_.devices) == built) return {std::move(result), seconds};
    }
  }

  /// All settings but those of the radius, which the settings of `base_` tell when rendered.
  std::vector<TradePoint> plan() const {
    std::vector<TradePoint> planned;
    const auto vary = [&](const char* varied, const auto& values, const auto& set) {
      for (const auto& value : values) {
        RenderParameters parameters = base_;
        set(parameters, value);
        planned.push_back({.varied = varied, .parameters = parameters});
      }
    };
    for (const std::uint64_t photons : axes_.photons) {
      vary("photons and neighbours", axes_.neighbours, [&](auto& parameters, int k) {
        parameters.photons.emitted_photons = photons;
        parameters.neighbours = k;
      });
    }
    for (const std::uint64_t photons : axes_.photons) {
      vary("own neighbours", axes_.least_neighbours, [&](auto& parameters, int least) {
        parameters.photons.emitted_photons = photons;
        parameters.least_neighbours = least;
        parameters.neighbours =
            axes_.neighbours.empty() ? base_.neighbours : axes_.neighbours.back();
      });
    }
    vary("nothing", std::array{0}, [](auto&, int) {});
    vary("samples", axes_.samples,
         [](auto& p, int samples) { p.film.samples_per_pixel = samples; });
    vary("angle", axes_.angles, [](auto& p, double angle) { p.angle_degrees = angle; });
    vary("cell", axes_.photons_per_cell, [](auto& p, float count) { p.photons_per_cell = count; });
    vary("area", axes_.areas, [](auto& p, AreaMode area) { p.area = area; });
    vary("direct rays", axes_.direct_rays, [](auto& p, int looks) { p.direct_rays = looks; });
    vary("node rays", axes_.node_rays, [](auto& p, int rays) {
      set_quality(p, Quality::good);
      p.photons.emitted_photons = p.photons.emitted_photons * static_cast<std::uint64_t>(rays) /
                                  static_cast<std::uint64_t>(p.light_map_rays);
      p.light_map_rays = rays;
    });
    vary("kernel", axes_.kernels, [](auto& p, DensityKernel kernel) { p.kernel = kernel; });
    vary("maps", axes_.maps, [](auto& p, MapMode mode) { p.maps = mode; });
    vary("structure", axes_.structures, [](auto& p, MapStructure s) { p.structure = s; });
    return planned;
  }

  void add(const std::string& varied, const RenderParameters& parameters) {
    const auto [result, seconds] = timed_render(parameters);
    TradePoint point{.varied = varied, .parameters = parameters};
    point.first_picture_seconds = seconds;
    point.used = result.used;
    point.stored_photons = result.stored_photons;
    point.error =
        picture_error(mixed_picture(result.layers, subject_.mix)->root(), subject_.reference);
    for (const StageStatistics& stage : result.statistics) {
      if (is_of_frame(stage.stage)) point.frame_seconds += stage.seconds;
      point.host_bytes += stage.host_bytes;
      point.device_bytes += stage.device_bytes;
    }
    if (varied == "nothing") automatic_radius_ = result.used.radius;
    points_.push_back(std::move(point));
    progress_.advance(1);
  }

  const TradeSubject& subject_;
  const RenderParameters& base_;
  const TradeAxes& axes_;
  Progress& progress_;
  double automatic_radius_ = 0;
  std::vector<TradePoint> points_;
};

void check(const TradeSubject& subject, const RenderParameters& parameters) {
  const Film& film = parameters.film;
  if (subject.reference.width != film.width || subject.reference.height != film.height) {
    throw UsageError("the reference has " + std::to_string(subject.reference.width) + "x" +
                     std::to_string(subject.reference.height) + " pixels, the picture " +
                     std::to_string(film.width) + "x" + std::to_string(film.height) +
                     "; they have to be of one size");
  }
}

}  // namespace

std::vector<TradePoint> measure_trade(const TradeSubject& subject,
                                      const RenderParameters& parameters, const TradeAxes& axes,
                                      Progress& progress) {
  check(subject, parameters);
  return Trade(subject, parameters, axes, progress).run();
}

}  // namespace photile
