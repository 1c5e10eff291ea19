// Meshes that Draco or meshopt packed, beside the same meshes as they were.
#ifdef PHOTILE_HAS_MESH_CODECS

#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "scene_files.hpp"

namespace photile::test {
namespace {

using Catch::Contains;
using nlohmann::json;

constexpr std::uint32_t sheet_cells = 12;

/// A wavy sheet of 1 m x 1 m, which shines.
struct Sheet {
  std::vector<float> positions, normals;
  std::vector<std::uint32_t> indices;

  Sheet() {
    for (std::uint32_t y = 0; y <= sheet_cells; ++y) {
      for (std::uint32_t x = 0; x <= sheet_cells; ++x) {
        const float u = static_cast<float>(x) / sheet_cells,
                    v = static_cast<float>(y) / sheet_cells;
        positions.insert(positions.end(), {u, v, 0.1f * std::sin(6 * u)});
        const float slope = -0.6f * std::cos(6 * u), length = std::hypot(slope, 1.0f);
        normals.insert(normals.end(), {slope / length, 0, 1 / length});
      }
    }
    for (std::uint32_t y = 0; y < sheet_cells; ++y) {
      for (std::uint32_t x = 0; x < sheet_cells; ++x) {
        const std::uint32_t a = y * (sheet_cells + 1) + x, b = a + 1, c = a + sheet_cells + 1,
                            d = c + 1;
        indices.insert(indices.end(), {a, b, d, a, d, c});
      }
    }
  }
  std::size_t points() const { return positions.size() / 3; }
};

/// The document of a sheet whose buffer holds positions, normals and indices, in this order.
json document_of(const Sheet& sheet) {
  json document = square_document();
  const std::size_t attribute = sheet.positions.size() * sizeof(float);
  const std::size_t corners = sheet.indices.size() * sizeof(std::uint32_t);
  document["buffers"] = {{{"uri", "sheet.bin"}, {"byteLength", 2 * attribute + corners}}};
  document["bufferViews"] = {
      {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", attribute}, {"byteStride", 12}},
      {{"buffer", 0}, {"byteOffset", attribute}, {"byteLength", attribute}, {"byteStride", 12}},
      {{"buffer", 0}, {"byteOffset", 2 * attribute}, {"byteLength", corners}}};
  document["accessors"] = {
      {{"bufferView", 0}, {"componentType", 5126}, {"count", sheet.points()}, {"type", "VEC3"}},
      {{"bufferView", 1}, {"componentType", 5126}, {"count", sheet.points()}, {"type", "VEC3"}},
      {{"bufferView", 2},
       {"componentType", 5125},
       {"count", sheet.indices.size()},
       {"type", "SCALAR"}}};
  document["meshes"][0]["primitives"][0] = {
      {"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}, {"indices", 2}, {"material", 0}};
  return document;
}

Scene load(const json& document, const std::string& buffer) {
  return load_gltf(document, {}, {{"sheet.bin", buffer}});
}

Scene as_it_is(const Sheet& sheet) {
  return load(document_of(sheet),
              bytes_of(sheet.positions) + bytes_of(sheet.normals) + bytes_of(sheet.indices));
}

std::string packed_vertices(const void* values, std::size_t count, std::size_t stride) {
  std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
  packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()),
                                           packed.size(), values, count, stride));
  return packed;
}

std::string packed_triangles(const Sheet& sheet) {
  std::string packed(meshopt_encodeIndexBufferBound(sheet.indices.size(), sheet.points()), '\0');
  packed.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(packed.data()),
                                          packed.size(), sheet.indices.data(),
                                          sheet.indices.size()));
  return packed;
}

/// The document with its views packed, and the buffer that meshopt's exporters leave empty.
struct PackedSheet {
  json document;
  std::string buffer;

