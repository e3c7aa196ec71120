# SPDX-License-Identifier: Apache-2.0
# FIELDCAST_SANITIZE=address,undefined | thread applies to every target of the build.
if(FIELDCAST_SANITIZE)
    add_compile_options(-fsanitize=${FIELDCAST_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -O1)
    add_link_options(-fsanitize=${FIELDCAST_SANITIZE})
endif()

# FIELDCAST_FUZZ: everything counts its branches, for libFuzzer (tests/fuzz). Needs clang.
if(FIELDCAST_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        message(FATAL_ERROR "FIELDCAST_FUZZ needs clang: use the preset fuzz")
    endif()
    add_compile_options(-fsanitize=fuzzer-no-link)
endif()
