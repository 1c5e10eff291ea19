#include "publish/published_room.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "common/files.hpp"
#include "common/foreign_text.hpp"
#include "image/display.hpp"
#include "loading/surroundings.hpp"
#include "measuring/requirements.hpp"
#include "photile/defaults.hpp"
#include "photile/errors.hpp"
#include "photile/ray_scene.hpp"
#include "publish/room_mesh.hpp"
#include "publish/sections.hpp"
#include "report/palette.hpp"
#include "report/printing.hpp"
#include "scene/light_emission.hpp"
#include "trace/distant_light.hpp"
#include "weather/sky_patches.hpp"

namespace photile::publish {
namespace {

using nlohmann::json;

/// Steps of coded standard errors, and of coded luminances of skies, to a factor of two.
constexpr int error_steps = 20, hour_steps = 256, hour_offset = 24;
/// Texels on a side of a block that has one standard error.
constexpr std::uint32_t error_block = 8;
/// Texels on a side of a texture, at most.
constexpr int most_texture_side = 1024;
/// Texels of surroundings across, at most.
constexpr int most_surroundings = 2048;
/// Parts of the room's size that positions are rounded to, and of 1 that normals are: 0.1 mm in a
/// room, and 0.1 degrees. Finer detail packs badly and is not visible.
constexpr int position_bits = 17, normal_steps = 511, normal_scale = 64;
/// Packing by zlib: of what is sent once, to a page that waits, and of what is kept.
constexpr int quickest = 1, smallest = 9;
/// Kelvin that the page offers (page/lights.js).
constexpr int lowest_kelvin = 1500, highest_kelvin = 10'000, kelvin_step = 100;

json numbers(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

json kelvins() {
  json table;
  for (int kelvin = lowest_kelvin; kelvin <= highest_kelvin; kelvin += kelvin_step) {
    table.push_back(numbers(scene::color_of_temperature(kelvin)));
  }
  return table;
}

/// Each palette's colours from low to high: six hexadecimal digits each.
json palettes() {
  json tables;
  for (const std::string& name : report::Palette::names()) {
    const report::Palette palette(name);
    std::string digits;
    for (int i = 0; i < 256; ++i) digits += palette.hex(i / 255.0).substr(1);
    tables.push_back({{"name", name}, {"colours", digits}});
  }
  return tables;
}

/// How places of the page become those of the scene's file.
json world_of(const Scene& scene) {
  json axes;
  for (int i = 0; i < 3; ++i) axes.push_back(numbers(direction_in_world(scene, glm::dmat3(1)[i])));
  return {{"origin", numbers(scene.origin)}, {"axes", axes}};
}

/// What `--target` knows by name.
json targets() {
  json list;
  for (const measuring::Requirement& row : measuring::known_requirements()) {
    if (row.is_direct) continue;
    list.push_back({{"area", row.area}, {"name", row.name}, {"what", row.what}, {"lux", row.mean}});
  }
  return list;
}

/// The display transform: the page takes all its numbers from here.
json display_of(const ToneMapping& display) {
  const image::DisplayTransform& numbers = image::display_transform;
  return {{"exposure", std::exp2(display.exposure)},
          {"white", display.white},
          {"view", name_of(display.view)},
          {"key", numbers.key},
          {"outliers", numbers.outlier_factor},
          {"share", numbers.light_share},
          {"black", numbers.black_factor},
          {"highlights", numbers.highlights},
          {"f90", numbers.f90},
          {"ks", numbers.ks},
          {"kd", numbers.kd},
          {"leastOfLight", numbers.least_of_light},
          {"glareLimit", defaults::glare_limit}};
}

json camera_of(const Camera& camera) {
  return {{"name", camera.name.empty() ? "view" : camera.name},
          {"position", numbers(camera.position)},
          {"forward", numbers(camera.forward)},
          {"angle", camera.vertical_field_of_view}};
}

class PageWriter {
 public:
  explicit PageWriter(const PublishedRoom& room)
      : room_(room), scene_(room.scene), sections_(room.light ? smallest : quickest) {}

  json document() {
    add_lights();
    if (room_.light) add_errors();
    add_mesh();
    add_surroundings();
    add_hours();
    json& d = document_;
    d["title"] = room_.title;
    d["live"] = room_.edition;
    d["version"] = room_.version;
    d["lux"] = in_unit(1, room_.mix.unit(), PowerUnit::lumen, room_.mix.lumen_per_watt);
    d["coding"] = {{"steps", steps_per_octave}, {"octaves", octaves}, {"chroma", chroma_steps}};
    d["atlas"] = {{"width", room_.atlas.width()}, {"height", room_.atlas.height()},
                  {"texel", room_.atlas.texel()}, {"used", room_.atlas.used_texels()},
                  {"block", error_block},         {"errorSteps", error_steps}};
    d["display"] = display_of(room_.display);
    d["temperatures"] = kelvins();
    d["palettes"] = palettes();
    d["legendSteps"] = defaults::legend_steps;
    d["targets"] = targets();
    d["world"] = world_of(scene_);
    d["cameras"] = {camera_of(room_.opening)};
    for (const Camera& camera : scene_.cameras) {
      if (camera.projection != Projection::perspective) continue;
      const json entry = camera_of(camera);
      if (entry != d["cameras"][0]) d["cameras"].push_back(entry);
    }
    d["probe"] = d["cameras"][0]["position"];
    d["presets"] = to_json(room_.presets);
    d["simplified"] = simplified();
    d["sections"] = sections_.table();
    return std::move(document_);
  }

  const std::string& bytes() const { return sections_.bytes(); }

 private:
  void add_lights() {
    const std::vector<std::uint32_t> patch_of = loading::patch_of_layers(room_.mix);
    const LightGroups groups = light_groups_of(scene_);
    const LightMix& mix = room_.mix;
    for (std::size_t i = 0; i < mix.lights.size(); ++i) {
      const MixedLight& light = mix.lights[i];
      json entry{{"name", light.name},
                 {"power", light.power},
                 {"scale", in_unit(1, light.unit, mix.unit(), mix.lumen_per_watt)},
                 {"unit", symbol_of(light.unit)},
                 {"color", numbers(light.color)},
                 {"tint", numbers(light.tint)}};
      if (room_.light) {
        entry["brightest"] = sections_.add_light(fmt::format("light{}", i), room_.light->layer(i),
                                                 room_.atlas.width());
      }
      if (patch_of[i] != none) {
        entry["patch"] = patch_of[i];
        entry["unitPower"] =
            groups.groups[i].power * in_unit(1, PowerUnit::lumen, light.unit, mix.lumen_per_watt);
      }
      document_["lights"].push_back(std::move(entry));
    }
    const std::vector<glm::vec3> radiance = emitted_radiance_at_unit_power(scene_);
    document_["emitters"] = json::array();
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
      document_["emitters"].push_back(
          {{"layer", groups.group_of[i]}, {"radiance", numbers(radiance[i])}});
    }
  }

  /// The root of the mean squared error of each block over that of its light.
  void add_errors() {
    const std::uint32_t width = room_.atlas.width(), height = room_.atlas.height();
    const std::uint32_t columns = (width + error_block - 1) / error_block;
    const std::uint32_t rows = (height + error_block - 1) / error_block;
    std::vector<std::uint8_t> codes;
    for (std::size_t layer = 0; layer < room_.mix.lights.size(); ++layer) {
      const std::vector<glm::vec3> light = room_.light->layer(layer);
      const std::vector<float> errors =
          room_.node_errors ? room_.light->errors(layer, *room_.node_errors) : std::vector<float>();
      std::vector<double> squares(std::size_t{columns} * rows), whole(squares.size());
      for (std::size_t i = 0; i < light.size(); ++i) {
        const std::size_t block = i / width / error_block * columns + i % width / error_block;
        const double value = luminance(glm::dvec3(light[i]));
        const double error = errors.empty() ? room_.relative_error * value : double{errors[i]};
        squares[block] += error * error;
        whole[block] += value * value;
      }
      for (std::size_t block = 0; block < squares.size(); ++block) {
        const double relative = whole[block] > 0 ? std::sqrt(squares[block] / whole[block]) : 0;
        const double code = relative > 0 ? 255 + std::round(error_steps * std::log2(relative)) : 0;
        codes.push_back(static_cast<std::uint8_t>(std::clamp(code, 0.0, 255.0)));
      }
    }
    sections_.add_bytes("errors", codes);
  }

  void add_mesh() {
    const RoomMesh mesh = mesh_of(scene_, room_.atlas);
    std::array<std::vector<float>, 3> axes;
    std::vector<float> uv;
    std::vector<std::uint16_t> normals, light_uv, kinds;
    glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
    for (const RoomVertex& vertex : mesh.vertices) {
      low = glm::min(low, vertex.position);
      high = glm::max(high, vertex.position);
    }
    // A power of two, so that roundings are exact.
    const float step = std::exp2(std::floor(std::log2(glm::length(high - low)))) /
                       static_cast<float>(1 << position_bits);
    for (const RoomVertex& vertex : mesh.vertices) {
      for (int axis = 0; axis < 3; ++axis) {
        axes[axis].push_back(step * std::round(vertex.position[axis] / step));
      }
      for (int axis = 0; axis < 2; ++axis) {
        uv.push_back(vertex.uv[axis]);
        light_uv.push_back(
            static_cast<std::uint16_t>(std::lround(65535.0f * vertex.light_uv[axis])));
      }
      for (int axis = 0; axis < 3; ++axis) {
        normals.push_back(static_cast<std::uint16_t>(static_cast<std::int16_t>(
            normal_scale * std::lround(normal_steps * vertex.normal[axis]))));
      }
      normals.push_back(0);
      kinds.push_back(static_cast<std::uint16_t>(vertex.material));
      kinds.push_back(static_cast<std::uint16_t>(vertex.light + 1));  // none is 0
    }
    for (int axis = 0; axis < 3; ++axis) {
      sections_.add_floats(std::string(1, "xyz"[axis]), axes[axis]);
    }
    sections_.add_words("normals", normals);
    sections_.add_words("light_uv", light_uv);
    sections_.add_words("kinds", kinds);
    if (std::any_of(uv.begin(), uv.end(), [](float place) { return place != 0; })) {
      sections_.add_floats("uv", uv);
    }
    sections_.add_indices("indices", mesh.indices);
    document_["low"] = numbers(low);
    document_["high"] = numbers(high);
    add_parts(mesh);
    for (const Material& material : scene_.materials) add_material(material);
  }

  void add_parts(const RoomMesh& mesh) {
    std::map<RoomTextures, std::size_t> number_of;
    document_["textures"] = json::array();
    for (const RoomPart& part : mesh.parts) {
      json entry{{"interaction", static_cast<int>(part.interaction)},
                 {"first", part.first},
                 {"count", part.count},
                 {"texture", nullptr},
                 {"emits", part.textures.emission != none},
                 {"clear", part.clear},
                 {"cutout", part.textures.opacity != none}};
      if (part.textures != RoomTextures{}) {
        const auto [place, is_new] = number_of.insert({part.textures, number_of.size()});
        if (is_new) add_texture(part.textures);
        entry["texture"] = place->second;
      }
      document_["parts"].push_back(std::move(entry));
    }
  }

  void add_texture(const RoomTextures& textures) {
    const Texture* colour = textures.emission != none ? &scene_.textures[textures.emission]
                            : textures.colour != none ? &scene_.textures[textures.colour]
                                                      : nullptr;
    const Texture* opacity =
        textures.opacity != none ? &scene_.textures[textures.opacity] : nullptr;
    const Texture& larger = colour ? *colour : *opacity;
    int width = larger.width(), height = larger.height(), step = 1;
    while (std::max(width, height) / step > most_texture_side) step *= 2;
    width = std::max(1, width / step);
    height = std::max(1, height / step);
    std::vector<std::uint8_t> texels;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        glm::vec4 sum(0.0f);
        for (int i = 0; i < step * step; ++i) {
          const glm::vec2 place(static_cast<float>(x * step + i % step) + 0.5f,
                                static_cast<float>(y * step + i / step) + 0.5f);
          const glm::vec2 uv = place / glm::vec2(width * step, height * step);
          glm::vec4 texel(1.0f);
          if (colour) texel = glm::vec4(glm::vec3(colour->sample_data(uv)), 1.0f);
          if (opacity) texel.a = opacity->sample_data(uv).a;
          sum += texel;
        }
        for (int c = 0; c < 4; ++c) {
          texels.push_back(static_cast<std::uint8_t>(
              std::lround(255.0f * sum[c] / static_cast<float>(step * step))));
        }
      }
    }
    json& list = document_["textures"];
    sections_.add_texture(fmt::format("texture{}", list.size()), texels,
                          static_cast<std::size_t>(width));
    list.push_back({{"width", width}, {"height", height}});
  }

