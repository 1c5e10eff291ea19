#include "saved_maps/saved_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <type_traits>
#include <vector>

#include "common/content_hash.hpp"
#include "common/output_file.hpp"
#include "common/regular_file.hpp"
#include "common/run_files.hpp"
#include "photile/errors.hpp"
#include "saved_maps/check_photons.hpp"
#include "scene/scene_hash.hpp"

namespace photile::saved_maps {
namespace {

constexpr std::array<char, 8> magic{'P', 'H', 'O', 'T', 'M', 'A', 'P', 'S'};
constexpr std::uint32_t version = 2;
constexpr std::uint32_t byte_order = 0x0102'0304;

/// The head of a file. No padding.
struct Header {
  std::array<char, 8> magic;
  std::uint32_t version, byte_order;
  ContentHash::Digest scene;
  std::uint64_t payload_bytes;
  ContentHash::Digest payload;  ///< of all before and of the payload
};
static_assert(sizeof(Header) == 56 && std::is_trivially_copyable_v<Header>);

/// What stands before light maps, which follow the photons. No padding.
struct LightMapHeader {
  std::array<char, 8> magic;
  std::uint64_t payload_bytes;
  ContentHash::Digest payload;  ///< of the photons' digest and the payload
};
static_assert(sizeof(LightMapHeader) == 32 && std::is_trivially_copyable_v<LightMapHeader>);
constexpr std::array<char, 8> light_map_magic{'P', 'H', 'O', 'T', 'N', 'O', 'D', 'E'};
static_assert(sizeof(LightMapContents::Place) == 12 && sizeof(LightMapContents::Tile) == 32);

ContentHash::Digest digest_of(const Scene& scene) {
  ContentHash hash;
  add_scene(scene, hash);
  return hash.digest();
}

/// Calls `visit` with every array of the payload, in the order of the file.
template <class Prepared, class Visit>
void for_each_array(Prepared& prepared, const Visit& visit) {
  auto& photons = prepared.photons;
  visit(photons.position);
  visit(photons.flux);
  visit(photons.incoming);
  visit(photons.light);
  visit(photons.sided_triangle);
  visit(photons.first_of);
  visit(photons.emitted_per_light);
  auto& groups = prepared.groups;
  visit(groups.offsets);
  visit(groups.members);
  visit(groups.patches.map_of);
  visit(groups.patches.first_of);
  visit(groups.patches.members);
}

using Numbers = std::array<double, 3>;

Numbers numbers_of(const PreparedPhotons& prepared) {
  return {prepared.radius, prepared.groups.radius, prepared.groups.angle_degrees};
}

/// Calls `put` with all bytes of the payload, in runs.
template <class Put>
void write_payload(const PreparedPhotons& prepared, const std::string& settings, const Put& put) {
  const auto array = [&](const auto& values) {
    const std::uint64_t count = values.size();
    put(&count, sizeof count);
    put(values.data(), count * sizeof(values[0]));
  };
  array(settings);
  const Numbers numbers = numbers_of(prepared);
  put(numbers.data(), sizeof numbers);
  for_each_array(prepared, array);
}

/// Calls `visit` with every array of light maps, in the order of the file.
template <class Contents, class Visit>
void for_each_light_map_array(Contents& contents, const Visit& visit) {
  visit(contents.settings);
  visit(contents.nodes);
  visit(contents.values.irradiance);
  visit(contents.values.first);
  visit(contents.values.light);
  visit(contents.tiles);
}

/// The digest that a header holds.
class Checksum {
 public:
  explicit Checksum(const Header& header) { hash_.add_bytes(&header, offsetof(Header, payload)); }
  explicit Checksum(const ContentHash::Digest& photons) {
    hash_.add_bytes(&photons, sizeof photons);
  }
  void add(const void* bytes, std::uint64_t count) { hash_.add_bytes(bytes, count); }
  ContentHash::Digest digest() const { return hash_.digest(); }

 private:
  ContentHash hash_;
};

/// A file being read: knows how many bytes are left before it takes memory for them.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file) {
    if (const std::string reason = why_no_regular_file(file); !reason.empty()) refuse(reason);
    std::error_code error;
    note_input(file);
    left_ = std::filesystem::file_size(file, error);
    stream_.open(file, std::ios::binary);
    if (error || !stream_) refuse("cannot be read");
  }

  std::uint64_t left() const { return left_; }

  void read(void* bytes, std::uint64_t count) {
    if (count > left_) refuse("is truncated; save it again");
    if (!stream_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count))) {
      refuse("cannot be read");
    }
    left_ -= count;
  }

  /// An array with its count before it.
  template <class Array>
  void read_array(Array& values, Checksum& checksum) {
    std::uint64_t count = 0;
    read(&count, sizeof count);
    if (count > left_ / sizeof(values[0])) refuse("is truncated or damaged; save it again");
    values.resize(count);
    read(values.data(), count * sizeof(values[0]));
    checksum.add(&count, sizeof count);
    checksum.add(values.data(), count * sizeof(values[0]));
  }

  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError(fmt::format("{}: {}", file_.string(), reason));
  }

 private:
  const std::filesystem::path& file_;
  std::ifstream stream_;
  std::uint64_t left_ = 0;
};

