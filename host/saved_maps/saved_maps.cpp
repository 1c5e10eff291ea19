#include "saved_maps/saved_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <type_traits>
#include <vector>

#include "common/content_hash.hpp"
#include "common/input_file.hpp"
#include "common/output_file.hpp"
#include "common/run_files.hpp"
#include "photile/errors.hpp"
#include "saved_maps/check_photons.hpp"
#include "scene/scene_hash.hpp"

namespace photile::saved_maps {
namespace {

constexpr std::array<char, 8> magic{'P', 'H', 'O', 'T', 'M', 'A', 'P', 'S'};
constexpr std::uint32_t version = 3;
constexpr std::uint32_t byte_order = 0x0102'0304;

/// A run of arrays. No padding.
struct Part {
  std::uint64_t bytes = 0;
  ContentHash::Digest digest{};
};

/// The head of a file. It knows of all that follows, so that no part can be cut off unseen. No
/// padding.
struct Header {
  std::array<char, 8> magic;
  std::uint32_t version, byte_order;
  ContentHash::Digest scene;
  Part photons, light_maps;  ///< one after the other; light maps may be none
  ContentHash::Digest head;  ///< of all before
};
static_assert(sizeof(Header) == 96 && std::is_trivially_copyable_v<Header>);
static_assert(sizeof(LightMapContents::Place) == 12 && sizeof(LightMapContents::Tile) == 32);

ContentHash::Digest digest_of(const Scene& scene) {
  ContentHash hash;
  add_scene(scene, hash);
  return hash.digest();
}

ContentHash::Digest digest_of(const Header& header) {
  ContentHash hash;
  hash.add_bytes(&header, offsetof(Header, head));
  return hash.digest();
}

/// Calls `visit` with every array of photons.
template <class Photons, class Visit>
void for_each_array_of_photons(Photons& photons, const Visit& visit) {
  visit(photons.position);
  visit(photons.flux);
  visit(photons.incoming);
  visit(photons.light);
  visit(photons.sided_triangle);
  visit(photons.first_of);
  visit(photons.emitted_per_light);
}

/// Calls `visit` with every array of the photons' part, in the order of the file.
template <class Prepared, class Visit>
void for_each_array(Prepared& prepared, const Visit& visit) {
  for_each_array_of_photons(prepared.photons, visit);
  auto& groups = prepared.groups;
  visit(groups.offsets);
  visit(groups.members);
  visit(groups.patches.map_of);
  visit(groups.patches.first_of);
  visit(groups.patches.members);
  if (prepared.caustics) for_each_array_of_photons(*prepared.caustics, visit);
}

/// Radius of the maps, radius and angle of the groups, and whether caustics are there.
using Numbers = std::array<double, 4>;

Numbers numbers_of(const PreparedPhotons& prepared) {
  return {prepared.radius, prepared.groups.radius, prepared.groups.angle_degrees,
          prepared.caustics ? 1.0 : 0.0};
}

/// Calls `put` with the bytes of an array, its number of elements before it.
template <class Put, class Array>
void write_array(const Array& values, const Put& put) {
  const std::uint64_t count = values.size();
  put(&count, sizeof count);
  put(values.data(), count * sizeof(values[0]));
}

/// Calls `put` with all bytes of the photons' part, in runs.
template <class Put>
void write_photons(const PreparedPhotons& prepared, const std::string& settings, const Put& put) {
  write_array(settings, put);
  const Numbers numbers = numbers_of(prepared);
  put(numbers.data(), sizeof numbers);
  for_each_array(prepared, [&](const auto& values) { write_array(values, put); });
}

/// Calls `visit` with every array of light maps, in the order of the file.
template <class Contents, class Visit>
void for_each_light_map_array(Contents& contents, const Visit& visit) {
  visit(contents.settings);
  visit(contents.nodes);
  visit(contents.values.irradiance);
  visit(contents.values.first);
  visit(contents.values.light);
  visit(contents.error);
  visit(contents.distance);
  visit(contents.tiles);
}

/// The part that `write(put)` writes.
template <class Write>
Part part_of(const Write& write) {
  Part part;
  ContentHash hash;
  write([&](const void* bytes, std::uint64_t count) {
    part.bytes += count;
    hash.add_bytes(bytes, count);
  });
  part.digest = hash.digest();
  return part;
}

/// A file being read: knows how many bytes are left before it takes memory for them.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file) {
    if (const std::string reason = why_no_regular_file(file); !reason.empty()) refuse(reason);
    std::error_code error;
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
    if (hash_) hash_->add_bytes(bytes, count);
    left_ -= count;
  }

