// A glTF file, parsed and with its buffers read, before any of it is interpreted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// Parses a .gltf or .glb file and reads its buffers from the scene's folder. Pictures inside the
/// file stay encoded in tinygltf::Image::image. Extensions that photile does not understand are
/// named in a warning. Errors: InputError when the file is malformed, refers outside its folder or
/// requires an extension that photile does not understand.
tinygltf::Model read_gltf(reading::ImportContext& context);

/// Errors: InputError naming the first of the extensions that a file requires which photile does
/// not understand, with the remedy. To be asked before the file is parsed: what such an extension
/// leaves out of it (buffers without data, ...) makes it malformed.
void check_required_extensions(const std::vector<std::string>& required,
                               const reading::ImportContext& context);

/// Names every extension that the file uses and photile does not understand in a warning.
void warn_of_extensions(const tinygltf::Model& model, reading::ImportContext& context);

// Compressed meshes: EXT_meshopt_compression and KHR_draco_mesh_compression.

/// The JSON of a file with compressed meshes, without what a reader that does not support them
/// would refuse: buffers that stand for what meshopt has packed, and have no bytes, and indices
/// that only Draco's data has. "" where nothing has to be changed.
std::string without_packed_parts(std::string_view json);

/// Unpacks compressed data into separate buffers, so that the model is read as any other. Errors:
/// InputError that names a view or mesh which is damaged; UsageError where photile was built
/// without the decoders.
void unpack_meshes(tinygltf::Model& model, const reading::ImportContext& context);

/// Bytes of the buffers of the file: not of those that unpack_meshes has added.
std::uint64_t packed_bytes(const tinygltf::Model& model);

/// A member of a JSON object: a number, or `fallback` when it is absent or no number.
double number_member(const tinygltf::Value& object, const std::string& key, double fallback);

/// A member of a JSON object: a number as the nearest int towards zero, or `fallback` when it is
/// absent or no number. Numbers are clamped to the range of an int: the largest int is no valid
/// index of a file.
int integer_member(const tinygltf::Value& object, const std::string& key, int fallback);

/// A member of a JSON object: up to three numbers; missing ones keep those of `fallback`.
glm::dvec3 vector_member(const tinygltf::Value& object, const std::string& key,
                         const glm::dvec3& fallback);

/// A member of a JSON object: a string, or "" when it is absent or no string.
std::string string_member(const tinygltf::Value& object, const std::string& key);

/// An extension's JSON object, or nullptr when `extensions` lacks it.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions,
                                      const std::string& name);

/// The element of this number in a file; null where there is none.
template <class T>
const T* element(const std::vector<T>& all, int number) {
  const bool there = number >= 0 && static_cast<std::size_t>(number) < all.size();
  return there ? &all[static_cast<std::size_t>(number)] : nullptr;
}

/// A light that an extension defines for the file; null where there is none of that number.
const tinygltf::Value* light_of_extension(const tinygltf::Model& model,
                                          const std::string& extension, double number);

/// Three numbers of a factor such as emissiveFactor; `fallback` where absent.
glm::dvec3 rgb_of(const std::vector<double>& values, const glm::dvec3& fallback);

/// A URI with its percent escapes replaced by the bytes they stand for.
std::string decoded_uri(const std::string& uri);

/// Reads the text once, as a stream: whatever its content, this takes memory in proportion to its
/// depth only. tinygltf would build all of it, recursively, and read numbers that are out of their
/// range as others. Returns what it names in extensionsRequired. Errors: InputError where it is no
/// JSON, is nested deeper than limits::max_json_depth, has more nodes or materials than the limits,
/// or where a number, count or offset of the format is no whole number of its range.
std::vector<std::string> check_json(std::string_view json, const reading::ImportContext& context);

}  // namespace photile::gltf
