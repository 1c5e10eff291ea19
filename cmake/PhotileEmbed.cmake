# photile_embed_kernels(<target>): compiles the texts of kernels/**/*.cl, kernels/**/*.clh and
# include/photile/device/*.h into <target>, as host/renderer/device/embedded_files.hpp declares them. A kernel
# is known by its path below kernels/, a shared header by "photile/device/<name>". Those of
# kernels/structures are left out: bench/structures has them.
function(photile_embed_kernels target)
  set(script ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/embed_files.cmake)
  set(kernel_root ${PROJECT_SOURCE_DIR}/kernels)
  set(header_root ${PROJECT_SOURCE_DIR}/include)
  file(GLOB_RECURSE kernels CONFIGURE_DEPENDS ${kernel_root}/*.cl ${kernel_root}/*.clh)
  list(FILTER kernels EXCLUDE REGEX "/structures/")
  file(GLOB headers CONFIGURE_DEPENDS ${header_root}/photile/device/*.h)

  # The list of files goes through a file of its own: it changes when a file comes or goes, and a
  # command line has a limit.
  set(entries "")
  foreach(file IN LISTS kernels)
    file(RELATIVE_PATH name ${kernel_root} ${file})
    string(APPEND entries "${name}|${file}\n")
  endforeach()
  foreach(file IN LISTS headers)
    file(RELATIVE_PATH name ${header_root} ${file})
    string(APPEND entries "${name}|${file}\n")
  endforeach()
  set(list_file ${CMAKE_CURRENT_BINARY_DIR}/embedded_files.txt)
  file(CONFIGURE OUTPUT ${list_file} CONTENT "${entries}" @ONLY)

  set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_files.cpp)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DLIST=${list_file} -DOUTPUT=${output} -P ${script}
    DEPENDS ${kernels} ${headers} ${list_file} ${script}
    COMMENT "Embedding the kernels" VERBATIM)
  # The command belongs to this folder, the library to another: a target of its own orders them.
  add_custom_target(${target}_embedded_kernels DEPENDS ${output})
  target_sources(${target} PRIVATE ${output})
  add_dependencies(${target} ${target}_embedded_kernels)
endfunction()
