#include "trade/trade.hpp"

#include <string_view>

#include "photile/progress.hpp"
#include "render/quality.hpp"
#include "render/setting.hpp"

namespace photile::trade {
namespace {

/// Stages of render() that a further frame repeats.
bool is_of_frame(std::string_view stage) {
  return stage == "primary hits" || stage == "radiance estimate" || stage == "film";
}

std::uint64_t programs_built(std::span<const Device> devices) {
  std::uint64_t count = 0;
  for (const Device& device : devices) count += device.programs_built();
  return count;
}

/// Without the compilation of kernels, which a user waits for once: where kernels were compiled,
/// the rendering is repeated.
TradePoint measured(const TradeSubject& subject, const TradeSettings& settings,
                    Progress& progress) {
  QuietProgress quiet(progress);
  RenderResult result;
  double seconds = 0;
  std::uint64_t built = 0;
  do {
    built = programs_built(subject.devices);
    const Stopwatch stopwatch;
    result = render(subject.scene, subject.camera, subject.devices, settings.parameters, quiet);
    seconds = stopwatch.seconds();
  } while (programs_built(subject.devices) != built);
  TradePoint point{settings, result.used, result.stored_photons};
  point.error = picture_error(mixed_picture(result.layers, subject.mix)->root(), subject.reference);
  point.first_picture_seconds = seconds;
  for (const StageStatistics& stage : result.statistics) {
    if (is_of_frame(stage.stage)) point.frame_seconds += stage.seconds;
    point.host_bytes += stage.host_bytes;
    point.device_bytes += stage.device_bytes;
  }
  return point;
}

}  // namespace

std::vector<TradeSettings> settings_around(const RenderParameters& parameters) {
  std::vector<TradeSettings> all{{"nothing", parameters}};
  const auto of = [&](std::string_view name, double factor) {
    return scaled(setting_named(name), parameters, factor);
  };
  for (const double photons : {1. / 16, 0.25, 1., 4.}) {
    RenderParameters pair = parameters;
    set_by_name(pair, "photons_emitted", of("photons_emitted", photons));
    for (const double neighbours : {1. / 16, 0.25, 1., 4.}) {
      set_by_name(pair, "neighbours", of("neighbours", neighbours));
      all.push_back({"photons and neighbours", pair});
    }
  }
  RenderParameters good = parameters;
  set_quality(good, Quality::good);
  for (const double factor : {0.25, 0.5, 1., 2., 4.}) {
    all.push_back({"work of good", with_work(good, factor)});
  }
  const auto vary = [&](std::string_view name, std::initializer_list<SettingValue> values) {
    for (const SettingValue& value : values) {
      if (value == setting_named(name).value(parameters)) continue;
      all.push_back({std::string(name), parameters});
      set_by_name(all.back().parameters, name, value);
    }
  };
  vary("samples_per_pixel", {of("samples_per_pixel", 0.25), of("samples_per_pixel", 4)});
  vary("angle_degrees", {30., 90.});
  vary("photons_per_cell", {of("photons_per_cell", 0.25), of("photons_per_cell", 4)});
  vary("area", {"disc"});
  for (const DensityKernel kernel : all_density_kernels) {
    vary("kernel", {std::string(name_of(kernel))});
  }
  vary("direct_rays", {std::uint64_t{1}, std::uint64_t{4}});
  vary("maps", {"naive", "triangle", "patch"});
  return all;
}

std::vector<TradePoint> measure_trade(const TradeSubject& subject,
                                      std::span<const TradeSettings> settings, Progress& progress) {
  progress.begin("measure settings", settings.size(), "settings");
  std::vector<TradePoint> points;
  for (const TradeSettings& one : settings) {
    points.push_back(measured(subject, one, progress));
    progress.advance(1);
  }
  progress.end();
  return points;
}

const TradePoint* fastest_within(std::span<const TradePoint> points, double error) {
  const TradePoint* fastest = nullptr;
  for (const TradePoint& point : points) {
    if (!(point.error.relative_error() <= error)) continue;
    if (!fastest || point.first_picture_seconds < fastest->first_picture_seconds) {
      fastest = &point;
    }
  }
  return fastest;
}

}  // namespace photile::trade
