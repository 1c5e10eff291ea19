// A page that shows a room, in one file.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/baked_light.hpp"
#include "photile/estimator.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/load_scene.hpp"
#include "photile/scene.hpp"

namespace photile::publish {

/// Light settings by a name that people choose from.
struct Preset {
  std::string name;
  LightMix mix;
  std::vector<double> kelvins;  ///< per light: the colour temperature that was asked for; 0 = none
};

/// The preset of a mood. Errors: those of change_lights.
Preset preset_of(const std::string& name, const LightMix& mix,
                 const std::vector<LightChange>& changes);
/// As the page has them.
nlohmann::json to_json(const std::vector<Preset>& presets);

/// The luminances of a sky in patches over the hours of some days.
struct SkyHours {
  std::vector<std::string> dates;
  std::vector<double> times;       ///< hours from midnight, of each date
  std::vector<double> luminances;  ///< cd/m2: [date][time][patch], the ground last
  std::size_t lights = 0;          ///< patches, and the ground
  std::size_t start_date = 0;      ///< that the page opens with ...
  double start_time = 0;           ///< ... and the place in `times`
};

/// The 21st of each month, each half hour, for the patches of the mix; empty where it has none, or
/// where no place is known. The sky is clear, or that of the weather file's hours.
/// Errors: those of read_weather.
SkyHours sky_hours(const LightMix& mix, const SkySituation& situation);

/// The camera that the page opens with: the first with a perspective, where there is one.
const Camera& opening_camera(const Scene& scene);

struct PublishedRoom {
  const Scene& scene;
  const Camera* opening = nullptr;  ///< that the page opens with; null = the first of the scene
  const bake::LightAtlas& atlas;
  const bake::BakedLight* light;  ///< of the atlas; null where a server sends it (serve/)
  int edition = 0;                ///< of a page whose light a server sends, from 1
  const LightMix& mix;            ///< as the page opens
  const LightTable* node_errors;  ///< as GatheredNodes::errors; null where photons fill nodes ...
  double relative_error = 0;      ///< ... which all err by this part
  std::vector<Preset> presets;
  SkyHours hours;
  ToneMapping display;  ///< with its light: of the picture by `photile render` from the first
                        ///< camera, as stops
  std::string title;
  std::string version;
};

/// Errors: InputError where there are more materials than the vertices of a page can name.
void check_materials(const Scene& scene);

/// The text of the page. Where its light is sent, it requests that from the server that it came
/// from.
std::string page_text(const PublishedRoom& room);

/// Writes the page. It loads nothing from elsewhere. Errors: OutputError.
void write_page(const std::filesystem::path& file, const PublishedRoom& room);

}  // namespace photile::publish
