#include "mesh_codecs/codecs.hpp"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <exception>

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

const char* unpack_draco(std::span<const unsigned char> packed,
                         std::vector<DracoAttribute>& attributes, DracoMesh& mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(packed.data()), packed.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return "damaged";
  const draco::Mesh& found = *decoded.value();
  mesh.points = found.num_points();
  for (draco::FaceIndex face(0); face < found.num_faces(); ++face) {
    for (const draco::PointIndex& point : found.face(face)) mesh.corners.push_back(point.value());
  }
  for (DracoAttribute& attribute : attributes) {
    const draco::PointAttribute* values = found.GetAttributeByUniqueId(attribute.id);
    if (values == nullptr) return "without an attribute that the file names";
    if (!append_values_of_type(*values, mesh.points, attribute)) {
      return "of values that do not fit their accessor";
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
    std::span<const unsigned char> packed, std::vector<DracoAttribute>& attributes,
    DracoMesh& mesh) {
  try {
    return unpack_draco(packed, attributes, mesh);
  } catch (const std::exception&) {  // no memory, or an array of no such size
    return "larger than the memory, or damaged";
  }
}
