// Reading glTF accessors with every bound checked in 64 bits before the first byte is read.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

class AccessorReader {
 public:
  AccessorReader(const tinygltf::Model& model, const reading::ImportContext& context)
      : model_(model), context_(context) {}

  /// All elements of an accessor as floats, `components` for each; normalised integers become
  /// [0,1] or [-1,1]. `use` names the accessor in errors ("POSITION of mesh 'x'").
  /// Errors: InputError when the accessor is of another type or leaves its buffer.
  std::vector<float> floats(int accessor, int components, const std::string& use) const;

  /// All elements of an index accessor. Errors: InputError as above.
  std::vector<std::uint32_t> indices(int accessor, const std::string& use) const;

  /// Number of elements, without reading them. Errors: InputError when there is no such accessor.
  std::uint64_t count(int accessor, const std::string& use) const;

  /// Whether any element is given; all others are 0. Errors: as count.
  bool has_data(int accessor, const std::string& use) const;

  /// The bytes of a buffer view. Errors: InputError when it leaves its buffer.
  std::span<const unsigned char> view(int buffer_view, const std::string& use) const;

 private:
  /// Elements at a fixed distance in a buffer view.
  struct Elements {
    const unsigned char* first;
    std::size_t stride;
  };

  const tinygltf::Accessor& at(int accessor, const std::string& use) const;
  Elements elements(int buffer_view, std::uint64_t offset, std::uint64_t count,
                    std::uint64_t element_size, const std::string& use) const;
  /// Errors: InputError where an accessor without data has too many elements.
  void check_implicit_count(const tinygltf::Accessor& accessor, const std::string& use) const;

  /// Takes the number of an element and the bytes that replace it.
  using SparseVisit = std::function<void(std::uint64_t, const unsigned char*)>;
  void for_each_sparse(const tinygltf::Accessor& accessor, std::uint64_t element_size,
                       const std::string& use, const SparseVisit& visit) const;

  const tinygltf::Model& model_;
  const reading::ImportContext& context_;
};

}  // namespace photile::gltf