  void add_material(const Material& material) {
    glm::vec3 diffuse = material.diffuse;
    if (material.interaction == Interaction::glass) diffuse = material.transmission;
    double alpha = 0;
    if (material.has_cutouts()) {
      alpha = material.opacity_cutoff > 0
                  ? material.opacity_cutoff / std::max(material.opacity, 1e-6f)
                  : -material.opacity;
    }
    document_["materials"].push_back({{"diffuse", numbers(diffuse)},
                                      {"alpha", alpha},
                                      {"specular", numbers(material.specular)},
                                      {"roughness", material.roughness},
                                      {"f90", material.f90},
                                      {"index", material.index_of_refraction},
                                      {"thin", material.thin}});
  }

  void add_surroundings() {
    document_["suns"] = json::array();
    document_["patches"] = json::array();
    document_["environment"] = nullptr;
    const LightGroups groups = light_groups_of(scene_);
    for (const trace::DistantLight& distant : trace::DistantLights(scene_)) {
      const Light& light = distant.source();
      const std::uint32_t layer = groups.group_of[distant.light()];
      if (light.is_sky_patch()) {
        const glm::vec4& bounds = light.sky_patch;
        const glm::dvec3 middle =
            weather::direction_of((bounds.x + bounds.y) / 2,
                                  std::asin(glm::clamp((bounds.z + bounds.w) / 2, -1.0f, 1.0f)));
        document_["patches"].push_back(
            {{"layer", layer},
             {"bounds", {bounds.x, bounds.y, bounds.z, bounds.w}},
             {"radiance", numbers(distant.radiance(glm::vec3(middle)))}});
      } else if (light.kind == LightKind::directional) {
        const glm::vec3 direction = -light.direction;
        document_["suns"].push_back({{"layer", layer},
                                     {"direction", numbers(direction)},
                                     {"cosine", std::cos(light.angular_diameter / 2)},
                                     {"radiance", numbers(distant.radiance(direction))}});
      } else if (document_["environment"].is_null()) {
        add_environment(distant, layer);
      }
    }
  }

