// The table of settings, and the plan that follows from them.
#include "render/setting.hpp"

#include <limits>
#include <set>

#include "photile/limits.hpp"
#include "pictures.hpp"
#include "render/render_plan.hpp"

namespace photile::test {
namespace {

using Catch::Contains;

/// A value of the range that no setting has by default.
SettingValue another_value(const Setting& setting) {
  if (const auto* words = std::get_if<Words>(&setting.range)) {
    const bool usual = setting.value(RenderParameters{}) == SettingValue{words->words.front()};
    return usual ? words->words.back() : words->words.front();
  }
  if (std::holds_alternative<WholeNumbers>(setting.range)) return std::uint64_t{37};
  return 0.7;
}

/// Values just beyond the range, of its own kind and of none.
std::vector<SettingValue> values_beyond(const Setting& setting) {
  if (const auto* whole = std::get_if<WholeNumbers>(&setting.range)) {
    std::vector<SettingValue> values;
    if (whole->least > 1) values.push_back(whole->least - 1);
    if (whole->most < std::numeric_limits<int>::max()) values.push_back(whole->most + 1);
    return values;
  }
  if (const auto* numbers = std::get_if<Numbers>(&setting.range)) {
    return {numbers->least - 0.001, numbers->most + 0.001,
            std::numeric_limits<double>::quiet_NaN()};
  }
  if (std::holds_alternative<PositiveNumbers>(setting.range)) {
    return {-1.0, 1e-60, std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::quiet_NaN()};
  }
  return {};
}

RenderParameters small() {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 5'000;
  parameters.film = {16, 12, 2};
  return parameters;
}

}  // namespace

TEST_CASE("each setting is named once, holds what it is set to, and is refused out of its range") {
  std::set<std::string_view> names;
  CHECK_NOTHROW(check(RenderParameters{}));
  for (const Setting& setting : settings()) {
    CAPTURE(setting.name);
    CHECK(names.insert(setting.name).second);
    CHECK_FALSE(setting.help.empty());
    CHECK_FALSE(setting.reader.empty());
    RenderParameters parameters;
    parameters.neighbours = 100;  // as many as the least neighbours at least
    const SettingValue value = another_value(setting);
    CHECK(setting.value(parameters) != value);
    setting.set(parameters, value);
    CHECK(setting.value(parameters) == value);
    CHECK(setting.is_given(parameters));
    CHECK_NOTHROW(check(parameters));
    for (const SettingValue& beyond : values_beyond(setting)) {
      setting.set(parameters, beyond);
      CHECK_THROWS_WITH(check(parameters), Contains(std::string(setting.name)) &&
                                               Contains(text_of(setting.range)) && !Contains("--"));
    }
  }
}

TEST_CASE("counts below zero, and settings that go with no other, are refused as they were given") {
  RenderParameters parameters;
  SECTION("neighbours") {
    parameters.neighbours = -3;
    CHECK_THROWS_WITH(check(parameters), "neighbours: '-3' is not a whole number from 1 to " +
                                             std::to_string(limits::max_neighbours));
  }
  SECTION("passes") {
    parameters.passes = -1;
    CHECK_THROWS_WITH(check(parameters), Contains("passes: '-1'"));
  }
}

TEST_CASE("saved photons tell all that they depend on, and nothing else") {
  const RenderParameters usual;
  for (const Setting& setting : settings()) {
    CAPTURE(setting.name);
    RenderParameters other = usual;
    setting.set(other, another_value(setting));
    CHECK((photon_settings(other) == photon_settings(usual)) ==
          (setting.kept == nullptr || setting.kept_for_groups));
    CHECK((group_settings(other) == group_settings(usual)) == !setting.kept_for_groups);
  }
  RenderParameters more = usual;
  more.radius = 0.2;
  const std::string by_radius = group_settings(more);
  more.neighbours = 12;  // the radius no longer follows it
  CHECK(group_settings(more) == by_radius);
  const std::string by_photons = photon_settings(more);
  more.direct_rays = 1;
  const std::string by_rays = photon_settings(more);
  CHECK(by_rays != by_photons);
  more.direct_rays = 5;
  CHECK(photon_settings(more) == by_rays);
}

TEST_CASE("a plan draws from what is asked what follows from it") {
  const Scene scene = furnished_room();
  const RayScene rays(scene);
  RenderParameters asked = small();
  asked.neighbours = 80;
  const auto plan = [&] { return RenderPlan(asked, rays, HitsAsk::pictures, Progress::none()); };
  CHECK(plan().passes() == 1);
  CHECK(plan().estimate(0, DensityKernel::constant, nullptr).neighbours == 80);
  CHECK(plan().tracing(0, {}).store_direct);
  CHECK_FALSE(plan().tracing(0, {}).keep_caustics);
  CHECK(plan().clips_areas());

  asked.direct_rays = 3;
  CHECK_FALSE(plan().tracing(0, {}).store_direct);
  CHECK(plan().hits({16, 12, 2}, 1).direct_rays == 3);
  asked.direct_rays = 0;

  asked.maps = MapMode::naive;
  CHECK_FALSE(plan().clips_areas());
  CHECK(plan().used().area == AreaMode::disc);

  asked.passes = 7;
  CHECK(plan().hits({16, 12, 9}, 7).samples_per_pixel == 14);
  CHECK(plan().hits({16, 12, 9}, 7).passes == 7);
  CHECK(plan().hits({16, 12, 9}, 1).samples_per_pixel == 9);
  std::uint64_t paths = 0;
  for (int pass = 0; pass < 7; ++pass) paths += plan().tracing(pass, {0, 0}).emitted_photons;
  CHECK(paths == 5'000);
  CHECK(plan().maps(3, 0.5).radius < 0.5);
}

TEST_CASE("asked for what a picture was made with, render gives it again, bit for bit") {
  const Scene scene = furnished_room();
  RenderParameters asked = small();
  SECTION("an automatic radius") {}
  SECTION("passes") { asked.passes = 3; }
  SECTION("rays that gather") { asked.light_map_rays = 2; }
  SECTION("naive maps") { asked.maps = MapMode::naive; }
  const RenderResult first = render(scene, room_camera(), device(), asked);
  const RenderResult again = render(scene, room_camera(), device(), first.used);
  CHECK(same_bits(first.layers, again.layers));
  for (const Setting& setting : settings()) {
    CAPTURE(setting.name);
    CHECK(setting.value(first.used) == setting.value(again.used));
    CHECK(setting.is_given(first.used) ==
          (setting.is_given(asked) || setting.name == "radius" || setting.name == "passes"));
  }
}

TEST_CASE("a picture of gigabytes is told of before anything is traced, or refused") {
  /// Stops at the first line.
  class FirstLine : public Progress {
   public:
    void note(const std::string& line) override {
      told = line;
      throw Interrupted();
    }
    std::string told;
  } progress;
  RenderParameters asked = small();
  asked.film = {limits::max_image_side, limits::max_image_side, 1};
  const Scene scene = closed_box(diffuse(0.5f));
  const auto line_of = [&](const auto& make) {
    progress.told.clear();
    try {
      make();
    } catch (const Interrupted&) {
      return progress.told;
    } catch (const UsageError& error) {  // of a machine with less
      return std::string(error.what());
    }
    return std::string();
  };
  // 16 bytes for each pixel and light.
  CHECK_THAT(line_of([&] { render(scene, room_camera(), device(), asked, progress); }),
             Contains("16384 x 16384 pixels with 1 light takes 4.3 GB"));
  CHECK_THAT(line_of([&] { trace_paths(scene, room_camera(), eye_rays(asked), progress); }),
             Contains("takes 4.3 GB"));
}

}  // namespace photile::test
