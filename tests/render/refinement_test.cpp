// The errors that a picture states, and what is done about them.
#include "render/refinement.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "photile/renderer.hpp"
#include "render/film.hpp"
#include "render/quality.hpp"
#include "render/setting.hpp"

namespace photile::test {
namespace {

// When pictures are made again, and when not: pictures whose error and time follow formulas.

/// Pictures of relative error `error_of_one` / sqrt(rays), rounds that take time by their rays.
struct Studio {
  double error_of_one = 0.16;  ///< 2% with 64 rays
  double power_of_error = 0.5;
  double seconds_of_good = 10;
  double power_of_time = 1.0;  ///< of all rounds together
  double clock = 0;
  int parts = 0;
  RenderParameters part;
  std::vector<RenderParameters> made;
  std::vector<double> finished_at;

  double seconds(double rays) const {
    return seconds_of_good * std::pow(rays / 64.0, power_of_time);
  }
  double error(const RenderParameters& p) const {
    return error_of_one / std::pow(p.light_map_rays, power_of_error);
  }

  RefinementSteps steps() {
    return {.add =
                [this](int more, Progress& progress) {
                  constexpr int slices = 1000;
                  const double before = seconds(parts * part.light_map_rays);
                  const double after = seconds((parts + more) * part.light_map_rays);
                  for (int i = 0; i < slices; ++i) {
                    clock += (after - before) / slices;
                    progress.throw_if_cancelled();
                  }
                  parts += more;
                  made.push_back(of_parts(part, parts));
                  return error(made.back());
                },
            .finished =
                [this](int all, double of_all) {
                  CHECK(all == parts);
                  CHECK(of_all == error(made.back()));
                  finished_at.push_back(clock);
                },
            .elapsed = [this] { return clock; }};
  }

  /// The last error.
  double refine_to(const RefinementGoal& goal, const RenderParameters& asked,
                   Progress& progress = Progress::none()) {
    return refine_by(steps(), goal, asked, progress);
  }
  double refine_by(RefinementSteps steps, const RefinementGoal& goal, const RenderParameters& asked,
                   Progress& progress = Progress::none()) {
    part = first_part(goal, asked);
    steps.most_parts = most_work(part);
    return refine(goal, steps, progress);
  }
};

RenderParameters good() {
  RenderParameters parameters;
  parameters.photons.emitted_photons = 500'000;
  parameters.light_map_rays = 64;
  return parameters;
}

/// Keeps what it is told.
class Notes : public Progress {
 public:
  void note(const std::string& line) override { text += line + "\n"; }
  std::string text;
};

/// A user who stops after so many seconds.
class Stopped : public Progress {
 public:
  Stopped(const Studio& studio, double seconds) : studio_(studio), seconds_(seconds) {}
  bool cancelled() const override { return studio_.clock > seconds_; }

