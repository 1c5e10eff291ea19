#include "command/sensor_options.hpp"

#include <CLI/CLI.hpp>

#include "command/validators.hpp"
#include "photile/limits.hpp"

namespace photile::app {

void add_sensor_options(CLI::App& command, MeasuringParameters& parameters,
                        const std::string& group) {
  command.add_option("--rays", parameters.gathering.rays, "rays of each point and repeat")
      ->type_name("N")
      ->transform(count_between(1, limits::max_samples_per_pixel))
      ->capture_default_str()
      ->group(group);
  command
      .add_option("--repeats", parameters.repeats,
                  "measurements with photons of their own, whose scatter is the standard error")
      ->type_name("N")
      ->transform(count_between(2, limits::max_repeats))
      ->capture_default_str()
      ->group(group);
}

void add_maintenance_option(CLI::App& command, MeasuringParameters& parameters,
                            const std::string& group) {
  command
      .add_option("--maintenance", parameters.maintenance,
                  "factor of all values for ageing and dirt, above 0 up to 1")
      ->type_name("X")
      ->transform(share_up_to(1))
      ->capture_default_str()
      ->group(group);
}

}  // namespace photile::app
