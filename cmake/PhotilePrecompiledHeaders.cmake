# Precompiled headers of the largest libraries (CLI11, nlohmann-json, Catch2), which take a third of a
# fresh build. They would hide from a compiler cache what it needs to see, and so are off where one is
# used (CMAKE_CXX_COMPILER_LAUNCHER).
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
