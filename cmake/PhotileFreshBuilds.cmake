# Fresh builds take half the time where source files are compiled several at once (CMake's unity builds)
# and the headers of the largest libraries (glm, fmt, TBB, CLI11, nlohmann-json, Catch2) once. Both
# would hide from a compiler cache what it needs to see, and make a change of one file slower: where a
# cache is used (CMAKE_CXX_COMPILER_LAUNCHER) each file is compiled alone. So that files of a folder can
# be compiled together, the names in their unnamed namespaces differ.
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
else()
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 12)
endif()