 private:
  const Studio& studio_;
  double seconds_;
};

TEST_CASE("refinement: a picture that is good enough is the only one") {
  Studio studio;
  const double error = studio.refine_to({.error = 0.025}, good());
  CHECK(studio.made.size() == 1);
  CHECK(studio.made.back().light_map_rays == 64);
  CHECK(error == Approx(0.02));
}

TEST_CASE("refinement: rounds add parts until the error is reached, and no more") {
  Studio studio;
  const double requested = GENERATE(0.015, 0.01, 0.008);
  const double error = studio.refine_to({.error = requested}, good());
  CHECK(error <= requested);
  CHECK(studio.made.size() == studio.finished_at.size());
  REQUIRE(studio.made.size() > 1);
  CHECK(studio.error(studio.made[studio.made.size() - 2]) > requested);
  const std::vector<int> expected{1, 2, 3, 4, 6, 8, 12, 16};
  for (std::size_t i = 0; i < studio.made.size(); ++i) {
    const RenderParameters &first = studio.made[0], &later = studio.made[i];
    CHECK(later.light_map_rays == expected[i] * first.light_map_rays);
    CHECK(later.film.samples_per_pixel == expected[i] * first.film.samples_per_pixel);
    CHECK(later.neighbours == first.neighbours);
  }
}

TEST_CASE("refinement: photons are traced anew when there are 16 parts, and four times as many") {
  CHECK(photons_of_parts(1) == 1);
  CHECK(photons_of_parts(15) == 1);
  CHECK(photons_of_parts(16) == 4);
  CHECK(photons_of_parts(63) == 4);
  CHECK(photons_of_parts(64) == 16);
}

TEST_CASE("refinement: for a time there is a part of the rays and samples, and of all photons") {
  const RenderParameters part = first_part({.seconds = 1}, good());
  CHECK(part.light_map_rays == 16);
  CHECK(part.film.samples_per_pixel == good().film.samples_per_pixel / 4);
  CHECK(part.photons.emitted_photons == 500'000);
  CHECK(first_part({.error = 0.1}, good()).light_map_rays == 64);
}

TEST_CASE("refinement: the settings of parts together say what each of them is") {
  const int parts = GENERATE(1, 2, 3, 7, 16, 64);
  const RenderParameters all = of_parts(good(), parts);
  CHECK(in_parts(all) == (parts > 1));
  RenderParameters known = all;
  known.passes = parts;
  const RenderParameters part = part_of(known);
  for (const Setting& setting : settings()) {
    CAPTURE(setting.name);
    if (setting.name == "passes" || setting.name == "light_maps") continue;
    CHECK(setting.value(part) == setting.value(good()));
  }
}

TEST_CASE("refinement: the quality final is good with four times the work") {
  RenderParameters good, final;
  set_quality(good, Quality::good);
  set_quality(final, Quality::best);
  const RenderParameters more = with_work(good, 4);
  for (const Setting& setting : settings()) {
    CAPTURE(setting.name);
    CHECK(setting.value(more) == setting.value(final));
  }
}

TEST_CASE("refinement: a time is kept, and the picture took a good part of it") {
  Studio studio;
  const double seconds = GENERATE(10.0, 30.0, 100.0, 1000.0);
  studio.power_of_time = GENERATE(0.9, 1.0, 1.1);
  studio.refine_to({.seconds = seconds}, good());
  CHECK(studio.clock <= 1.001 * seconds);
  CHECK(studio.made.size() == studio.finished_at.size());  // none was given up
  CHECK(studio.seconds(studio.made.back().light_map_rays) > 0.3 * seconds);
  CHECK(studio.made.front().light_map_rays == 16);
}

TEST_CASE("refinement: as many parts as the goal asks for are done, whatever the time") {
  Studio studio;
  const double seconds = GENERATE(0.0, 0.001);
  studio.refine_to({.seconds = seconds, .parts = 5}, good());
  REQUIRE(studio.made.size() == 5);  // by 1, 2, 3, 4 and 5 parts: 6 would be too many
  CHECK(studio.parts == 5);
  CHECK(studio.finished_at.size() == 5);
}

TEST_CASE("refinement: with an error and a time, neither is exceeded by much") {
  Studio studio;
  const double seconds = GENERATE(10.0, 1000.0);
  const double error = studio.refine_to({.error = 0.008, .seconds = seconds}, good());
  CHECK(studio.clock <= 1.001 * seconds);
  CHECK(error > 0.008 / std::sqrt(2.0));
  if (seconds == 1000) CHECK(error <= 0.008);
}

TEST_CASE(
    "refinement: after the first no round is begun that is not likely to fit in what is left") {
  Studio studio;
  studio.refine_to({.seconds = GENERATE(3.5, 0.001)}, good());
  CHECK(studio.made.size() == 1);  // took 2.5
  CHECK(studio.clock < 3);
}

TEST_CASE("refinement: a round that takes too long is given up, the picture before is kept") {
  Studio studio;
  RefinementSteps steps = studio.steps();
  const auto add = steps.add;
  steps.add = [&](int more, Progress& progress) {
    if (!studio.made.empty()) studio.seconds_of_good = 1e6;  // another program takes the machine
    return add(more, progress);
  };
  studio.refine_by(steps, {.seconds = 10}, good());
  CHECK(studio.made.size() == 1);
  CHECK(studio.made.back().light_map_rays == 16);
}

TEST_CASE("refinement: a user who stops is heard, and has the pictures so far") {
  Studio studio;
  Stopped progress(studio, 8);
  CHECK_THROWS_AS(studio.refine_to({.seconds = 1000}, good(), progress), Interrupted);
  CHECK(studio.finished_at.size() == 3);  // at 2.5, 5 and 7.5; the next would be at 10
  CHECK(studio.clock < 8.1);
}

TEST_CASE("refinement: an error below what all rays and photons leave is told at once") {
  Studio studio;
  Notes notes;
  studio.refine_to({.error = 1e-9}, good(), notes);
  CHECK(studio.made.size() == 1);
  CHECK(studio.made.back().light_map_rays == 64);
  CHECK_THAT(notes.text, Catch::Contains("1e-07% cannot be reached"));
}

TEST_CASE("refinement: an error that does not fall any longer is told") {
  Studio studio;
  RefinementSteps steps = studio.steps();
  const auto add = steps.add;
  steps.add = [&](int more, Progress& progress) {
    const double rays = (studio.parts + more) * studio.part.light_map_rays;
    studio.error_of_one = rays > 128 ? 0.014 * std::sqrt(rays) : 0.16;
    return add(more, progress);
  };
  Notes notes;
  studio.refine_by(steps, {.error = 0.005}, good(), notes);
  CHECK(studio.made.size() == 3);  // 2%, 1.41%, 1.4%
  CHECK_THAT(notes.text, Catch::Contains("0.5% cannot be reached: about 1.4%"));
}

TEST_CASE("refinement: ends where rays and photons cannot grow") {
  Studio studio;
  studio.seconds_of_good = 1e-9;
  studio.refine_to({.seconds = 1}, good());
  CHECK(studio.made.back().light_map_rays == limits::max_gathering_rays);
}

// The noise of a pixel's samples, told from the scatter of runs of them.

constexpr int run_count = 4;

std::vector<std::string> names(std::size_t count) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back("light" + std::to_string(i));
  return all;
}

TEST_CASE("errors of samples are those of the mean of runs, and add up in squares with others") {
  LightLayers errors(2, 1, names(1)), runs(2 * run_count, 1, names(1));
  errors.layers[0].radiance[1] = glm::vec3(0.3f);
  errors.layers[0].illuminance[1] = 2.0f;
  for (int run = 0; run < run_count; ++run) {
    runs.layers[0].radiance[run_count + run] = glm::vec3(1.0f, 0.5f * run, 10.0f * run);
    runs.layers[0].illuminance[run_count + run] = run == 0 ? 8.0f : 0.0f;
  }
  add_sample_errors(errors, runs);
  // The sum of four independent values that scatter by s varies by 4 s^2; that of strata at an edge
  // by half of it. Of 0, 1, 2, 3 s^2 is 5 / 3.
  const double of_steps = 2.0 * 5 / 3;
  const LightLayers::Layer& found = errors.layers[0];
  CHECK(found.radiance[0] == glm::vec3(0.0f));
  CHECK(found.radiance[1].r == Approx(0.3));
  CHECK(found.radiance[1].g == Approx(std::sqrt(0.09 + 0.25 * of_steps)));
  CHECK(found.radiance[1].b == Approx(std::sqrt(0.09 + 100 * of_steps)));
  CHECK(found.illuminance[1] == Approx(std::sqrt(4.0 + 2.0 * 16)));  // of 8, 0, 0, 0 s^2 is 16
}

TEST_CASE("errors of samples are the same in sparse layers") {
  const auto many = names(max_dense_lights + 1);
  LightLayers errors(2, 1, many), runs(2 * run_count, 1, many);
  REQUIRE(errors.sparse());
  errors.rows[0] = {{0, 1, 1}, {3}, {glm::vec3(0.3f)}, {0.0f}};
  // Light 3 in two runs of the first pixel, light 5 in one of the second.
  runs.rows[0] = {{0, 1, 2, 2, 2, 2, 2, 3, 3},
                  {3, 3, 5},
                  {glm::vec3(1.0f), glm::vec3(1.0f), glm::vec3(2.0f)},
                  {0.0f, 0.0f, 4.0f}};
  add_sample_errors(errors, runs);
  const LightLayers dense = errors.dense();
  CHECK(dense.layers[3].radiance[0].r == Approx(std::sqrt(0.09 + 2.0 / 3)));  // 1, 1, 0, 0
  CHECK(dense.layers[5].radiance[1].r == Approx(std::sqrt(2.0)));             // 2, 0, 0, 0
  CHECK(dense.layers[5].illuminance[1] == Approx(std::sqrt(8.0)));
  CHECK(dense.layers[3].radiance[1].r == 0.0f);
}

}  // namespace
}  // namespace photile::test
