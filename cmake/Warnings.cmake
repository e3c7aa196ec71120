# SPDX-License-Identifier: Apache-2.0
# Interface target with the warnings of every Fieldcast target.
# A file that the compiler reads makes them errors or not, so that switching rebuilds nothing.
if(FIELDCAST_WERROR)
    set(werror -Werror)
    # Instrumented by sanitizers, code that sets all its values looks to GCC as if it did not (its manual,
    # "-fsanitize").
    if(FIELDCAST_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
        string(APPEND werror " -Wno-error=maybe-uninitialized")
    endif()
endif()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/werror.rsp CONTENT "@werror@\n" @ONLY)
add_library(fieldcast_warnings INTERFACE)
target_compile_options(fieldcast_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations> # libstdc++ 12's own stable_sort
    @${PROJECT_BINARY_DIR}/werror.rsp)