  /// The map as the page queries it: azimuths from south by west, north in the middle, rows from
  /// the zenith.
  void add_environment(const trace::DistantLight& distant, std::uint32_t layer) {
    const EnvironmentMap& map = scene_.environments[distant.source().environment];
    const int width = std::clamp(map.width(), 4, most_surroundings), height = width / 2;
    std::vector<glm::vec3> texels;
    for (int y = 0; y < height; ++y) {
      const double elevation = std::numbers::pi * (0.5 - (y + 0.5) / height);
      for (int x = 0; x < width; ++x) {
        const double azimuth = 2 * std::numbers::pi * ((x + 0.5) / width - 0.5);
        texels.push_back(distant.radiance(glm::vec3(weather::direction_of(azimuth, elevation))));
      }
    }
    const double brightest =
        sections_.add_light("environment", texels, static_cast<std::size_t>(width));
    document_["environment"] = {
        {"layer", layer}, {"width", width}, {"height", height}, {"brightest", brightest}};
  }

  void add_hours() {
    const SkyHours& hours = room_.hours;
    document_["hours"] = nullptr;
    if (hours.luminances.empty()) return;
    std::vector<std::uint16_t> codes;
    for (const double value : hours.luminances) {
      const double code = value > 0 ? std::round(hour_steps * (std::log2(value) + hour_offset)) : 0;
      codes.push_back(static_cast<std::uint16_t>(std::clamp(code, 0.0, 65535.0)));
    }
    sections_.add_words("hours", codes);
    document_["hours"] = {{"days", hours.days},
                          {"times", hours.times},
                          {"lights", hours.lights},
                          {"steps", hour_steps},
                          {"offset", hour_offset},
                          {"startDay", hours.start_day},
                          {"startTime", hours.start_time},
                          {"year", hours.year},
                          {"weather", hours.weather}};
  }

