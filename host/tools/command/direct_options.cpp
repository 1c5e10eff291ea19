#include "tools/command/direct_options.hpp"

#include <CLI/CLI.hpp>
#include <string>

#include "photile/errors.hpp"
#include "photile/limits.hpp"
#include "tools/command/validators.hpp"

namespace photile::app {

void add_direct_options(CLI::App& command, RenderOptions& options) {
  command
      .add_option("--direct", options.direct,
                  "what brings the light straight from lamps; rays: sharp shadows")
      ->type_name("")
      ->check(CLI::IsMember({"photons", "rays"}))
      ->capture_default_str()
      ->each([&options](const std::string&) { options.own_direct = true; })
      ->group("Estimate");
  command
      .add_option("--direct-rays", options.direct_rays,
                  "looks at lamps from a hit, with --direct rays or --final-gather")
      ->type_name("N")
      ->transform(count_between(1, limits::max_direct_rays))
      ->capture_default_str()
      ->group("Estimate");
}

void add_final_gather_option(CLI::App& command, RenderOptions& options) {
  command
      .add_option(
          "--final-gather", options.parameters.final_gather_rays,
          "rays from each hit that gather the light of other surfaces; direct light by rays")
      ->type_name("N")
      ->transform(count_between(0, limits::max_final_gather_rays))
      ->capture_default_str()
      ->group("Estimate");
}

void apply_direct_words(RenderOptions& options) {
  const bool gathers = options.parameters.final_gather_rays > 0;
  if (gathers && options.own_direct && options.direct == "photons") {
    throw UsageError(
        "--final-gather finds the light straight from lamps by rays; leave out --direct photons");
  }
  options.parameters.film.direct_rays =
      gathers || options.direct == "rays" ? options.direct_rays : 0;
}

}  // namespace photile::app
