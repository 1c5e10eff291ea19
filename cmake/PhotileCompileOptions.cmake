# Warnings and code generation shared by the library, the command, the tests and the benches.
add_library(photile_compile_options INTERFACE)
target_compile_options(photile_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wnon-virtual-dtor
  # One rounding per operation, so that a compiler with fused multiply-add gives the same bits.
  -ffp-contract=off)
# The many executables of the tests are linked in a tenth of the time by GNU gold (of binutils).
include(CheckLinkerFlag)
check_linker_flag(CXX -fuse-ld=gold PHOTILE_HAS_GOLD)
if(PHOTILE_HAS_GOLD AND NOT PHOTILE_SANITIZE AND NOT PHOTILE_SANITIZE_THREADS)
  add_link_options(-fuse-ld=gold)
endif()
if(PHOTILE_SANITIZE)
  target_compile_options(photile_compile_options INTERFACE
    -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(photile_compile_options INTERFACE -fsanitize=address,undefined)
endif()
if(PHOTILE_SANITIZE_THREADS)
  target_compile_options(photile_compile_options INTERFACE -fsanitize=thread)
  target_link_options(photile_compile_options INTERFACE -fsanitize=thread)
endif()
