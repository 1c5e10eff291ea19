# Everything photile links, from Debian's packages; cmake/setup.sh installs them.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(TBB REQUIRED)
find_package(embree 3.13 REQUIRED)
# Debian's Imath has a target for Python whose library is another package's: a long status message that
# reads like an error.
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
find_package(OpenEXR 3.1 REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(OpenImageIO 2.4 REQUIRED)
# Debian's target names OpenCV's headers, which its package does not depend on; CMake refuses a folder
# that does not exist.
get_target_property(_include OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER _include EXCLUDE REGEX "opencv")
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${_include}")
find_package(glm REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(tsl-robin-map REQUIRED)
find_package(Freetype REQUIRED)
if(PHOTILE_BUILD_COMMAND)
  find_package(CLI11 REQUIRED)
endif()
pkg_check_modules(xxhash REQUIRED IMPORTED_TARGET libxxhash)

# The Debian headers and loader, not another toolkit's that may be on the path.
find_path(OpenCL_INCLUDE_DIR CL/cl.h PATHS /usr/include NO_DEFAULT_PATH)
find_library(OpenCL_LIBRARY OpenCL PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE} NO_DEFAULT_PATH)
find_package(OpenCL REQUIRED)