  /// What the page shows differently from a picture.
  std::vector<std::string> simplified() const {
    std::vector<std::string> list{"matt surfaces show the light of the light maps"};
    const auto some = [&](const auto& accepts) {
      return std::any_of(scene_.materials.begin(), scene_.materials.end(), accepts);
    };
    if (some(
            [](const Material& m) { return m.interaction == Interaction::mirror || m.glossy(); })) {
      list.emplace_back("mirrors and gloss reflect the room as seen from one place");
    }
    if (some([](const Material& m) { return m.interaction == Interaction::glass; })) {
      list.emplace_back(
          "glass is smooth and does not refract the view, but light maps hold what it casts");
    }
    if (std::any_of(scene_.lights.begin(), scene_.lights.end(), [](const Light& light) {
          return light.distribution != none && !light.triangles.empty();
        })) {
      list.emplace_back("lamps have their mean brightness from all sides");
    }
    if (some([](const Material& m) { return m.normal_texture != none; })) {
      list.emplace_back("bumps of normal maps are left out");
    }
    if (some([](const Material& m) { return m.metallic_roughness != none; })) {
      list.emplace_back("gloss and metal do not follow textures");
    }
    return list;
  }

  const PublishedRoom& room_;
  const Scene& scene_;
  json document_;
  Sections sections_;
};

