// The animation of a glTF camera.
#pragma once

#include <filesystem>
#include <string>

#include "photile/scene.hpp"
#include "reading/camera_path.hpp"

namespace photile::gltf {

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
