// A page that shows a room, in one file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bake/baked_light.hpp"
#include "photile/image.hpp"
#include "photile/layered_picture.hpp"
#include "photile/scene.hpp"
#include "publish/light_choices.hpp"

namespace photile::publish {

/// The first camera with a perspective, where there is one; otherwise the first.
const Camera& opening_camera(const Scene& scene);

struct PublishedRoom {
  const Scene& scene;
  const Camera& opening;  ///< that the page opens with
  const bake::LightAtlas& atlas;
  const bake::BakedLight* light;  ///< of the atlas; null where a server sends it (serve/)
  int edition = 0;                ///< of a page whose light a server sends, from 1
  const LightMix& mix;            ///< as the page opens
  const LightTable* node_errors;  ///< as GatheredNodes::errors; null where photons fill nodes ...
  double relative_error = 0;      ///< ... which all err by this part
  std::vector<Preset> presets;
  SkyHours hours;
  ToneMapping display;  ///< with its light: of the picture by `photile render` from the opening
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

/// The page without a room: page/page.html with its style and scripts, joined when photile is
/// built. It has @TITLE@, @ROOM@ and @DATA@ where these belong.
std::string_view page_template();

}  // namespace photile::publish
