#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "common/module.hpp"
#include "gltf/document.hpp"
#include "gltf/meshes.hpp"
#include "mesh_codecs/codecs.hpp"
#include "photile/limits.hpp"

namespace photile::gltf {
namespace {

constexpr const char* meshopt = "EXT_meshopt_compression";
constexpr const char* draco = "KHR_draco_mesh_compression";
constexpr const char* unpacked_buffer = "unpacked by photile";

/// The bound on the packing of a view: 16 bytes of a vertex take two bits at least, and three
/// indices of four bytes one byte.
constexpr std::uint64_t most_packed = 100;
/// All packed meshes of a file unpack to so many bytes more, which are not worth a check.
constexpr std::uint64_t unchecked_bytes = 64ull << 20;

template <class Function>
Function* codec(const char* name) {
  static const Module& module = *new Module("photile_mesh_codecs.so");
  Function* const found = module.find<Function>(name);
  if (found == nullptr) {
    throw UsageError(fmt::format(
        "compressed meshes cannot be read: {}; install the package photile-openimageio, or export "
        "without compression",
        module.error()));
  }
  return found;
}

/// The bytes [offset, offset + length) of a buffer. Errors: InputError.
std::span<const unsigned char> bytes_of(const tinygltf::Model& model, int buffer,
                                        std::uint64_t offset, std::uint64_t length,
                                        const std::string& use,
                                        const reading::ImportContext& context) {
  if (const tinygltf::Buffer* const found = element(model.buffers, buffer)) {
    const std::vector<unsigned char>& data = found->data;
    if (offset <= data.size() && length <= data.size() - offset) {
      return std::span(data).subspan(offset, length);
    }
  }
  throw context.error(use + " lies outside its buffer; export the file again");
}

/// A member that counts bytes or elements, 0 where it is not there. Errors: InputError.
std::uint64_t size_member(const tinygltf::Value& object, const std::string& key,
                          const std::string& use, const reading::ImportContext& context) {
  const double value = number_member(object, key, 0);
  if (value >= 0 && value <= 0x1p53) return static_cast<std::uint64_t>(value);
  throw context.error(fmt::format("{}: {} is {}; export the file again", use, key, value));
}

template <class Value, std::size_t count>
Value value_named(const std::array<std::pair<std::string_view, Value>, count>& values,
                  const std::string& name, const std::string& use,
                  const reading::ImportContext& context) {
  const auto found =
      std::ranges::find(values, std::string_view(name), &std::pair<std::string_view, Value>::first);
  if (found != values.end()) return found->second;
  throw context.error(fmt::format(
      "{}: '{}' is not a known mode or filter of the compression; export the file again", use,
      name));
}

/// The number of a new buffer with these bytes.
int add_buffer(tinygltf::Model& model, std::vector<unsigned char> bytes) {
  tinygltf::Buffer& buffer = model.buffers.emplace_back();
  buffer.name = unpacked_buffer;
  buffer.data = std::move(bytes);
  return static_cast<int>(model.buffers.size()) - 1;
}

/// Packed bytes that several views or primitives name are unpacked once.
class Unpacking {
 public:
  Unpacking(tinygltf::Model& model, const reading::ImportContext& context)
      : model_(model),
        context_(context),
        most_(std::min(limits::max_external_bytes,
                       unchecked_bytes + most_packed * packed_bytes(model))) {}

  void unpack_view(std::size_t number) {
    const tinygltf::Value* const packing =
        find_extension(model_.bufferViews[number].extensions, meshopt);
    if (packing == nullptr) return;
    context_.progress.throw_if_cancelled();
    const std::string use = fmt::format("bufferViews[{}]", number);
    const auto size = [&](const char* key) { return size_member(*packing, key, use, context_); };
    using Mode = std::pair<std::string_view, MeshoptMode>;
    using Filter = std::pair<std::string_view, MeshoptFilter>;
    constexpr std::array modes{Mode{"ATTRIBUTES", MeshoptMode::attributes},
                               Mode{"TRIANGLES", MeshoptMode::triangles},
                               Mode{"INDICES", MeshoptMode::indices}};
    constexpr std::array filters{Filter{"", MeshoptFilter::none},
                                 Filter{"NONE", MeshoptFilter::none},
                                 Filter{"OCTAHEDRAL", MeshoptFilter::octahedral},
                                 Filter{"QUATERNION", MeshoptFilter::quaternion},
                                 Filter{"EXPONENTIAL", MeshoptFilter::exponential}};
    const MeshoptView view{value_named(modes, string_member(*packing, "mode"), use, context_),
                           value_named(filters, string_member(*packing, "filter"), use, context_),
                           size("count"), size("byteStride"),
                           bytes_of(model_, integer_member(*packing, "buffer", -1),
                                    size("byteOffset"), size("byteLength"), use, context_)};
    check_view(view, use);
    const auto [known, is_new] = views_.try_emplace(
        {view.packed.data(), view.packed.size(), view.mode, view.filter, view.count, view.stride});
    if (is_new) {
      std::vector<unsigned char> bytes(take(view.count * view.stride, use));
      if (!codec<decltype(photile_unpack_meshopt)>("photile_unpack_meshopt")(view, bytes.data())) {
        throw context_.error(use + ": its meshopt data is damaged; export the file again");
      }
      known->second = add_buffer(model_, std::move(bytes));
    }
    tinygltf::BufferView& unpacked = model_.bufferViews[number];
    unpacked.byteLength = view.count * view.stride;
    unpacked.byteOffset = 0;
    unpacked.buffer = known->second;
  }

