// Relighting, and a picture of light layers whose pixels are made when they are asked for, so that
// a picture of hundreds of lights is never whole in memory.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "photile/camera.hpp"
#include "photile/image.hpp"
#include "photile/light_layers.hpp"
#include "photile/scene.hpp"

namespace photile {

/// The state of one light, or of a group of lights, in a mix.
struct MixedLight {
  std::string name;
  std::vector<std::string> members;  ///< lights of a group; empty for a light alone
  double power = 0;                  ///< in `unit`
  PowerUnit unit = PowerUnit::lumen;
  glm::vec3 color{1.0f};  ///< the light's own colour, as its photons carried it; luminance 1
  /// Multiplies the layer, on top of `color`. Scaled so that luminance(tint * color) = 1: a tinted
  /// light emits `power` as before and keeps its direct illuminance. Its light reflected from
  /// coloured surfaces changes, which a single plane of illuminance cannot represent.
  glm::vec3 tint{1.0f};
};

/// A power in another unit.
double in_unit(double power, PowerUnit from, PowerUnit to, double lumen_per_watt);

struct LightMix {
  std::vector<MixedLight> lights;
  double lumen_per_watt = 683;

  /// The scene's own powers. Luminaires with a photometric file have lumens in every scene, as
  /// their files do.
  static LightMix of(const Scene& scene, double lumen_per_watt);

  /// Of the picture: watts where all lights have watts, else lumens.
  PowerUnit unit() const;
  /// A light's power in the unit of the picture: what its layer is multiplied by.
  double power_in_picture(const MixedLight& light) const {
    return in_unit(light.power, light.unit, unit(), lumen_per_watt);
  }
  double lumens_of(const MixedLight& light) const {
    return in_unit(light.power, light.unit, PowerUnit::lumen, lumen_per_watt);
  }
};

/// A change asked for on the command line: NAME=POWER[lm|W] | NAME=xFACTOR | NAME=#RRGGBB |
/// NAME=KELVINK | NAME=off. POWER is in the light's own unit unless it names one; #RRGGBB is sRGB,
/// of which only the hue and saturation count. Several changes of one light apply in order.
struct LightChange {
  std::string name;
  std::string value;
  /// Splits at the last '=', so that names may hold one. Errors: UsageError when `text` has no '='
  /// or an empty side.
  static LightChange parse(const std::string& text);
};

/// Applies changes. Errors: UsageError for an unknown light (the message lists the lights), a
/// negative or non-finite power, a malformed value, a colour that the light does not emit.
void change_lights(LightMix& mix, const std::vector<LightChange>& changes);

/// Layers x powers, as channels: root R G B A (the sum, alpha 1), `Combined_<light>.R/G/B` and
/// `Illuminance_<light>.Y` in lux, with attribute `photile.lights` (JSON) and units. The root is
/// the float sum of the layers in order. Errors: UsageError when the mix lacks a layer's light.
Image mix_layers(const LightLayers& layers, const LightMix& mix);

/// The root of mix_layers alone, bit for bit, for live relighting: `picture` (width x height,
/// linear RGB) is overwritten with the sum of layers x powers. Work is shared by TBB. Errors:
/// UsageError when the mix lacks a layer's light, or `picture` has another size.
void combine_layers(const LightLayers& layers, const LightMix& mix, std::span<glm::vec3> picture);

/// Changes powers from a picture alone. Reads layers named `Combined_<light>`, Blender's
/// `ViewLayer.Combined_<light>`, Arnold's `RGBA_<light>`; powers from `photile.lights` where the
/// file has it, else every light has power 1 and only factors, colours and "off" are accepted.
/// Returns the channels of `mix_layers`: the root is the sum of the layers, so light that another
/// program left out of every layer is not in it. The root's alpha and the attributes are kept.
/// Errors: InputError when the picture has no light layers, several views of them, or damaged
/// records; UsageError as in `change_lights`; UsageError when a light that is off in the picture,
/// or a colour that it lacks there, is to be turned up.
Image relight(const Image& layered, const std::vector<LightChange>& changes);

/// The layers of a picture at a power of 1, for combine_layers with relit_mix: to change lights as
/// often as a slider moves. A light that is off in the picture, or lacks a colour there, is black.
/// Errors: InputError as `relight`.
LightLayers light_layers(const Image& layered);

/// The lights of a picture after changes, with the refusals of `relight`.
LightMix relit_mix(const PictureHeader& layered, const std::vector<LightChange>& changes);

/// The lights of a picture, as `relight` sees them. Errors: InputError as `relight`, naming the
/// file.
LightMix read_light_mix(const PictureHeader& layered);
LightMix read_light_mix(const std::filesystem::path& file);

/// Rows of one light's layer at the light's power and tint; arrays of rows x width.
struct LightRows {
  std::array<std::vector<float>, 3> rgb;  ///< cd/m2 or W/(m2 sr)
  std::vector<float> illuminance;         ///< lux; empty where it is not known
};

class LayeredPicture {
 public:
  virtual ~LayeredPicture() = default;

