// The scenes that lie beside a checkout, where they do; PHOTILE_SHARED_SCENES names another place.
#pragma once

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "photile/load_scene.hpp"
#include "photile/scene.hpp"
#include "source_folder.hpp"

namespace photile::test {

inline std::filesystem::path shared_scenes_folder() {
  const char* place = std::getenv("PHOTILE_SHARED_SCENES");
  return place != nullptr ? std::filesystem::path(place) : source_folder() / "../shared/scenes";
}

/// A scene file, and what becomes of it under a sky: many of the files are models without a lamp.
struct SharedScene {
  std::string_view file;  ///< below the folder
  /// "" where the file loads and renders; else what the refusal says of it.
  std::string_view refusal;
};

inline Scene load_shared_scene(const SharedScene& scene) {
  SceneLoadOptions options;
  options.sky = Sky{SkyKind::uniform, 1000};
  options.ground = 0;
  options.light_groups = {LightGrouping::parse("*=all")};  // one layer: few kernels
  return load_scene(shared_scenes_folder() / scene.file, options);
}

/// Every scene file there is, so that none is forgotten in silence.
inline constexpr std::array<SharedScene, 123> shared_scenes{{
    // clang-format off
    {"classroom/classroom-diffuse.gltf", ""},
    {"classroom/classroom.gltf", ""},
    {"kitchen/kitchen-diffuse.gltf", ""},
    {"kitchen/kitchen.gltf", ""},
    {"odd/assimp/OBJ/box.obj", ""},
    {"odd/assimp/OBJ/box_UTF16BE.obj", "UTF-16"},
    {"odd/assimp/OBJ/box_longline.obj", ""},
    {"odd/assimp/OBJ/box_mat_with_spaces.obj", ""},
    {"odd/assimp/OBJ/box_without_lineending.obj", ""},
    {"odd/assimp/OBJ/concave_polygon.obj", ""},
    {"odd/assimp/OBJ/cube_mtllib_after_g.obj", ""},
    {"odd/assimp/OBJ/cube_usemtl.obj", ""},
    {"odd/assimp/OBJ/cube_with_vertexcolors.obj", ""},
    {"odd/assimp/OBJ/cube_with_vertexcolors_uni.obj", ""},
    {"odd/assimp/OBJ/empty_mat.obj", ""},
    {"odd/assimp/OBJ/mtl_different_folder.obj", ""},
    {"odd/assimp/OBJ/multiple_spaces.obj", ""},
    {"odd/assimp/OBJ/number_formats.obj", "no triangles"},
    {"odd/assimp/OBJ/only_a_part_of_vertexcolors.obj", ""},
    {"odd/assimp/OBJ/point_cloud.obj", "no triangles"},
    {"odd/assimp/OBJ/regr_3429812.obj", ""},
    {"odd/assimp/OBJ/space_in_material_name.obj", ""},
    {"odd/assimp/OBJ/testline.obj", "no triangles"},
    {"odd/assimp/OBJ/testmixed.obj", ""},
    {"odd/assimp/OBJ/testpoints.obj", "no triangles"},
    {"odd/assimp/glTF2/AnimatedMorphCube/glTF/AnimatedMorphCube.gltf", ""},
    {"odd/assimp/glTF2/AnimatedMorphSphere/glTF/AnimatedMorphSphere.gltf", "AnimatedMorphSphere.bin"},
    {"odd/assimp/glTF2/BoxBadNormals-glTF-Binary/BoxBadNormals.glb", ""},
    {"odd/assimp/glTF2/BoxTexcoords-glTF/boxTexcoords.gltf", ""},
    {"odd/assimp/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb", ""},
    {"odd/assimp/glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf", ""},
    {"odd/assimp/glTF2/BoxTextured-glTF-pbrSpecularGlossiness/BoxTextured.gltf", ""},
    {"odd/assimp/glTF2/BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf", "KHR_technique_webgl"},
    {"odd/assimp/glTF2/BoxTextured-glTF/BoxTextured.gltf", ""},
    {"odd/assimp/glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "infinite"},
    {"odd/assimp/glTF2/IncorrectVertexArrays/Cube.gltf", ""},
    {"odd/assimp/glTF2/IndexOutOfRange/AllIndicesOutOfRange.gltf", "index 65535 is out of range of 24"},
    {"odd/assimp/glTF2/IndexOutOfRange/IndexOutOfRange.gltf", "index 255 is out of range of 24"},
    {"odd/assimp/glTF2/MissingBin/BoxTextured.gltf", "BoxTextured0.bin"},
    {"odd/assimp/glTF2/MorphPrimitivesTest/glTF/MorphPrimitivesTest.gltf", ""},
    {"odd/assimp/glTF2/RecursiveNodes/RecursiveNodes.gltf", "ancestor"},
    {"odd/assimp/glTF2/SchemaFailures/sceneWrongType.gltf", "BoxTextured0.bin"},
    {"odd/assimp/glTF2/SimpleMorph/glTF/SimpleMorph.gltf", ""},
    {"odd/assimp/glTF2/TestNoRootNode/NoScene.gltf", "no triangles"},
    {"odd/assimp/glTF2/TestNoRootNode/SceneWithoutNodes.gltf", "no triangles"},
    {"odd/assimp/glTF2/cameras/Cameras.gltf", ""},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_00.gltf", "no triangles"},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_01.gltf", "no triangles"},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_02.gltf", "no triangles"},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_03.gltf", "no triangles"},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_04.gltf", ""},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_05.gltf", ""},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_06.gltf", ""},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_07.gltf", "no triangles"},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_08.gltf", "no triangles"},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_09.gltf", "no triangles"},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_10.gltf", "no triangles"},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_11.gltf", ""},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_12.gltf", ""},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_13.gltf", ""},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_14.gltf", ""},
    {"odd/assimp/glTF2/glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_15.gltf", ""},
    {"odd/assimp/glTF2/glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf", ""},
    {"odd/assimp/glTF2/issue_3269/texcoord_crash.gltf", ""},
    {"odd/assimp/glTF2/simple_skin/quad_skin.glb", ""},
    {"odd/assimp/glTF2/simple_skin/simple_skin.gltf", ""},
    {"odd/assimp/glTF2/textureTransform/TextureTransformTest.gltf", ""},
    {"odd/assimp/glTF2/wrongTypes/badArray.gltf", "no triangles"},
    {"odd/assimp/glTF2/wrongTypes/badExtension.gltf", ""},
    {"odd/assimp/glTF2/wrongTypes/badNumber.gltf",
     "materials[0].normalTexture.scale is a text, not a number"},
    {"odd/assimp/glTF2/wrongTypes/badObject.gltf", ""},
    {"odd/assimp/glTF2/wrongTypes/badString.gltf", ""},
    {"odd/assimp/glTF2/wrongTypes/badUint.gltf", ""},
    {"odd/assimp/invalid/empty.obj", "empty"},
    {"odd/assimp/invalid/malformed.obj", "face 1"},
    {"odd/assimp/invalid/malformed2.obj", ""},
    {"odd/obj/catmark_torus_creases0.obj", ""},
    {"odd/obj/colorspace-issue-184.obj", ""},
    {"odd/obj/cornell_box.obj", ""},
    {"odd/obj/cornell_box_multimaterial.obj", ""},
    {"odd/obj/cube-vertex-w-component.obj", ""},
    {"odd/obj/cube-vertexcol.obj", ""},
    {"odd/obj/cube.obj", ""},
    {"odd/obj/invalid-face-definition.obj", "no triangles"},
    {"odd/obj/invalid-relative-texture-index.obj", "face 1"},
    {"odd/obj/invalid-relative-vertex-index.obj", "face 1"},
    {"odd/obj/issue-138.obj", ""},
    {"odd/obj/issue-140-zero-face-idx.obj", "face 1"},
    {"odd/obj/issue-161-inconsistent-f.obj", ""},
    {"odd/obj/issue-162-smoothing-group.obj", ""},
    {"odd/obj/issue-235-usemtl-then-o.obj", ""},
    {"odd/obj/issue-244-mtl-searchpaths.obj", ""},
    {"odd/obj/issue-246-usemtl-whitespace.obj", ""},
    {"odd/obj/issue-248-texres-texopt.obj", ""},
    {"odd/obj/issue-295-trianguation-failure.obj", ""},
    {"odd/obj/issue-319-002.obj", ""},
    {"odd/obj/issue-319-003.obj", ""},
    {"odd/obj/issue-330.obj", ""},
    {"odd/obj/issue-356-leading-spaces-newmtl.obj", "no triangles"},
    {"odd/obj/issue-92.obj", ""},
    {"odd/obj/issue-95-2.obj", ""},
    {"odd/obj/issue-95.obj", ""},
    {"odd/obj/leading-decimal-dot-issue-201.obj", ""},
    {"odd/obj/leading-zero-in-exponent-notation-issue-210.obj", ""},
    {"odd/obj/line-prim.obj", "no triangles"},
    {"odd/obj/map-bump.obj", ""},
    {"odd/obj/missing_material_file.obj", ""},
    {"odd/obj/mtl filename with whitespace issue46.obj", ""},
    {"odd/obj/mtllib-multiple-files-issue-112.obj", ""},
    {"odd/obj/no_material.obj", ""},
    {"odd/obj/norm-texopt.obj", ""},
    {"odd/obj/pbr-mat-ext.obj", ""},
    {"odd/obj/points-prim.obj", "no triangles"},
    {"odd/obj/refl.obj", ""},
    {"odd/obj/skin-weight.obj", ""},
    {"odd/obj/smoothing-group-two-squares.obj", ""},
    {"odd/obj/smoothing-normal.obj", ""},
    {"odd/obj/test-nan.obj", ""},
    {"odd/obj/texture-filename-with-whitespace.obj", ""},
    {"odd/obj/texture-options-issue-85.obj", ""},
    {"odd/obj/tr-and-d-issue-43.obj", ""},
    {"odd/obj/usemtl-issue-104.obj", ""},
    {"odd/obj/usemtl-issue-68.obj", ""},
    // clang-format on
}};

}  // namespace photile::test
