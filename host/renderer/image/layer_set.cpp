#include "image/layer_set.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "photile/errors.hpp"

namespace photile::image {
namespace {

constexpr std::size_t absent = static_cast<std::size_t>(-1);

/// A channel's name, taken apart from the right as Blender does: view layer, pass, channel.
struct ChannelName {
  std::string view, pass, channel;

  explicit ChannelName(const std::string& name) {
    const std::size_t last = name.rfind('.');
    if (last == std::string::npos) {
      channel = name;
      return;
    }
    channel = name.substr(last + 1);
    const std::size_t before = name.rfind('.', last == 0 ? 0 : last - 1);
    const bool has_view = before != std::string::npos && before < last;
    view = has_view ? name.substr(0, before) : std::string();
    const std::size_t start = has_view ? before + 1 : 0;
    pass = name.substr(start, last - start);
  }
};

/// The light of a pass that starts with a prefix, or "".
std::string light_after(std::string_view prefix, const std::string& pass) {
  return pass.starts_with(prefix) ? pass.substr(prefix.size()) : std::string();
}

struct FoundLayer {
  std::string light, view;
  std::array<std::size_t, 3> rgb{absent, absent, absent};
};

/// Layers in the order in which their first channel stands in the picture.
class Finder {
 public:
  explicit Finder(const PictureHeader& image) {
    for (std::size_t i = 0; i < image.channel_names.size(); ++i) {
      const ChannelName name(image.channel_names[i]);
      const std::size_t component = std::string_view("RGB").find(name.channel);
      if (const std::string lit = light_after("Illuminance_", name.pass); !lit.empty()) {
        if (name.channel == "Y") illuminance_.emplace(lit, i);
        continue;
      }
      std::string light = light_after("Combined_", name.pass);
      if (light.empty()) light = light_after("RGBA_", name.pass);
      if (light.empty() || name.channel.size() != 1 || component == std::string_view::npos)
        continue;
      layer_of(light, name.view).rgb[component] = i;
    }
  }

  const std::vector<FoundLayer>& layers() const { return layers_; }

  LayerChannels channels_of(const FoundLayer& layer) const {
    const auto found = illuminance_.find(layer.light);
    return {layer.rgb, found == illuminance_.end() ? std::nullopt : std::optional(found->second)};
  }

 private:
  FoundLayer& layer_of(const std::string& light, const std::string& view) {
    if (!layers_.empty() && layers_.front().view != view) {
      throw InputError(fmt::format(
          "the picture holds light layers of several views ('{}' and '{}'); keep one of them",
          layers_.front().view, view));
    }
    const auto [found, is_new] = position_.try_emplace(light, layers_.size());
    if (is_new) layers_.push_back({light, view});
    return layers_[found->second];
  }

  std::vector<FoundLayer> layers_;
  std::map<std::string, std::size_t> position_;
  std::map<std::string, std::size_t> illuminance_;
};

}  // namespace

LayerSet find_layers(const PictureHeader& image) {
  const Finder finder(image);
  if (finder.layers().empty()) {
    throw InputError(
        "the picture has no light layers (channels such as Combined_lamp.R); render it with "
        "photile, or with light groups in Blender or Arnold");
  }
  std::map<std::string, const FoundLayer*> unplaced;
  for (const FoundLayer& layer : finder.layers()) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (layer.rgb[i] == absent) {
        throw InputError(
            fmt::format("the layer of light '{}' lacks its channel {}; write R, G and B",
                        layer.light, "RGB"[i]));
      }
    }
    unplaced.emplace(layer.light, &layer);
  }

  LightRecords recorded = read_light_records(image);
  LayerSet set;
  set.records.mix.lumen_per_watt = recorded.mix.lumen_per_watt;
  for (MixedLight& light : recorded.mix.lights) {
    const auto found = unplaced.find(light.name);
    if (found == unplaced.end()) continue;  // its layer was taken out of the file
    set.channels.push_back(finder.channels_of(*found->second));
    if (recorded.relative.contains(light.name)) set.records.relative.insert(light.name);
    set.records.mix.lights.push_back(std::move(light));
    unplaced.erase(found);
  }
  for (const FoundLayer& layer : finder.layers()) {
    if (!unplaced.contains(layer.light)) continue;
    MixedLight light;
    light.name = layer.light;
    light.power = 1.0;
    set.channels.push_back(finder.channels_of(layer));
    set.records.relative.insert(light.name);
    set.records.mix.lights.push_back(std::move(light));
  }
  return set;
}

}  // namespace photile::image
