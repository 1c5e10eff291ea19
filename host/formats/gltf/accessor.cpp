#include "gltf/accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "gltf/document.hpp"
#include "photile/limits.hpp"

namespace photile::gltf {
namespace {

template <typename T>
T load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);  // accessors need not be aligned
  return value;
}

/// Bytes of a component that vertex data or indices may have; 0 for any other.
std::uint64_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

/// One component; normalised integers by the formulas of the glTF 2.0 specification, section 3.11.
float component(const unsigned char* bytes, int type, bool normalized) {
  const auto integer = [&](auto value, float largest) {
    return normalized ? std::max(static_cast<float>(value) / largest, -1.0f)
                      : static_cast<float>(value);
  };
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return integer(load<std::int8_t>(bytes), 127.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return integer(load<std::uint8_t>(bytes), 255.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return integer(load<std::int16_t>(bytes), 32'767.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return integer(load<std::uint16_t>(bytes), 65'535.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return static_cast<float>(load<std::uint32_t>(bytes));
    default:
      return load<float>(bytes);
  }
}

/// An unsigned index; the largest one for a component type that no index may have.
std::uint32_t index(const unsigned char* bytes, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(bytes);
    default:
      return load<std::uint32_t>(bytes);
  }
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

}  // namespace

const tinygltf::Accessor& AccessorReader::at(int accessor, const std::string& use) const {
  if (const tinygltf::Accessor* const found = element(model_.accessors, accessor)) return *found;
  throw context_.error(
      fmt::format("{}: there is no accessor {}; export the file again", use, accessor));
}

std::uint64_t AccessorReader::count(int accessor, const std::string& use) const {
  return at(accessor, use).count;
}

bool AccessorReader::has_data(int accessor, const std::string& use) const {
  const tinygltf::Accessor& source = at(accessor, use);
  return source.bufferView >= 0 || (source.sparse.isSparse && source.sparse.count > 0);
}

std::span<const unsigned char> AccessorReader::view(int buffer_view, const std::string& use) const {
  const tinygltf::BufferView* const view = element(model_.bufferViews, buffer_view);
  if (view == nullptr) {
    throw context_.error(
        fmt::format("{}: there is no buffer view {}; export the file again", use, buffer_view));
  }
  const tinygltf::Buffer* const buffer = element(model_.buffers, view->buffer);
  if (buffer == nullptr) {
    throw context_.error(
        fmt::format("{}: there is no buffer {}; export the file again", use, view->buffer));
  }
  const auto& data = buffer->data;
  if (view->byteOffset > data.size() || view->byteLength > data.size() - view->byteOffset) {
    throw context_.error(
        fmt::format("{}: buffer view {} ends beyond its buffer of {} bytes; export the file again",
                    use, buffer_view, data.size()));
  }
  return {data.data() + view->byteOffset, view->byteLength};
}

AccessorReader::Elements AccessorReader::elements(int buffer_view, std::uint64_t offset,
                                                  std::uint64_t count, std::uint64_t element_size,
                                                  const std::string& use) const {
  const std::span<const unsigned char> bytes = view(buffer_view, use);
  const std::uint64_t stated = model_.bufferViews[static_cast<std::size_t>(buffer_view)].byteStride;
  const std::uint64_t stride = stated == 0 ? element_size : stated;
  const bool starts_inside = offset <= bytes.size();
  const std::uint64_t available = starts_inside ? bytes.size() - offset : 0;
  // Dividing instead of multiplying: count * stride may not fit 64 bits.
  if (!starts_inside || available < element_size ||
      count - 1 > (available - element_size) / stride) {
    throw context_.error(
        fmt::format("{}: {} elements end beyond buffer view {} of {} bytes; export the file again",
                    use, count, buffer_view, bytes.size()));
  }
  return {bytes.data() + offset, stride};
}

std::vector<float> AccessorReader::floats(int accessor_index, int components,
                                          const std::string& use) const {
  const tinygltf::Accessor& accessor = at(accessor_index, use);
  const std::uint64_t size = component_size(accessor.componentType);
  // tinygltf numbers vector types by their component count.
  const int type = components == 1 ? TINYGLTF_TYPE_SCALAR : components;
  if (accessor.type != type || size == 0) {
    throw context_.error(
        fmt::format("{}: accessor {} is of the wrong type (not {} numbers of at most 32 bits); "
                    "export the file again",
                    use, accessor_index, components));
  }
  const auto width = static_cast<std::size_t>(components);
  std::vector<float> values;
  if (accessor.count == 0) return values;
  if (accessor.bufferView >= 0) {
    const Elements source =
        elements(accessor.bufferView, accessor.byteOffset, accessor.count, size * width, use);
    values.reserve(accessor.count * width);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      for (std::size_t c = 0; c < width; ++c) {
        values.push_back(component(source.first + i * source.stride + c * size,
                                   accessor.componentType, accessor.normalized));
      }
    }
  } else {
    check_implicit_count(accessor, use);
    values.assign(accessor.count * width, 0.0f);
  }
  for_each_sparse(
      accessor, size * width, use, [&](std::uint64_t target, const unsigned char* replacement) {
        for (std::size_t c = 0; c < width; ++c) {
          values[target * width + c] =
              component(replacement + c * size, accessor.componentType, accessor.normalized);
        }
      });
  return values;
}