  void unpack_primitive(tinygltf::Primitive& primitive, const std::string& use) {
    const tinygltf::Value* const packing = find_extension(primitive.extensions, draco);
    if (packing == nullptr) return;
    // The same mesh uncompressed, for readers without Draco.
    const tinygltf::Accessor* const positions = accessor_of(primitive, "POSITION");
    if (positions != nullptr && positions->bufferView >= 0) return;
    context_.progress.throw_if_cancelled();
    const int packed = integer_member(*packing, "bufferView", -1);
    std::vector<std::string> names;
    std::vector<DracoAttribute> attributes;
    const tinygltf::Value ids =
        packing->Has("attributes") ? packing->Get("attributes") : tinygltf::Value();
    for (const std::string& name : ids.IsObject() ? ids.Keys() : std::vector<std::string>()) {
      const tinygltf::Accessor* const accessor = accessor_of(primitive, name);
      const int id = integer_member(ids, name, -1);
      if (accessor == nullptr || id < 0) continue;
      names.push_back(name);
      attributes.push_back(
          {static_cast<std::uint32_t>(id), accessor->componentType,
           std::clamp(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor->type)),
                      1, 16)});
    }
    const tinygltf::BufferView* const view = element(model_.bufferViews, packed);
    if (view == nullptr) {
      throw context_.error(use + ": its Draco data has no buffer view; export the file again");
    }
    std::vector<std::uint32_t> requested;
    for (const DracoAttribute& one : attributes) requested.push_back(one.id);
    const auto [known, is_new] =
        primitives_.try_emplace({packed, primitive.attributes, std::move(requested)});
    if (!is_new) {
      std::tie(primitive.attributes, primitive.indices, primitive.mode) = known->second;
      return;
    }
    DracoMesh mesh;
    const std::string problem = codec<decltype(photile_unpack_draco)>("photile_unpack_draco")(
        bytes_of(model_, view->buffer, view->byteOffset, view->byteLength, use, context_),
        most_ - taken_, attributes, mesh);
    if (!problem.empty()) {
      throw context_.error(
          fmt::format("{}: its Draco data is {}; export the file again", use, problem));
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      tinygltf::Accessor accessor = *accessor_of(primitive, names[i]);
      if (accessor.count != mesh.points) {
        throw context_.error(fmt::format(
            "{}: its Draco data has {} points, and the accessor {}; export the file again", use,
            mesh.points, accessor.count));
      }
      primitive.attributes[names[i]] =
          add_accessor(std::move(accessor), std::move(attributes[i].values), use);
    }
    tinygltf::Accessor corners;
    corners.type = TINYGLTF_TYPE_SCALAR;
    corners.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    corners.count = mesh.corners.size();
    const std::span<const unsigned char> bytes(
        reinterpret_cast<const unsigned char*>(mesh.corners.data()),
        mesh.corners.size() * sizeof(std::uint32_t));
    primitive.indices = add_accessor(std::move(corners), {bytes.begin(), bytes.end()}, use);
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    known->second = {primitive.attributes, primitive.indices, primitive.mode};
  }

 private:
  void check_view(const MeshoptView& view, const std::string& use) const {
    const bool indices = view.mode != MeshoptMode::attributes;
    const bool sound = indices ? view.stride == 2 || view.stride == 4
                               : view.stride > 0 && view.stride <= 256 && view.stride % 4 == 0;
    const bool whole = view.mode != MeshoptMode::triangles || view.count % 3 == 0;
    const bool fits = view.filter == MeshoptFilter::octahedral
                          ? view.stride == 4 || view.stride == 8
                          : view.filter != MeshoptFilter::quaternion || view.stride == 8;
    if (sound && whole && (fits || indices) &&
        view.count <= most_packed * view.packed.size() / view.stride) {
      return;
    }
    throw context_.error(fmt::format(
        "{}: {} elements of {} bytes cannot come from {} packed bytes; export the file again", use,
        view.count, view.stride, view.packed.size()));
  }

  /// Counts the bytes that files unpack to. Errors: InputError.
  std::uint64_t take(std::uint64_t bytes, const std::string& use) {
    taken_ += bytes;
    if (taken_ <= most_) return bytes;
    throw context_.error(
        fmt::format("{}: the unpacked meshes exceed {} MiB, the limit for a file with this many "
                    "packed bytes; split the scene",
                    use, most_ >> 20));
  }

