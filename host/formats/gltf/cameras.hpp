// The cameras of a glTF file, and how an animation moves one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gltf/nodes.hpp"
#include "gltf/tiny_gltf.hpp"
#include "photile/load_scene.hpp"
#include "reading/camera_path.hpp"
#include "reading/import_context.hpp"

namespace photile::gltf {

/// Adds the perspective cameras of all visited nodes: they look along -z of their node, y upwards.
/// Orthographic ones and those without a sensible field of view are skipped with a warning.
void add_gltf_cameras(const tinygltf::Model& model, const std::vector<NodeVisit>& visits,
                      reading::ImportContext& context);

/// How a glTF file moves a camera: translation, rotation and scale of its node and of all nodes
/// above it, STEP, LINEAR or CUBICSPLINE (glTF 2.0, appendix C). The camera keeps the field of view
/// and aspect ratio of `camera`, whose name says which it is.
///   options     those that `camera` was loaded with
///   animation   name or index; "" = the first that moves the camera
/// Errors: InputError naming the file where it is no glTF, has no such animation, or none that
/// moves the camera; those of load_scene.
reading::CameraMotion read_camera_animation(const std::filesystem::path& file,
                                            const SceneLoadOptions& options, const Camera& camera,
                                            const std::string& animation);

}  // namespace photile::gltf
