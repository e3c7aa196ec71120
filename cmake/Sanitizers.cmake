# SPDX-License-Identifier: Apache-2.0
# FIELDCAST_SANITIZE=address,undefined | thread applies to every target of the build. Reports need files and lines only,
# and all of -g takes half as long again to compile.
if(FIELDCAST_SANITIZE)
    add_compile_options(-fsanitize=${FIELDCAST_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -O1 -g1)
    add_link_options(-fsanitize=${FIELDCAST_SANITIZE})
endif()

# FIELDCAST_FUZZ: instruments all code with branch counters for libFuzzer (tests/fuzz). Needs clang.
if(FIELDCAST_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        message(FATAL_ERROR "FIELDCAST_FUZZ needs clang: use the preset fuzz")
    endif()
    add_compile_options(-fsanitize=fuzzer-no-link)
endif()
