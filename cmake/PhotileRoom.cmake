# photile_add_room(<room> FOLDERS <folder>... [SEES <room>...])
#
# A part of the library: every source of these folders of host/<room>. Its files find the headers of the
# rooms that it names, and of no others: an include against the direction apps -> lighting -> formats ->
# renderer does not compile.
function(photile_add_room room)
  cmake_parse_arguments(arg "" "" "FOLDERS;SEES" ${ARGN})
  set(sources "")
  foreach(folder IN LISTS arg_FOLDERS)
    file(GLOB found CONFIGURE_DEPENDS ${folder}/*.cpp)
    list(APPEND sources ${found})
  endforeach()
  set(target photile_${room})
  add_library(${target} OBJECT ${sources})
  # The Python module is a shared object, which takes the library whole. Names that it hides cost
  # calls nothing.
  set_target_properties(${target} PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(${target}
    PUBLIC ${CMAKE_CURRENT_SOURCE_DIR} PRIVATE ${PROJECT_SOURCE_DIR}/include)
  foreach(seen IN LISTS arg_SEES)
    target_include_directories(${target}
      PUBLIC $<TARGET_PROPERTY:photile_${seen},INTERFACE_INCLUDE_DIRECTORIES>)
  endforeach()
  target_link_libraries(${target} PRIVATE glm::glm photile_compile_options ${PHOTILE_LIBRARIES})
  if(arg_SEES)
    list(GET arg_SEES 0 first)
    target_precompile_headers(${target} REUSE_FROM photile_${first})
  else()
    target_precompile_headers(${target} PRIVATE
      <algorithm> <cmath> <filesystem> <functional> <memory> <optional> <span> <string> <vector>
      <fmt/format.h> <glm/glm.hpp> <tbb/parallel_for.h>)
  endif()
  target_sources(photile PRIVATE $<TARGET_OBJECTS:${target}>)
endfunction()
