// Portable any-maps: the manual pages pbm(5), pgm(5) and ppm(5) of Netpbm.
#include "image/formats/formats.hpp"

namespace photile::image {
namespace {

class PnmDecoder : public Decoder {
 public:
  explicit PnmDecoder(Encoded bytes) : rest_(bytes) {
    const bool magic = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6';
    if (!magic) throw DecodeError("the header is damaged, or of a kind that is not read");
    const int kind = bytes[1] - '0';
    text_ = kind <= 3;
    bits_ = kind == 1 || kind == 4;
    rest_ = rest_.subspan(2);
    shape_.width = number(1 << 30);
    shape_.height = number(1 << 30);
    if (!bits_) largest_ = number(65535);
    if (shape_.width < 1 || shape_.height < 1 || largest_ < 1) {
      throw DecodeError("the size is damaged");
    }
    shape_.channels = kind == 3 || kind == 6 ? 3 : 1;
    shape_.sample = largest_ > 255 ? Sample::word : Sample::byte;
    if (!text_) byte();  // the one white space behind the header
  }

  Pixels decode() override {
    if (shape_.values() > std::uint64_t{rest_.size()} * 8) {  // a bit a value is the least
      throw DecodeError("the file ends too early");
    }
    if (shape_.sample == Sample::word) return values<std::uint16_t>(65535);
    return values<std::uint8_t>(255);
  }

 private:
  std::uint8_t byte() {
    if (rest_.empty()) throw DecodeError("the file ends too early");
    const std::uint8_t value = rest_.front();
    rest_ = rest_.subspan(1);
    return value;
  }

  /// The next byte that is neither white space nor in a comment.
  std::uint8_t letter() {
    for (;;) {
      std::uint8_t value = byte();
      while (value == '#') {
        while (byte() != '\n') {
        }
        value = byte();
      }
      if (value != ' ' && (value < '\t' || value > '\r')) return value;
    }
  }

  /// Leaves the byte behind it.
  int number(int most) {
    std::uint8_t digit = letter();
    std::int64_t value = 0;
    for (;;) {
      if (digit < '0' || digit > '9') throw DecodeError("a number is damaged");
      value = 10 * value + (digit - '0');
      if (value > most) throw DecodeError("a number is too large");
      if (rest_.empty() || rest_.front() < '0' || rest_.front() > '9')
        return static_cast<int>(value);
      digit = byte();
    }
  }

  template <class T>
  std::vector<T> values(int white) {
    std::vector<T> result;
    result.reserve(shape_.values());
    const int row = shape_.width * shape_.channels;
    for (int y = 0; y < shape_.height; ++y) {
      for (int i = 0; i < row; ++i) result.push_back(static_cast<T>(value(i, white)));
    }
    return result;
  }

  /// The i-th value of a row, so that `white` is the largest.
  int value(int i, int white) {
    if (bits_) return bit(i) ? 0 : white;  // ink is 1
    int value = text_ ? number(65535) : byte();
    if (!text_ && largest_ > 255) value = 256 * value + byte();
    if (value > largest_) throw DecodeError("a value is larger than the header says");
    return static_cast<int>((std::int64_t{value} * white + largest_ / 2) / largest_);
  }

  bool bit(int i) {
    if (text_) return letter() == '1';
    if (i % 8 == 0) eight_ = byte();
    return ((eight_ >> (7 - i % 8)) & 1) != 0;
  }

  Encoded rest_;
  bool text_ = false, bits_ = false;
  int largest_ = 1;
  std::uint8_t eight_ = 0;
};

}  // namespace

std::unique_ptr<Decoder> open_pnm(Encoded bytes) { return std::make_unique<PnmDecoder>(bytes); }

}  // namespace photile::image
