// A glTF import, and the smaller of its steps in their order.
#pragma once

#include <vector>

#include "gltf/accessor.hpp"
#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// Refuses scenes of too many triangles, and those whose nodes and meshes repeat few bytes too
/// often (limits::max_triangle_expansion); nothing is read or allocated for that, and all is
/// counted in 64 bits. Errors: InputError naming the mesh that asks for most.
void check_scene_size(const tinygltf::Model& model, const AccessorReader& accessors,
                      const std::vector<NodeVisit>& visits, const reading::ImportContext& context);

/// Chooses Scene::origin (triangles.hpp) and moves the visited nodes there, with all that hangs
/// on them: meshes, cameras, lights. Reads every mesh once more. Errors: InputError.
void move_to_origin(const tinygltf::Model& model, const AccessorReader& accessors,
                    std::vector<NodeVisit>& visits, reading::ImportContext& context);

/// Adds the perspective cameras of all visited nodes: they look along -z of their node, y upwards.
/// Orthographic ones and those without a sensible field of view are skipped with a warning.
void add_gltf_cameras(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                      reading::ImportContext& context);

/// Adds the environment light of the scene that is loaded, if it has one; triangles must be there.
/// The sharpest of its cube maps is what surrounds the scene: the others, and the coefficients of
/// irradiance, are the same light blurred for programs that do not trace it. Its values times
/// `intensity` are taken as cd/m2; PNGs with alpha are RGBD, linear value = sRGB-decoded RGB /
/// alpha. Surroundings that cannot be read are named in a warning. Errors: InputError where there
/// is no such light.
void add_gltf_surroundings(const tinygltf::Model& model, const AccessorReader& accessors,
                           reading::ImportContext& context);

/// Fills the context's scene from its .gltf or .glb file. Errors: InputError.
void import_gltf(reading::ImportContext& context);

}  // namespace photile::gltf
