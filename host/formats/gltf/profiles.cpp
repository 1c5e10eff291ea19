#include "gltf/profiles.hpp"

#include <fmt/format.h>

#include <vector>

#include "files/warnings.hpp"
#include "gltf/document.hpp"
#include "photometry/photometric_file.hpp"

namespace photile::gltf {
namespace {

constexpr const char* ies_extension = "EXT_lights_ies";
constexpr const char* ies_extra = "photile_ies";

/// The content of a data: URI in base64, whatever its media type. tinygltf knows a few types only.
std::vector<unsigned char> data_uri_content(const std::string& uri) {
  const std::size_t comma = uri.find(',');
  std::vector<unsigned char> bytes;
  std::string type;
  if (comma == std::string::npos || uri.substr(0, comma).find(";base64") == std::string::npos ||
      !tinygltf::DecodeDataURI(
          &bytes, type, "data:application/octet-stream;base64" + uri.substr(comma), 0, false)) {
    throw files::ResourceError("a data: URI that is not in base64");
  }
  return bytes;
}

}  // namespace

bool has_profile(const tinygltf::Node& node) {
  return !string_member(node.extras, ies_extra).empty();
}

template <class Read>
std::uint32_t GltfProfiles::find_or_read(const std::string& key, const Read& read) {
  if (const auto found = index_.find(key); found != index_.end()) return found->second;
  const auto index = static_cast<std::uint32_t>(context_.scene.distributions.size());
  context_.scene.distributions.push_back(
      photometry::read_photometry(key, read(), context_.warnings));
  return index_.emplace(key, index).first->second;
}

std::uint32_t GltfProfiles::from_extension(double light, const std::string& node) {
  const tinygltf::Value* extension = find_extension(model_.extensions, ies_extension);
  const tinygltf::Value lights = extension != nullptr && extension->Has("lights")
                                     ? extension->Get("lights")
                                     : tinygltf::Value();
  const std::size_t count = lights.IsArray() ? lights.ArrayLen() : 0;
  if (!(light >= 0.0 && light < static_cast<double>(count))) {
    throw files::ResourceError(
        fmt::format("node '{}': there is no light {} of {}", node, light, ies_extension));
  }
  const tinygltf::Value& profile = lights.Get(static_cast<int>(light));
  const std::string uri = string_member(profile, "uri");
  if (uri.empty()) {
    const std::string key = fmt::format("light {} of {}", light, ies_extension);
    const auto view = integer_member(profile, "bufferView", -1);
    return find_or_read(key, [&] { return accessors_.view(view, key); });
  }
  if (uri.starts_with("data:")) {
    return find_or_read(fmt::format("light {} of {}", light, ies_extension),
                        [&] { return data_uri_content(uri); });
  }
  const std::string file = decoded_uri(uri);
  return find_or_read(file, [&] { return context_.folder.read(file); });
}

std::optional<NodeProfile> GltfProfiles::of(int number) {
  const tinygltf::Node& node = model_.nodes[static_cast<std::size_t>(number)];
  try {
    if (const auto* extension = find_extension(node.extensions, ies_extension)) {
      NodeProfile profile;
      profile.distribution =
          from_extension(number_member(*extension, "light", -1.0), node_name(model_, number));
      profile.multiplier = number_member(*extension, "multiplier", 1.0);
      profile.color = glm::clamp(vector_member(*extension, "color", glm::dvec3(1.0)), 0.0, 1.0);
      profile.colored_by_node = true;
      return profile;
    }
    const std::string file = string_member(node.extras, ies_extra);
    if (file.empty()) return std::nullopt;
    NodeProfile profile;
    profile.distribution = find_or_read(file, [&] { return context_.folder.read(file); });
    return profile;
  } catch (const files::ResourceError& error) {
    throw context_.error(error.what());
  }
}

}  // namespace photile::gltf