  const tinygltf::Accessor* accessor_of(const tinygltf::Primitive& primitive,
                                        const std::string& name) const {
    return element(model_.accessors, attribute(primitive, name));
  }

  int add_accessor(tinygltf::Accessor accessor, std::vector<unsigned char> values,
                   const std::string& use) {
    tinygltf::BufferView view;
    view.byteLength = take(values.size(), use);
    view.buffer = add_buffer(model_, std::move(values));
    model_.bufferViews.push_back(std::move(view));
    accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
    accessor.byteOffset = 0;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  tinygltf::Model& model_;
  const reading::ImportContext& context_;
  std::uint64_t taken_ = 0, most_;
  std::map<std::tuple<const unsigned char*, std::size_t, MeshoptMode, MeshoptFilter, std::size_t,
                      std::size_t>,
           int>
      views_;  ///< buffers
  std::map<std::tuple<int, std::map<std::string, int>, std::vector<std::uint32_t>>,
           std::tuple<std::map<std::string, int>, int, int>>
      primitives_;  ///< attributes, indices and mode
};

/// Views of what has elements or pixels.
std::set<int> used_views(const tinygltf::Model& model) {
  std::set<int> views;
  for (const tinygltf::Image& image : model.images) views.insert(image.bufferView);
  for (const tinygltf::Accessor& accessor : model.accessors) {
    views.insert(accessor.bufferView);
    if (!accessor.sparse.isSparse) continue;
    views.insert(accessor.sparse.indices.bufferView);
    views.insert(accessor.sparse.values.bufferView);
  }
  return views;
}

/// A member of a member of an object; null where it is missing.
const nlohmann::json* member(const nlohmann::json& object,
                             std::initializer_list<const char*> names) {
  const nlohmann::json* found = &object;
  for (const char* const name : names) {
    if (!found->is_object() || !found->contains(name)) return nullptr;
    found = &(*found)[name];
  }
  return found;
}

/// A member that is a list, or a list of nothing.
nlohmann::json& elements(nlohmann::json& object, const char* name) {
  static thread_local nlohmann::json nothing = nlohmann::json::array();
  const nlohmann::json* const list = member(object, {name});
  return list != nullptr && list->is_array() ? object[name] : nothing;
}

}  // namespace

std::string without_packed_parts(std::string_view json) {
  if (json.find(meshopt) == std::string_view::npos && json.find(draco) == std::string_view::npos) {
    return {};
  }
  nlohmann::json document = nlohmann::json::parse(json, nullptr, false);
  if (!document.is_object()) return {};
  bool changed = false;
  for (nlohmann::json& buffer : elements(document, "buffers")) {
    const nlohmann::json* const extension = member(buffer, {"extensions", meshopt});
    if (extension == nullptr || !extension->is_object()) continue;
    if (extension->value("fallback", nlohmann::json()) != true) continue;
    buffer["uri"] = "data:application/octet-stream;base64,AAAA";
    buffer["byteLength"] = 3;
    changed = true;
  }
  for (nlohmann::json& mesh : elements(document, "meshes")) {
    for (nlohmann::json& primitive : elements(mesh, "primitives")) {
      if (member(primitive, {"extensions", draco}) == nullptr) continue;
      const nlohmann::json* const position = member(primitive, {"attributes", "POSITION"});
      nlohmann::json& accessors = elements(document, "accessors");
      const bool whole = position != nullptr && position->is_number_unsigned() &&
                         position->get<std::size_t>() < accessors.size() &&
                         member(accessors[position->get<std::size_t>()], {"bufferView"}) != nullptr;
      if (whole) continue;
      primitive.erase("indices");
      changed = true;
    }
  }
  return changed ? document.dump() : std::string();
}

std::uint64_t packed_bytes(const tinygltf::Model& model) {
  std::uint64_t bytes = 0;
  for (const tinygltf::Buffer& buffer : model.buffers) {
    if (buffer.name != unpacked_buffer) bytes += buffer.data.size();
  }
  return bytes;
}

void unpack_meshes(tinygltf::Model& model, const reading::ImportContext& context) {
  Unpacking unpacking(model, context);
  for (const int view : used_views(model)) {
    if (element(model.bufferViews, view)) unpacking.unpack_view(static_cast<std::size_t>(view));
  }
  std::set<std::size_t> placed;
  for (const tinygltf::Node& node : model.nodes) placed.insert(static_cast<std::size_t>(node.mesh));
  for (std::size_t mesh = 0; mesh < model.meshes.size(); ++mesh) {
    if (!placed.contains(mesh)) continue;
    for (tinygltf::Primitive& primitive : model.meshes[mesh].primitives) {
      unpacking.unpack_primitive(
          primitive, fmt::format("mesh '{}'", name_of_mesh(model, static_cast<int>(mesh))));
    }
  }
}

}  // namespace photile::gltf
