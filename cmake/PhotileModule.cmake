# photile_add_module(<name> COMPONENT <component> SOURCES <source>... LIBRARIES <target>...)
#
# A shared object that host/renderer/common/module loads when it is first needed. It sees none of the library's
# functions: what it needs of them is among its sources.
function(photile_add_module name)
  cmake_parse_arguments(arg "" "COMPONENT" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${name} MODULE ${arg_SOURCES})
  target_include_directories(${name} PRIVATE
    ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/host/renderer)
  target_link_libraries(${name} PRIVATE photile_compile_options ${arg_LIBRARIES})
  # A function that is missing ends the build, not the first run. Clang's sanitizers live in the command.
  if(NOT PHOTILE_SANITIZE AND NOT PHOTILE_SANITIZE_THREADS AND NOT PHOTILE_FUZZ)
    target_link_options(${name} PRIVATE -Wl,-z,defs)
  endif()
  set_target_properties(${name} PROPERTIES
    PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  if(DEFINED SKBUILD)  # by pip, beside the Python module
    install(TARGETS ${name} LIBRARY DESTINATION photile COMPONENT python)
  else()
    install(TARGETS ${name} LIBRARY DESTINATION ${PHOTILE_MODULE_FOLDER} COMPONENT ${arg_COMPONENT})
  endif()
endfunction()

# What is built here finds the modules in the build folder, and Open Image Denoise where cmake/fetch.sh has
# put it; what is installed, beside the libraries.
set(PHOTILE_MODULE_FOLDER ${CMAKE_INSTALL_LIBDIR}/photile)
set(CMAKE_BUILD_RPATH ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR}/build/denoiser/lib)

set(PHOTILE_PYTHON_FOLDER lib/python3/dist-packages CACHE STRING
  "Where the Python module is installed, below the prefix")

# photile_find_modules(<target> <folder>): where the target that is installed in this folder, below the
# prefix, finds them.
function(photile_find_modules target folder)
  file(RELATIVE_PATH path /${folder} /${PHOTILE_MODULE_FOLDER})
  if(DEFINED SKBUILD)
    set(path "")
  endif()
  set_target_properties(${target} PROPERTIES INSTALL_RPATH "$ORIGIN/${path}")
endfunction()
