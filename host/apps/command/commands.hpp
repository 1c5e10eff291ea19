// The subcommands. Each function adds one to the command line; its callback does the work and
// throws photile::Error.
#pragma once

namespace CLI {
class App;
}

namespace photile::app {

void add_render_command(CLI::App& photile);
void add_relight_command(CLI::App& photile);
void add_compare_command(CLI::App& photile);
void add_measure_command(CLI::App& photile);
void add_daylight_command(CLI::App& photile);
void add_glare_command(CLI::App& photile);
void add_ies_command(CLI::App& photile);
void add_settings_command(CLI::App& photile);
void add_trade_command(CLI::App& photile);
void add_devices_command(CLI::App& photile);
void add_info_command(CLI::App& photile);
void add_validate_command(CLI::App& photile);
void add_trace_command(CLI::App& photile);
void add_merge_command(CLI::App& photile);
void add_walk_command(CLI::App& photile);
void add_view_command(CLI::App& photile);
void add_bake_command(CLI::App& photile);

}  // namespace photile::app
