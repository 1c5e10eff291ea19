// A hash of many values: XXH3, 128 bits.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace photile {

/// Values count with their bytes in this machine's order, texts and arrays with their lengths, so
/// that ("ab", "c") and ("a", "bc") differ.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();

  void add_bytes(const void* bytes, std::size_t count);

  /// A value without padding: numbers, vectors of them.
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    add_bytes(&value, sizeof value);
  }
  void add(const std::string& text) {
    add(std::uint64_t{text.size()});
    add_bytes(text.data(), text.size());
  }
  template <class T>
  void add(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    add(std::uint64_t{values.size()});
    add_bytes(values.data(), values.size() * sizeof(T));
  }

  using Digest = std::array<unsigned char, 16>;  ///< canonical: big-endian
  Digest digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// XXH3, 64 bits.
std::size_t hash_of_bytes(const void* bytes, std::size_t count);

/// Of keys of tables: values without padding, by their bytes.
struct BytesHash {
  template <class T>
  std::size_t operator()(const T& value) const {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    return hash_of_bytes(&value, sizeof value);
  }
};

/// 32 digits.
std::string hex(const ContentHash::Digest& digest);

}  // namespace photile