  PackedSheet(const Sheet& sheet, const std::vector<std::string>& views)
      : document(document_of(sheet)) {
    document["extensionsUsed"] = document["extensionsRequired"] = {"EXT_meshopt_compression"};
    const std::size_t whole = document["buffers"][0]["byteLength"];
    document["buffers"].push_back(
        {{"byteLength", whole},
         {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    for (std::size_t i = 0; i < views.size(); ++i) {
      json& view = document["bufferViews"][i];
      const bool corners = i + 1 == views.size();
      view["buffer"] = 1;
      view["extensions"]["EXT_meshopt_compression"] = {
          {"buffer", 0},
          {"byteOffset", buffer.size()},
          {"byteLength", views[i].size()},
          {"byteStride", corners ? 4 : 12},
          {"count", corners ? sheet.indices.size() : sheet.points()},
          {"mode", corners ? "TRIANGLES" : "ATTRIBUTES"}};
      buffer += views[i];
    }
    document["buffers"][0]["byteLength"] = buffer.size();
  }
  json& packing(std::size_t view) {
    return document["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
  }
};

PackedSheet packed(const Sheet& sheet) {
  return {sheet,
          {packed_vertices(sheet.positions.data(), sheet.points(), 12),
           packed_vertices(sheet.normals.data(), sheet.points(), 12), packed_triangles(sheet)}};
}

/// What is said of a scene that is refused.
std::string refusal(const json& document, const std::string& buffer) {
  return input_error_of([&] { load(document, buffer); });
}

TEST_CASE("what meshopt packed without a filter is the mesh bit by bit") {
  const Sheet sheet;
  const Scene expected = as_it_is(sheet);
  REQUIRE(expected.triangle_count() == 2 * sheet_cells * sheet_cells);
  PackedSheet from = packed(sheet);
  // Nobody needs the buffer for readers without meshopt, so its file may be left behind.
  if (GENERATE(false, true)) from.document["buffers"][1]["uri"] = "nowhere.bin";
  CHECK(from.buffer.size() < 0.7 * from.document["buffers"][1]["byteLength"].get<double>());
  const Scene scene = load(from.document, from.buffer);
  CHECK(scene.report.warnings.empty());
  CHECK(scene.vertices == expected.vertices);
  CHECK(scene.triangles == expected.triangles);
  CHECK(scene.corner_normal == expected.corner_normal);
}

TEST_CASE("positions that meshopt packed by exponents are right to their bits") {
  const Sheet sheet;
  std::vector<std::uint32_t> exponents(sheet.positions.size());
  meshopt_encodeFilterExp(exponents.data(), sheet.points(), 12, 18, sheet.positions.data());
  PackedSheet from(
      sheet, {packed_vertices(exponents.data(), sheet.points(), 12),
              packed_vertices(sheet.normals.data(), sheet.points(), 12), packed_triangles(sheet)});
  from.packing(0)["filter"] = "EXPONENTIAL";
  const Scene scene = load(from.document, from.buffer);
  CHECK(scene.triangle_count() == 2 * sheet_cells * sheet_cells);
  CHECK(total_area(scene) == Approx(total_area(as_it_is(sheet))).epsilon(1e-4));
}

TEST_CASE("damaged or boundless meshopt data is refused by the view's name") {
  const Sheet sheet;
  const std::size_t whole = packed(sheet).buffer.size();
  for (const auto& [view, member, value, told] :
       std::vector<std::tuple<std::size_t, const char*, json, const char*>>{
           {2, "byteLength", 20, "bufferViews[2]"},
           {0, "byteOffset", whole, "bufferViews[0] lies outside its buffer"},
           {1, "count", 1'000'000'000, "bufferViews[1]: 1000000000 elements"},
           {0, "byteStride", 7, "7 bytes"},
           {0, "mode", "SPHERES", "SPHERES"}}) {
    PackedSheet from = packed(sheet);
    from.packing(view)[member] = value;
    CHECK_THAT(refusal(from.document, from.buffer), Contains(told));
  }
  PackedSheet changed = packed(sheet);
  changed.buffer[0] = 'x';
  CHECK_THAT(refusal(changed.document, changed.buffer), Contains("is damaged"));
}

TEST_CASE("packed bytes that many views name are unpacked once, and unused ones never") {
  constexpr std::size_t count = 1 << 18, stride = 12;
  const Sheet sheet;
  PackedSheet from = packed(sheet);
  const std::string zeros = packed_vertices(std::vector<float>(3 * count).data(), count, stride);
  json view = from.document["bufferViews"][0], accessor = from.document["accessors"][0];
  view["byteLength"] = count * stride, accessor["count"] = count;
  view["extensions"]["EXT_meshopt_compression"].update(
      {{"byteOffset", from.buffer.size()}, {"byteLength", zeros.size()}, {"count", count}});
  for (accessor["bufferView"] = 3; accessor["bufferView"] < 43;  // of 126 MB
       accessor["bufferView"] = accessor["bufferView"].get<int>() + 1) {
    from.document["accessors"].push_back(accessor);
    from.document["bufferViews"].push_back(view);
  }
  view["extensions"]["EXT_meshopt_compression"]["byteLength"] = 9;
  from.document["bufferViews"].push_back(view);
  from.buffer += zeros;
  from.document["buffers"][0]["byteLength"] = from.buffer.size();
  from.document["buffers"][1]["byteLength"] = count * stride;
  CHECK(load(from.document, from.buffer).vertices == as_it_is(sheet).vertices);
}

/// The document with a Draco stream of the sheet, of so many bits a coordinate, as its buffer.
std::pair<json, std::string> draco_sheet(const Sheet& sheet, int bits) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(sheet.indices.size() / 3));
  const int positions =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normals = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  for (std::uint32_t face = 0; 3 * face < sheet.indices.size(); ++face) {
    const std::uint32_t* corner = &sheet.indices[3 * face];
    const auto set = [&](int attribute, const std::vector<float>& of) {
      builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(face), &of[3 * corner[0]],
                                        &of[3 * corner[1]], &of[3 * corner[2]]);
    };
    set(positions, sheet.positions);
    set(normals, sheet.normals);
  }
  const auto mesh = builder.Finalize();
  draco::ExpertEncoder encoder(*mesh);
  encoder.SetAttributeQuantization(positions, bits);
  encoder.SetAttributeQuantization(normals, bits);
  encoder.SetTrackEncodedProperties(true);
  draco::EncoderBuffer stream;
  REQUIRE(encoder.EncodeToBuffer(&stream).ok());

  json document = document_of(sheet);
  document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  document["buffers"][0]["byteLength"] = stream.size();
  document["bufferViews"] = {{{"buffer", 0}, {"byteLength", stream.size()}}};
  for (json& accessor : document["accessors"]) accessor.erase("bufferView");
  json& primitive = document["meshes"][0]["primitives"][0];
  for (const int accessor : {0, 1}) {
    document["accessors"][accessor]["count"] = encoder.num_encoded_points();
  }
  primitive["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0},
      {"attributes",
       {{"POSITION", mesh->attribute(positions)->unique_id()},
        {"NORMAL", mesh->attribute(normals)->unique_id()}}}};
  return {document, {stream.data(), stream.size()}};
}

TEST_CASE("what Draco packed is the mesh to the bits that it kept") {
  const Sheet sheet;
  const Scene expected = as_it_is(sheet);
  auto [document, buffer] = draco_sheet(sheet, 16);
  const Scene scene = load(document, buffer);
  const json named = document["meshes"][0]["primitives"][0];
  document["meshes"].push_back(json(document["meshes"][0]));  // that no node places
  document["meshes"][1]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"] =
      9;
  for (int i = 0; i < 20; ++i) document["meshes"][0]["primitives"].push_back(named);
  CHECK(load(document, buffer).vertices == scene.vertices);
  CHECK(scene.report.warnings.empty());
  REQUIRE(scene.triangle_count() == expected.triangle_count());
  CHECK(total_area(scene) == Approx(total_area(expected)).epsilon(1e-4));
  CHECK(scene.corner_normal.size() == expected.corner_normal.size());
  for (const glm::vec3& vertex : scene.vertices) {
    const auto nearest =
        std::min_element(expected.vertices.begin(), expected.vertices.end(),
                         [&](const glm::vec3& a, const glm::vec3& b) {
                           return glm::distance(a, vertex) < glm::distance(b, vertex);
                         });
    CHECK(glm::distance(*nearest, vertex) < 1e-4f);
  }
}

TEST_CASE("a mesh that is there without compression, too, needs no Draco") {
  const Sheet sheet;
  json document = document_of(sheet);
  document["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 2}, {"attributes", {{"POSITION", 0}}}};  // no Draco data
  const std::string buffer =
      bytes_of(sheet.positions) + bytes_of(sheet.normals) + bytes_of(sheet.indices);
  CHECK(load(document, buffer).vertices == as_it_is(sheet).vertices);
  CHECK(load(document, buffer).triangle_count() == as_it_is(sheet).triangle_count());
}

TEST_CASE("damaged Draco data is refused by the mesh's name") {
  const Sheet sheet;
  const auto [document, buffer] = draco_sheet(sheet, 12);
  json cut = document;
  cut["bufferViews"][0]["byteLength"] = buffer.size() / 2;
  CHECK_THAT(refusal(cut, buffer), Contains("mesh 'square': its Draco data is damaged"));
  std::string spoilt = buffer;
  spoilt[0] = 'x';
  CHECK_THAT(refusal(document, spoilt), Contains("is damaged"));
  json other = document;
  other["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
       ["POSITION"] = 77;
  CHECK_THAT(refusal(other, buffer), Contains("an attribute that the file names"));
  json fewer = document;
  fewer["accessors"][0]["count"] = 5;
  CHECK_THAT(refusal(fewer, buffer), Contains("the accessor 5"));
  // What follows the header and the kind of traversal are the numbers of vertices and of faces.
  const std::size_t counts = 12;
  REQUIRE(buffer[8] == 1);  // edgebreaker
  std::string bomb = buffer;
  bomb.replace(counts, 8, "\x80\x80\x80\x40\xFF\xFF\xFF\x40");
  CHECK_THAT(refusal(document, bomb), Contains("larger than"));
  json absent = document;
  absent["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"] =
      9;
  CHECK_THAT(refusal(absent, buffer), Contains("has no buffer view"));
}

}  // namespace
}  // namespace photile::test

#endif
