# Debian packages: `cpack --config BUILD/CPackConfig.cmake` makes photile, photile-openimageio,
# photile-mpi, libphotile-dev and python3-photile. tests/package/debian.sh installs them on a bare Debian 12.
# Packages hold what has been built: tests and benches need not be.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The photile developers <photile@localhost>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS OFF)
set(CPACK_COMPONENTS_ALL development openimageio)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libphotile-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
  "photon mapping on OpenCL devices (library)\n Headers, the static library and its CMake files, for C++20 programs.")
# What photileConfig.cmake looks for.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libglm-dev, libtbb-dev, libembree-dev, libopenexr-dev, libpng-dev, libfmt-dev, nlohmann-json3-dev, robin-map-dev, libxxhash-dev, ocl-icd-opencl-dev, opencl-c-headers, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "photile-openimageio")

# A package of its own: OpenImageIO brings some 260 shared libraries, and EXRs are read without.
set(CPACK_DEBIAN_OPENIMAGEIO_PACKAGE_NAME photile-openimageio)
set(CPACK_DEBIAN_OPENIMAGEIO_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_OPENIMAGEIO_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_OPENIMAGEIO_DESCRIPTION
  "photon mapping on OpenCL devices (textures)\n Reads PNG, JPEG, TIFF, WebP, Radiance and other pictures for photile, by OpenImageIO.")

if(TARGET photile_command)
  list(APPEND CPACK_COMPONENTS_ALL command)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME photile)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION graphics)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "weasyprint, python3-ezdxf")
  set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd, photile-openimageio, fonts-dejavu-core, xdg-utils, python3-numpy, python3-jinja2, python3-contourpy")
  set(CPACK_COMPONENT_COMMAND_DESCRIPTION
    "photon mapping on OpenCL devices, a layer per light\n Renders interiors from glTF and OBJ files, changes the lights of finished pictures, measures lux,\n and walks through scenes in a browser.")
  set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/packaging/manual_pages.cmake)
  install(FILES cmake/packaging/org.photile.Photile.desktop DESTINATION share/applications
    COMPONENT command)
  install(FILES cmake/packaging/org.photile.Photile.metainfo.xml DESTINATION share/metainfo
    COMPONENT command)
  install(FILES cmake/packaging/org.photile.Photile.svg DESTINATION share/icons/hicolor/scalable/apps
    COMPONENT command)
  # Where Debian's Blender looks for add-ons.
  install(DIRECTORY python/blender/photile DESTINATION share/blender/scripts/addons COMPONENT command
    FILES_MATCHING PATTERN "*.py")
  install(FILES LICENSE DESTINATION share/doc/photile RENAME copyright COMPONENT command)
endif()

if(TARGET photile_mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_NAME photile-mpi)
  set(CPACK_DEBIAN_MPI_PACKAGE_SECTION graphics)
  set(CPACK_DEBIAN_MPI_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "photile")
  set(CPACK_COMPONENT_MPI_DESCRIPTION
    "photon mapping on OpenCL devices (several machines)\n Lets mpirun share a rendering between processes.")
endif()

if(TARGET photile_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-photile)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  math(EXPR _next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "photile, python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${_next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd, photile-openimageio")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "photon mapping on OpenCL devices (Python)\n Scenes, photons, photon maps, pictures and lux as arrays of numpy.")
endif()
include(CPack)
