#include "mesh_codecs/codecs.hpp"

#include <draco/compression/decode.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <meshoptimizer.h>

#include <exception>
#include <type_traits>

namespace photile::gltf {
namespace {

/// Appends the values of all points as components of one type.
template <class T>
bool append_values(const draco::PointAttribute& attribute, std::size_t points,
                   DracoAttribute& asked) {
  std::vector<T> value(static_cast<std::size_t>(asked.components));
  asked.values.resize(points * value.size() * sizeof(T));
  for (std::size_t i = 0; i < points; ++i) {
    const auto index = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
    const auto count = static_cast<std::int8_t>(asked.components);
    if (!attribute.ConvertValue<T>(index, count, value.data())) return false;
    std::copy_n(reinterpret_cast<const unsigned char*>(value.data()), value.size() * sizeof(T),
                asked.values.data() + i * value.size() * sizeof(T));
  }
  return true;
}

bool append_values_of_type(const draco::PointAttribute& attribute, std::size_t points,
                           DracoAttribute& asked) {
  switch (asked.component_type) {
    case 5120:
      return append_values<std::int8_t>(attribute, points, asked);
    case 5121:
      return append_values<std::uint8_t>(attribute, points, asked);
    case 5122:
      return append_values<std::int16_t>(attribute, points, asked);
    case 5123:
      return append_values<std::uint16_t>(attribute, points, asked);
    case 5125:
      return append_values<std::uint32_t>(attribute, points, asked);
    case 5126:
      return append_values<float>(attribute, points, asked);
    default:
      return false;
  }
}

constexpr const char* too_large = "larger than the limit for the packed meshes of this file";

/// A decoder of Draco's that knows the sizes of what it is to decode and refuses too much of it.
template <class Decoder>
class BoundedDecoder : public Decoder {
 public:
  explicit BoundedDecoder(std::uint64_t most) : most_(most) {}
  bool refused() const { return refused_; }

 protected:
  bool DecodeConnectivity() override {
    constexpr bool edges = std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>;
    // What a face or a point takes while it is decoded, and more of a face for each attribute.
    constexpr std::uint64_t bytes = 32, bytes_of_attribute = 16;
    if (this->bitstream_version() < DRACO_BITSTREAM_VERSION(2, 2)) return false;
    draco::DecoderBuffer ahead = *this->buffer();
    std::uint32_t first = 0, second = 0;  // of faces and points, or points and faces
    std::uint8_t attributes = 0;
    if (!draco::DecodeVarint(&first, &ahead) || !draco::DecodeVarint(&second, &ahead)) return false;
    if (edges && !ahead.Decode(&attributes)) return false;
    return is_allowed(bytes * (std::uint64_t{first} + second) +
                      bytes_of_attribute * attributes * second) &&
           Decoder::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    std::uint64_t bytes = 0;
    const draco::PointCloud& cloud = *this->point_cloud();
    for (int i = 0; i < cloud.num_attributes(); ++i) {
      bytes += static_cast<std::uint64_t>(cloud.attribute(i)->byte_stride());
    }
    return is_allowed(bytes * cloud.num_points()) && Decoder::DecodeAllAttributes();
  }

 private:
  bool is_allowed(std::uint64_t bytes) {
    refused_ = bytes > most_;
    return !refused_;
  }

  std::uint64_t most_;
  bool refused_ = false;
};

/// "", or what is wrong.
template <class Decoder>
const char* decode(std::uint64_t most, draco::DecoderBuffer& buffer, draco::Mesh& mesh) {
  BoundedDecoder<Decoder> decoder(most);
  const draco::DecoderOptions options;
  if (decoder.Decode(options, &buffer, &mesh).ok()) return "";
  return decoder.refused() ? too_large : "damaged, or of a version older than glTF allows";
}

const char* unpack_draco(std::span<const unsigned char> packed, std::uint64_t most,
                         std::vector<DracoAttribute>& attributes, DracoMesh& mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(packed.data()), packed.size());
  draco::DecoderBuffer ahead = buffer;
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) return "damaged";
  draco::Mesh found;
  const char* const problem = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
                                  ? decode<draco::MeshEdgebreakerDecoder>(most, buffer, found)
                                  : decode<draco::MeshSequentialDecoder>(most, buffer, found);
  if (*problem != '\0') return problem;
  mesh.points = found.num_points();
  for (draco::FaceIndex face(0); face < found.num_faces(); ++face) {
    for (const draco::PointIndex& point : found.face(face)) mesh.corners.push_back(point.value());
  }
  for (DracoAttribute& attribute : attributes) {
    const draco::PointAttribute* values = found.GetAttributeByUniqueId(attribute.id);
    if (values == nullptr) return "missing an attribute that the file names";
    if (!append_values_of_type(*values, mesh.points, attribute)) {
      return "inconsistent with its accessor";
    }
  }
  return "";
}

}  // namespace
}  // namespace photile::gltf

using namespace photile::gltf;

[[gnu::visibility("default")]] bool photile_unpack_meshopt(const MeshoptView& view,
                                                           unsigned char* unpacked) {
  const auto& [mode, filter, count, stride, packed] = view;
  using Unpack = int (*)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
  const Unpack unpack = mode == MeshoptMode::triangles ? Unpack{meshopt_decodeIndexBuffer}
                        : mode == MeshoptMode::indices ? Unpack{meshopt_decodeIndexSequence}
                                                       : Unpack{meshopt_decodeVertexBuffer};
  if (unpack(unpacked, count, stride, packed.data(), packed.size()) != 0) return false;
  if (filter == MeshoptFilter::octahedral) meshopt_decodeFilterOct(unpacked, count, stride);
  if (filter == MeshoptFilter::quaternion) meshopt_decodeFilterQuat(unpacked, count, stride);
  if (filter == MeshoptFilter::exponential) meshopt_decodeFilterExp(unpacked, count, stride);
  return true;
}

[[gnu::visibility("default")]] const char* photile_unpack_draco(
    std::span<const unsigned char> packed, std::uint64_t most,
    std::vector<DracoAttribute>& attributes, DracoMesh& mesh) {
  try {
    return unpack_draco(packed, most, attributes, mesh);
  } catch (const std::exception&) {  // no memory, or an array of no such size
    return "larger than the available memory, or damaged";
  }
}
