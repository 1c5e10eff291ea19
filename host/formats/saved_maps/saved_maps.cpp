#include "saved_maps/saved_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <type_traits>
#include <vector>

#include "common/content_hash.hpp"
#include "common/files.hpp"
#include "maps/check_photons.hpp"
#include "photile/errors.hpp"
#include "scene/scene_queries.hpp"

namespace photile::saved_maps {

namespace {

constexpr std::array<char, 8> magic{'P', 'H', 'O', 'T', 'M', 'A', 'P', 'S'};
constexpr std::uint32_t version = 5;
constexpr std::uint32_t byte_order = 0x0102'0304;
/// That of a file which holds all photons of its scene: no other is written.
constexpr std::array<std::uint32_t, 2> all_photons{0, 1};

/// A run of arrays. No padding.
struct Part {
  std::uint64_t bytes = 0;
  ContentHash::Digest digest{};
};

/// The head of a file. It lists all that follows, so that a missing part is noticed. No padding.
struct Header {
  std::array<char, 8> magic;
  std::uint32_t version, byte_order;
  ContentHash::Digest scene;
  std::array<std::uint32_t, 2> whole;  ///< `all_photons`
  Part photons, light_maps;            ///< one after the other; light maps may be none
  ContentHash::Digest head;            ///< of all before
};
static_assert(sizeof(Header) == 104 && std::is_trivially_copyable_v<Header>);
static_assert(sizeof(LightMapContents::Coordinates) == 12 && sizeof(LightMapContents::Tile) == 32);

ContentHash::Digest digest_of(const Scene& scene) {
  ContentHash hash;
  scene::add_scene(scene, hash);
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
  visit(photons.oriented_face);
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

Numbers numbers_of(const TracedPhotons& prepared) {
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
void write_photons(const TracedPhotons& prepared, const Settings& settings, const Put& put) {
  write_array(settings.photons, put);
  write_array(prepared.has_groups() ? settings.groups : std::string(), put);
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
  visit(contents.values.by_normal);
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

/// A file being read, which checks how many bytes are left before it takes memory for them.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file) {
    if (const std::string reason = why_no_regular_file(file); !reason.empty()) refuse(reason);
    std::error_code error;
    left_ = std::filesystem::file_size(file, error);
    stream_.open(file, std::ios::binary);
    if (error || !stream_) refuse("the file cannot be read");
  }

  std::uint64_t left() const { return left_; }

  void read(void* bytes, std::uint64_t count) {
    if (count > left_) refuse("the file is truncated; save it again");
    if (!stream_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count))) {
      refuse("the file cannot be read");
    }
    if (hash_) hash_->add_bytes(bytes, count);
    left_ -= count;
  }

  /// From here on, what is read counts for the digest of a part.
  void begin_part() { hash_.emplace(); }
  /// Errors: InputError where the part has another digest.
  void end_part(const Part& part) {
    if (hash_->digest() != part.digest) refuse("the file is damaged; save it again");
    hash_.reset();
  }

