#include "image/exr_decoder.hpp"

#include "image/exr_input.hpp"

namespace photile::image {
namespace {

/// How many channels of a part are its picture: R, G, B and A where there are such. Depth, normals
/// or lights behind them are none of it.
std::size_t picture_channels(const ExrInput::Part& part) {
  const std::vector<std::string>& names = part.channels;
  if (names.size() < 3 || names[0] != "R" || names[1] != "G" || names[2] != "B")
    return names.size();
  return names.size() > 3 && names[3] == "A" ? 4 : 3;
}

class ExrDecoder : public Decoder {
 public:
  explicit ExrDecoder(Encoded bytes) : input_(bytes) {
    const ExrInput::Part& part = input_.parts().front();
    shape_ = {part.width, part.height, static_cast<int>(picture_channels(part)), Sample::real};
  }

  Pixels decode() override {
    constexpr int rows_at_once = 64;
    const auto channels = static_cast<std::size_t>(shape_.channels),
               width = static_cast<std::size_t>(shape_.width);
    std::vector<float> values(shape_.values()), planes;
    for (int first = 0; first < shape_.height; first += rows_at_once) {
      const int end = std::min(first + rows_at_once, shape_.height);
      input_.read(0, first, end, channels, planes);
      const std::size_t pixels = static_cast<std::size_t>(end - first) * width;
      float* const to = &values[static_cast<std::size_t>(first) * width * channels];
      for (std::size_t c = 0; c < channels; ++c) {
        for (std::size_t i = 0; i < pixels; ++i) to[i * channels + c] = planes[c * pixels + i];
      }
    }
    return values;
  }

 private:
  ExrInput input_;
};

}  // namespace

std::unique_ptr<Decoder> open_exr(Encoded bytes) { return std::make_unique<ExrDecoder>(bytes); }

}  // namespace photile::image
