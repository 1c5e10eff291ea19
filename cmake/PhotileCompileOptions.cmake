# Warnings and code generation shared by the library, the command, the tests and the benches.
add_library(photile_compile_options INTERFACE)
target_compile_options(photile_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wnon-virtual-dtor
  # One rounding per operation, so that a compiler with fused multiply-add gives the same bits.
  -ffp-contract=off)
if(PHOTILE_SANITIZE)
  target_compile_options(photile_compile_options INTERFACE
    -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(photile_compile_options INTERFACE -fsanitize=address,undefined)
endif()