/// JSON that contains nothing which could end a script in HTML.
std::string inline_json(const json& document) {
  std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "\\u003c";
    else
      result += c;
  }
  return result;
}

}  // namespace

const Camera& opening_camera(const Scene& scene) {
  const auto found = std::find_if(
      scene.cameras.begin(), scene.cameras.end(),
      [](const Camera& camera) { return camera.projection == Projection::perspective; });
  return found == scene.cameras.end() ? scene.cameras.front() : *found;
}

void check_materials(const Scene& scene) {
  constexpr std::size_t most = std::numeric_limits<std::uint16_t>::max() + 1;
  if (scene.materials.size() <= most) return;
  throw InputError(fmt::format("{}: {} materials; a page holds at most {}; merge equal ones",
                               scene.source.string(), scene.materials.size(), most));
}

std::string page_text(const PublishedRoom& room) {
  PageWriter writer(room);
  const std::string document = inline_json(writer.document());
  std::map<std::string_view, std::string> parts;
  parts["@TITLE@"] = escaped_xml(room.title);
  parts["@REQUESTS@"] = room.light ? "" : " connect-src 'self';";
  parts["@ROOM@"] = document;
  parts["@DATA@"] = report::base64(writer.bytes());
  std::string page;
  std::string_view rest = page_template();
  while (!rest.empty()) {
    std::size_t next = rest.size();
    std::string_view found;
    for (const auto& [name, text] : parts) {
      const std::size_t place = rest.find(name);
      if (place < next) next = place, found = name;
    }
    page += rest.substr(0, next);
    rest.remove_prefix(next + found.size());
    if (!found.empty()) page += parts[found];
  }
  return page;
}

void write_page(const std::filesystem::path& file, const PublishedRoom& room) {
  write_file(file, page_text(room));
}

}  // namespace photile::publish
