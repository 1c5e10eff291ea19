# Precompiled headers of the standard library and of the largest others (glm, fmt, TBB, CLI11,
# nlohmann-json, Catch2), without which a fresh build takes nearly twice as long. They would hide from a compiler cache what it needs to see, and so are off where one is
# used (CMAKE_CXX_COMPILER_LAUNCHER).
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()