void AccessorReader::check_implicit_count(const tinygltf::Accessor& accessor,
                                          const std::string& use) const {
  if (accessor.count > limits::max_implicit_elements) {
    throw context_.error(
        fmt::format("{}: the accessor has {} elements without data; the limit is {}", use,
                    accessor.count, limits::max_implicit_elements));
  }
}

void AccessorReader::for_each_sparse(const tinygltf::Accessor& accessor, std::uint64_t element_size,
                                     const std::string& use, const SparseVisit& visit) const {
  const auto& sparse = accessor.sparse;
  if (!sparse.isSparse) return;
  if (sparse.count < 1 || static_cast<std::uint64_t>(sparse.count) > accessor.count ||
      sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0 ||
      !is_index_type(sparse.indices.componentType)) {
    throw context_.error(use + ": malformed sparse accessor; export the file again");
  }
  const auto count = static_cast<std::uint64_t>(sparse.count);
  const Elements indices =
      elements(sparse.indices.bufferView, static_cast<std::uint64_t>(sparse.indices.byteOffset),
               count, component_size(sparse.indices.componentType), use);
  const Elements replacements =
      elements(sparse.values.bufferView, static_cast<std::uint64_t>(sparse.values.byteOffset),
               count, element_size, use);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t target =
        index(indices.first + i * indices.stride, sparse.indices.componentType);
    if (target >= accessor.count) {
      throw context_.error(
          fmt::format("{}: sparse index {} is out of range of {} elements; export the file again",
                      use, target, accessor.count));
    }
    visit(target, replacements.first + i * replacements.stride);
  }
}

std::vector<std::uint32_t> AccessorReader::indices(int accessor_index,
                                                   const std::string& use) const {
  const tinygltf::Accessor& accessor = at(accessor_index, use);
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor.componentType)) {
    throw context_.error(
        fmt::format("{}: accessor {} does not hold unsigned integers; export the file again", use,
                    accessor_index));
  }
  std::vector<std::uint32_t> result;
  if (accessor.count == 0) return result;
  const std::uint64_t size = component_size(accessor.componentType);
  if (accessor.bufferView < 0 && accessor.sparse.isSparse) {
    check_implicit_count(accessor, use);
    result.assign(accessor.count, 0);
  } else {
    const Elements source =
        elements(accessor.bufferView, accessor.byteOffset, accessor.count, size, use);
    result.reserve(accessor.count);
    for (std::size_t i = 0; i < accessor.count; ++i) {
      result.push_back(index(source.first + i * source.stride, accessor.componentType));
    }
  }
  for_each_sparse(accessor, size, use, [&](std::uint64_t target, const unsigned char* replacement) {
    result[target] = index(replacement, accessor.componentType);
  });
  return result;
}

}  // namespace photile::gltf