  /// Size and attributes. No channels: their names are those of `root` and `channel_names`.
  PictureHeader& header() { return header_; }
  const PictureHeader& header() const { return header_; }

  std::size_t lights() const { return layers_.size(); }
  /// The channels of a light: `Combined_<light>.R/G/B`, and `Illuminance_<light>.Y` where it is
  /// known.
  std::vector<std::string> channel_names(std::size_t light) const;

  /// Rows [first, end) of a light: finite numbers; infinities become the nearest of these, NaN
  /// becomes 0. Reading lights in ascending order is the fastest. Errors: InputError where they
  /// come from a file that is damaged.
  LightRows read(std::size_t light, int first, int end) const;

  /// The root R G B A: the float sum of all lights in order, made finite as these are. Errors: as
  /// `read`.
  Image root() const { return root(0, header_.height); }
  /// Rows [first, end) of the root. A file is decoded only once if they are read before those of
  /// the lights.
  Image root(int first, int end) const;

  /// A line for each light some of whose pixels were not finite, among those that have been read,
  /// or for the root where only the sum was not: which light, how many pixels, and the remedy.
  std::vector<std::string> overflows() const;

 protected:
  /// Reads as `read` and `root` do, with numbers as they are.
  virtual LightRows read_any(std::size_t light, int first, int end) const = 0;
  virtual Image sum_any(int first, int end) const = 0;

  struct Layer {
    std::string light;
    bool illuminance;
  };
  PictureHeader header_;
  std::vector<Layer> layers_;

 private:
  struct Overflow {
    int counted = 0;  ///< rows, from the top
    std::uint64_t pixels = 0;
    void add(int first, int end, std::size_t lost);
  };
  mutable std::map<std::size_t, Overflow> overflows_;  ///< by light
  mutable Overflow lost_sums_;                         ///< of the root
};

/// Layers x powers, as mix_layers gives them. Keeps a reference to the layers. Errors: UsageError
/// when the mix lacks a layer's light.
std::unique_ptr<LayeredPicture> mixed_picture(const LightLayers& layers, const LightMix& mix);

/// A picture file with other powers, as `relight` gives it. A picture of few lights is read at
/// once; of others, only a few rows of all lights are in memory. Errors: InputError; UsageError as
/// in `relight`.
std::unique_ptr<LayeredPicture> relit_picture(const std::filesystem::path& file,
                                              const std::vector<LightChange>& changes);

/// The whole picture: root and all layers.
Image to_image(const LayeredPicture& picture);

/// How layers of lights are kept in a file.
enum class LayerPrecision {
  whole,  ///< every bit
  /// 11 significant bits, as half floats have, with the range of floats: within 0.05% of each
  /// value, and half the size, for the bits that are 0 are packed.
  half,
  /// OpenEXR's lossy DWAA of the whole file, root and illuminance included, for viewing: values end
  /// at 65504. Pictures of several parts have `half`.
  dwaa
};
inline constexpr std::array all_layer_precisions = {LayerPrecision::whole, LayerPrecision::half,
                                                    LayerPrecision::dwaa};
/// "float", "half", "dwaa".
std::string_view name_of(LayerPrecision precision);

/// Writes a scan-line EXR of 32-bit floats: a single part with up to limits::max_single_part_lights
/// lights; with more, a part for the root and one for each light. Row by row, through a temporary
/// name and a rename. Errors: OutputError naming the file; an existing file is kept then. Those of
/// `read`.
///   precision   of the layers; the root is never rounded
void write_exr(const std::filesystem::path& file, const LayeredPicture& picture,
               LayerPrecision precision = LayerPrecision::whole);

/// The view as Radiance's pictures state it ("-vta -vp 0 0 1.2 -vd 0 1 0 -vu 0 0 1 -vh 180 -vv
/// 180"), for a film of width x height pixels. Empty where Radiance has no such view: a whole
/// sphere, or a fisheye whose picture is wider than its hemisphere.
std::string radiance_view(const Camera& camera, int width, int height);

/// Sets the attribute `photile.view`, to the result of radiance_view, and the matrices
/// `worldToCamera` and, of a perspective, `worldToNDC` as OpenEXR's standard attributes define
/// them, for a film of width x height pixels. Row vectors: p' = p M. Camera space is left-handed,
/// +x right, +y up, +z along the view, in metres. NDC, after division by w, is [0,1] x [0,1] over
/// the picture with (0,0) in its upper left corner; its z is 1 / depth and only keeps the matrix
/// invertible.
void set_camera_attributes(PictureHeader& image, const Camera& camera, int width, int height);

}  // namespace photile
