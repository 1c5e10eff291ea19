#include <webp/decode.h>

#include "image/formats/formats.hpp"

namespace photile::image {
namespace {

class WebpDecoder : public Decoder {
 public:
  explicit WebpDecoder(Encoded bytes) : bytes_(bytes) {
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) {
      throw DecodeError("the header is damaged");
    }
    if (features.has_animation != 0) throw DecodeError("an animation; give a still picture");
    shape_ = {features.width, features.height, features.has_alpha != 0 ? 4 : 3, Sample::byte};
  }

  Pixels decode() override {
    std::vector<std::uint8_t> values(shape_.values());
    const auto into = shape_.channels == 4 ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
    if (into(bytes_.data(), bytes_.size(), values.data(), values.size(),
             shape_.width * shape_.channels) == nullptr) {
      throw DecodeError("the pixels are damaged");
    }
    return values;
  }

 private:
  Encoded bytes_;
};

}  // namespace

std::unique_ptr<Decoder> open_webp(Encoded bytes) { return std::make_unique<WebpDecoder>(bytes); }

}  // namespace photile::image
