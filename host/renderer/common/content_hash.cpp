#include "common/content_hash.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <new>

namespace photile {

struct ContentHash::State {
  XXH3_state_t* state = XXH3_createState();
  State() {
    if (state == nullptr) throw std::bad_alloc();
    XXH3_128bits_reset(state);
  }
  ~State() { XXH3_freeState(state); }
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) {}
ContentHash::~ContentHash() = default;

void ContentHash::add_bytes(const void* bytes, std::size_t count) {
  if (count > 0) XXH3_128bits_update(state_->state, bytes, count);
}

ContentHash::Digest ContentHash::digest() const {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(state_->state));
  Digest result;
  static_assert(sizeof canonical.digest == sizeof result);
  std::copy(std::begin(canonical.digest), std::end(canonical.digest), result.begin());
  return result;
}

std::size_t hash_of_bytes(const void* bytes, std::size_t count) {
  return XXH3_64bits(bytes, count);
}

std::string hex(const ContentHash::Digest& digest) {
  std::string digits;
  for (const unsigned char byte : digest) digits += fmt::format("{:02x}", byte);
  return digits;
}

}  // namespace photile
