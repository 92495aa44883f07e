# Compiler options that every target shares. -O2: the program's own speed is that of its shaders, and
# -O3 makes the build longer for nothing.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
add_library(oitlab_options INTERFACE)
target_compile_options(oitlab_options INTERFACE -Wall -Wextra -Wpedantic -Wno-missing-field-initializers)
if(OITLAB_WERROR)
  target_compile_options(oitlab_options INTERFACE -Werror)
endif()
if(OITLAB_SANITIZE)
  target_compile_options(oitlab_options INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
  target_link_options(oitlab_options INTERFACE -fsanitize=address,undefined)
endif()
if(OITLAB_FUZZ)
  target_compile_options(oitlab_options INTERFACE -fsanitize=fuzzer-no-link)  # coverage, which guides libFuzzer
endif()

find_program(CCACHE ccache)
if(CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_SOURCE_DIR}/cmake/compile_cached ${CMAKE_SOURCE_DIR})
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
  target_compile_options(oitlab_options INTERFACE -fpch-preprocess)  # which ccache asks for
endif()
