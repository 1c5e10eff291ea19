// What pages post, as the room takes it. Nothing in a request is trusted: all errors are InputError
// or UsageError, in a line that the page shows.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/json_object.hpp"
#include "photile/layered_picture.hpp"
#include "photile/renderer.hpp"
#include "serve/live_pictures.hpp"
#include "view/frame_worker.hpp"
#include "view/light_board.hpp"

namespace photile::serve {

/// The object that a body is.
nlohmann::json parsed(const std::string& body);

/// A vector of length 1.
glm::dvec3 direction_in(const JsonObject& object, const char* key);

/// Where a viewer looks. A sky whose hour the page sets is one layer.
///   mix   of the scene
view::FrameRequest view_in(const nlohmann::json& body, const LightMix& mix);

/// The lights of a page, in the order of the mix: "mix" has their power, and the tint's parts.
///   count   of lights
std::vector<ShownLight> lights_in(const nlohmann::json& body, std::size_t count);

/// The lamps of a page by their names.
view::LightBoard board_in(const nlohmann::json& lights, const LightMix& mix);

/// The settings with those that a page has changed.
RenderParameters settings_in(const nlohmann::json& body, RenderParameters parameters);
/// The settings that pages may change, as they show them.
nlohmann::json settings_of(const RenderParameters& parameters);

}  // namespace photile::serve