  /// From here on, what is read counts for the digest of a part.
  void begin_part() { hash_.emplace(); }
  /// Errors: InputError where the part has another digest.
  void end_part(const Part& part) {
    if (hash_->digest() != part.digest) refuse("is damaged; save it again");
    hash_.reset();
  }

  /// An array with its count before it.
  template <class Array>
  void read_array(Array& values) {
    std::uint64_t count = 0;
    read(&count, sizeof count);
    if (count > left_ / sizeof(values[0])) refuse("is truncated or damaged; save it again");
    values.resize(count);
    read(values.data(), count * sizeof(values[0]));
  }

  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputError(fmt::format("{}: {}", file_.string(), reason));
  }

 private:
  const std::filesystem::path& file_;
  std::ifstream stream_;
  std::uint64_t left_ = 0;
  std::optional<ContentHash> hash_;
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
  if (header.head != digest_of(header)) reader.refuse("is damaged; save it again");
  const std::uint64_t left = reader.left();
  const bool whole =
      header.photons.bytes <= left && header.light_maps.bytes <= left - header.photons.bytes;
  if (!whole) reader.refuse("is truncated; save it again");
  if (header.photons.bytes + header.light_maps.bytes != left) {
    reader.refuse("has bytes after its end; save it again");
  }
  return header;
}

LightMapContents read_light_maps(Reader& reader, const Part& part) {
  LightMapContents contents;
  reader.begin_part();
  for_each_light_map_array(contents, [&](auto& values) { reader.read_array(values); });
  reader.end_part(part);
  if (reader.left() > 0) reader.refuse("is damaged; save it again");
  return contents;
}

}  // namespace

void save(const std::filesystem::path& file, const Scene& scene, const std::string& settings,
          const PreparedPhotons& prepared) {
  Header header{magic, version, byte_order, digest_of(scene), {}, {}, {}};
  header.photons = part_of([&](const auto& put) { write_photons(prepared, settings, put); });
  header.head = digest_of(header);
  OutputFile output(file);
  output.write(&header, sizeof header);
  write_photons(prepared, settings,
                [&](const void* bytes, std::uint64_t count) { output.write(bytes, count); });
  output.commit();  // reports short writes, too
}

void add_light_maps(const std::filesystem::path& file, const LightMapContents& contents) {
  Reader reader(file);
  Header header = read_header(reader);
  const auto write_light_maps = [&](const auto& put) {
    for_each_light_map_array(contents, [&](const auto& values) { write_array(values, put); });
  };
  header.light_maps = part_of(write_light_maps);
  header.head = digest_of(header);
  OutputFile output(file);
  output.write(&header, sizeof header);
  std::vector<char> copied(std::size_t{1} << 20);
  for (std::uint64_t left = header.photons.bytes; left > 0;) {
    const std::uint64_t count = std::min<std::uint64_t>(left, copied.size());
    reader.read(copied.data(), count);
    output.write(copied.data(), count);
    left -= count;
  }
  write_light_maps([&](const void* bytes, std::uint64_t count) { output.write(bytes, count); });
  output.commit();
}

PreparedPhotons load(const std::filesystem::path& file, const Scene& scene,
                     const std::string& settings) {
  Reader reader(file);
  note_input(file);
  const Header header = read_header(reader);
  PreparedPhotons prepared;
  std::string saved_settings;
  Numbers numbers{};
  reader.begin_part();
  reader.read_array(saved_settings);
  reader.read(numbers.data(), sizeof numbers);
  if (numbers[3] != 0) prepared.caustics.emplace();
  for_each_array(prepared, [&](auto& values) { reader.read_array(values); });
  reader.end_part(header.photons);
  if (reader.left() != header.light_maps.bytes) reader.refuse("is damaged; save it again");
  if (reader.left() > 0) prepared.light_maps = read_light_maps(reader, header.light_maps);
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