  /// An array with its count before it.
  template <class Array>
  void read_array(Array& values) {
    std::uint64_t count = 0;
    read(&count, sizeof count);
    if (count > left_ / sizeof(values[0]))
      refuse("the file is truncated or damaged; save it again");
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
  if (reader.left() < sizeof header) reader.refuse("the file holds no photon maps; give another");
  reader.read(&header, sizeof header);
  if (header.magic != magic) reader.refuse("the file holds no photon maps; give another");
  if (header.byte_order != byte_order) {
    reader.refuse("the file was saved on a machine with another byte order; save it again here");
  }
  if (header.version != version) {
    reader.refuse(
        fmt::format("the file has format version {}, but this photile reads {}; save it again",
                    header.version, version));
  }
  if (header.head != digest_of(header)) reader.refuse("the file is damaged; save it again");
  if (header.whole != all_photons)
    reader.refuse("the file holds only a part of the photons; save all of them");
  const std::uint64_t left = reader.left();
  const bool whole =
      header.photons.bytes <= left && header.light_maps.bytes <= left - header.photons.bytes;
  if (!whole) reader.refuse("the file is truncated; save it again");
  if (header.photons.bytes + header.light_maps.bytes != left) {
    reader.refuse("the file has bytes after its end; save it again");
  }
  return header;
}

LightMapContents read_light_maps(Reader& reader, const Part& part) {
  LightMapContents contents;
  reader.begin_part();
  for_each_light_map_array(contents, [&](auto& values) { reader.read_array(values); });
  reader.end_part(part);
  if (reader.left() > 0) reader.refuse("the file is damaged; save it again");
  return contents;
}

/// The photons' part, with the settings that it was saved with.
struct Contents {
  Settings settings;
  TracedPhotons prepared;
};

Contents read_photons(Reader& reader, const Header& header) {
  Contents contents;
  TracedPhotons& prepared = contents.prepared;
  Numbers numbers{};
  reader.begin_part();
  reader.read_array(contents.settings.photons);
  reader.read_array(contents.settings.groups);
  reader.read(numbers.data(), sizeof numbers);
  if (numbers[3] != 0) prepared.caustics.emplace();
  for_each_array(prepared, [&](auto& values) { reader.read_array(values); });
  reader.end_part(header.photons);
  prepared.radius = numbers[0];
  prepared.groups.radius = numbers[1];
  prepared.groups.angle_degrees = numbers[2];
  if (reader.left() != header.light_maps.bytes) reader.refuse("the file is damaged; save it again");
  if (reader.left() > 0) prepared.light_maps = read_light_maps(reader, header.light_maps);
  return contents;
}

void refuse_other_settings(const Reader& reader, const std::string& saved,
                           const std::string& asked) {
  if (saved == asked) return;
  reader.refuse(
      fmt::format("the file was saved with {}, not with {}; give the same options or save it again",
                  saved, asked));
}

}  // namespace

void save(const std::filesystem::path& file, const Scene& scene, const Settings& settings,
          const TracedPhotons& prepared) {
  Header header{magic, version, byte_order, digest_of(scene), all_photons, {}, {}, {}};
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

TracedPhotons load(const std::filesystem::path& file, const Scene& scene,
                   const Settings& settings) {
  Reader reader(file);
  note_input(file);
  const Header header = read_header(reader);
  Contents contents = read_photons(reader, header);
  if (header.scene != digest_of(scene)) {
    reader.refuse(fmt::format("the file was saved from another scene than {}; save it again",
                              scene.source.string()));
  }
  refuse_other_settings(reader, contents.settings.photons, settings.photons);
  if (contents.prepared.has_groups()) {
    refuse_other_settings(reader, contents.settings.groups, settings.groups);
  }
  const std::string problem = problem_of(contents.prepared, scene);
  if (!problem.empty()) reader.refuse(fmt::format("the file has {}; save it again", problem));
  return std::move(contents.prepared);
}

namespace {

using maps::all_below;
using maps::are_rows;

bool are_patches(const Patches& patches, std::uint64_t oriented_faces) {
  if (patches.empty()) return patches.first_of.empty() && patches.members.empty();
  return patches.map_of.size() == oriented_faces && !patches.first_of.empty() &&
         are_rows(patches.first_of, patches.first_of.size() - 1, patches.members.size()) &&
         all_below(patches.members, oriented_faces) &&
         all_below(patches.map_of, 2 * std::uint64_t{patches.count()});
}

}  // namespace

std::string problem_of(const TracedPhotons& prepared, const Scene& scene) {
  const std::uint64_t oriented_faces = 2 * std::uint64_t{scene.triangle_count()};
  const NeighbourGroups& groups = prepared.groups;
  const std::string problem = maps::problem_of(prepared.photons, needs_of(scene), oriented_faces);
  if (!problem.empty()) return problem;
  if (prepared.photons.emitted_per_light.size() != scene.lights.size()) {
    return "another number of lights";
  }
  if (prepared.caustics) {
    const std::string of_caustics =
        maps::problem_of(*prepared.caustics, needs_of(scene), oriented_faces);
    if (!of_caustics.empty()) return of_caustics;
  }
  if (!prepared.has_groups()) {
    const bool none = groups.offsets.empty() && groups.members.empty() && groups.patches.empty();
    return none && !prepared.light_maps ? "" : "groups without a radius";
  }
  if (!are_patches(groups.patches, oriented_faces)) return "patches that do not fit the scene";
  const std::uint64_t map_count =
      groups.patches.empty() ? oriented_faces : 2 * std::uint64_t{groups.patches.count()};
  if (!are_rows(groups.offsets, oriented_faces, groups.members.size()) ||
      !all_below(groups.members, map_count)) {
    return "groups that do not fit the scene";
  }
  // Naive groups have an infinite radius.
  if (!std::isfinite(prepared.radius) || !(groups.radius >= prepared.radius) ||
      !(groups.angle_degrees >= 0) || !(groups.angle_degrees <= 180)) {
    return "no usable radius or angle";
  }
  return {};
}

}  // namespace photile::saved_maps
