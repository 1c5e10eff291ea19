# photile_add_tests(<folder> [SOURCES <source>...] [EXCLUDE <source>...] [LIBRARIES <target>...])
#
# The executable of a folder of tests/: of its sources without those to EXCLUDE, and of SOURCES elsewhere.
# The test cases of a source file are one test of CTest,
# <folder>/<file>, with the label of the folder: a process for each case would take longer to start than
# most take to run. Cases tagged [slow] are another, <folder>/<file> (slow), with the label "slow".
#
# Run as a script, it asks a built executable for its files and writes what CTest includes. (Catch's own
# module makes a test of each case.)
if(CMAKE_SCRIPT_MODE_FILE)
  set(tests "")
  foreach(selection IN ITEMS "~[slow]" "[slow]")
    # Its exit code tells nothing.
    execute_process(COMMAND ${EXECUTABLE} ${selection} --filenames-as-tags --list-tags
                    OUTPUT_VARIABLE list)
    string(REGEX MATCHALL "\\[#[^]]+\\]" files "${list}")
    foreach(file IN LISTS files)
      string(REGEX REPLACE "\\[#(.*)\\]" "${FOLDER}/\\1" name "${file}")
      set(label ${FOLDER})
      set(seconds 1200)
      if(selection STREQUAL "[slow]")
        string(APPEND name " (slow)")
        set(label slow)
        set(seconds 3600)
      endif()
      string(APPEND tests
        "add_test([==[${name}]==] [==[${EXECUTABLE}]==] --filenames-as-tags --warn NoTests "
        "[==[${file}${selection}]==])\n"
        "set_tests_properties([==[${name}]==] PROPERTIES LABELS ${label} TIMEOUT ${seconds} "
        "SKIP_RETURN_CODE 77)\n")
    endforeach()
  endforeach()
  if(NOT tests)
    message(FATAL_ERROR "${EXECUTABLE} lists no tests; run it with --list-tests")
  endif()
  file(WRITE ${OUTPUT} "${tests}")
  return()
endif()

set(photile_add_tests_script ${CMAKE_CURRENT_LIST_FILE})

function(photile_add_tests folder)
  cmake_parse_arguments(arg "" "" "SOURCES;EXCLUDE;LIBRARIES" ${ARGN})
  set(target photile_tests_${folder})
  file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  list(REMOVE_ITEM sources ${arg_EXCLUDE} "")
  add_executable(${target} ${sources} ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE photile_test_main ${arg_LIBRARIES})
  target_precompile_headers(${target} REUSE_FROM photile_test_headers)
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}.cmake)
  add_custom_command(TARGET ${target} POST_BUILD VERBATIM BYPRODUCTS ${list}
    COMMAND ${CMAKE_COMMAND} -DEXECUTABLE=$<TARGET_FILE:${target}> -DFOLDER=${folder}
            -DOUTPUT=${list} -P ${photile_add_tests_script})
  # A folder that is not built has a test that says so.
  file(WRITE ${list}.in "include([==[${list}]==] OPTIONAL RESULT_VARIABLE found)
if(NOT found)
  add_test(${target}_NOT_BUILT ${target}_NOT_BUILT)
endif()
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${list}.in)
endfunction()