Header read_header(Reader& reader) {
  Header header{};
  if (reader.left() < sizeof header) reader.refuse("holds no photon maps");
  reader.read(&header, sizeof header);
  if (header.magic != magic) reader.refuse("holds no photon maps");
  if (header.byte_order != byte_order) {
    reader.refuse("was saved on a machine of another byte order; save it again here");
  }
  if (header.version != version) {
    reader.refuse(fmt::format("has version {} of the format, this photile reads {}; save it again",
                              header.version, version));
  }
  if (header.payload_bytes > reader.left()) reader.refuse("is truncated; save it again");
  return header;
}

LightMapContents read_light_maps(Reader& reader, const Header& photons) {
  LightMapHeader header{};
  if (reader.left() < sizeof header) reader.refuse("has bytes after its end; save it again");
  reader.read(&header, sizeof header);
  if (header.magic != light_map_magic) reader.refuse("has bytes after its end; save it again");
  if (header.payload_bytes != reader.left()) {
    reader.refuse("is truncated or damaged; save it again");
  }
  Checksum checksum(photons.payload);
  LightMapContents contents;
  for_each_light_map_array(contents, [&](auto& values) { reader.read_array(values, checksum); });
  if (reader.left() > 0 || checksum.digest() != header.payload) {
    reader.refuse("is damaged; save it again");
  }
  return contents;
}

}  // namespace

void save(const std::filesystem::path& file, const Scene& scene, const std::string& settings,
          const PreparedPhotons& prepared) {
  Header header{magic, version, byte_order, digest_of(scene), 0, {}};
  write_payload(prepared, settings,
                [&](const void*, std::uint64_t count) { header.payload_bytes += count; });
  Checksum checksum(header);
  write_payload(prepared, settings,
                [&](const void* bytes, std::uint64_t count) { checksum.add(bytes, count); });
  header.payload = checksum.digest();

  OutputFile output(file);
  output.write(&header, sizeof header);
  write_payload(prepared, settings,
                [&](const void* bytes, std::uint64_t count) { output.write(bytes, count); });
  output.commit();  // reports short writes, too
}

void add_light_maps(const std::filesystem::path& file, const LightMapContents& contents) {
  Reader reader(file);
  const Header header = read_header(reader);
  LightMapHeader own{light_map_magic, 0, {}};
  Checksum checksum(header.payload);
  const auto write_payload = [&](const auto& put) {
    for_each_light_map_array(contents, [&](const auto& values) {
      const std::uint64_t count = values.size();
      put(&count, sizeof count);
      put(values.data(), count * sizeof(values[0]));
    });
  };
  write_payload([&](const void* bytes, std::uint64_t count) {
    own.payload_bytes += count;
    checksum.add(bytes, count);
  });
  own.payload = checksum.digest();

  OutputFile output(file);
  output.write(&header, sizeof header);
  std::vector<char> copied(std::size_t{1} << 20);
  for (std::uint64_t left = header.payload_bytes; left > 0;) {
    const std::uint64_t count = std::min<std::uint64_t>(left, copied.size());
    reader.read(copied.data(), count);
    output.write(copied.data(), count);
    left -= count;
  }
  output.write(&own, sizeof own);
  write_payload([&](const void* bytes, std::uint64_t count) { output.write(bytes, count); });
  output.commit();
}

PreparedPhotons load(const std::filesystem::path& file, const Scene& scene,
                     const std::string& settings) {
  Reader reader(file);
  const Header header = read_header(reader);
  const std::uint64_t after_photons = reader.left() - header.payload_bytes;
  Checksum checksum(header);
  PreparedPhotons prepared;
  std::string saved_settings;
  Numbers numbers{};
  reader.read_array(saved_settings, checksum);
  reader.read(numbers.data(), sizeof numbers);
  checksum.add(numbers.data(), sizeof numbers);
  for_each_array(prepared, [&](auto& values) { reader.read_array(values, checksum); });
  if (reader.left() != after_photons || checksum.digest() != header.payload) {
    reader.refuse("is damaged; save it again");
  }
  if (reader.left() > 0) prepared.light_maps = read_light_maps(reader, header);
  if (header.scene != digest_of(scene)) {
    reader.refuse(
        fmt::format("was saved from another scene than {}; save it again", scene.source.string()));
  }
  if (saved_settings != settings) {
    reader.refuse(
        fmt::format("was saved with {}, not with {}; give the same options or save it again",
                    saved_settings, settings));
  }
  prepared.radius = numbers[0];
  prepared.groups.radius = numbers[1];
  prepared.groups.angle_degrees = numbers[2];
  const std::string problem = problem_of(prepared, scene);
  if (!problem.empty()) reader.refuse(fmt::format("has {}; save it again", problem));
  return prepared;
}

}  // namespace photile::saved_maps
