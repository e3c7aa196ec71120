# SPDX-License-Identifier: Apache-2.0
# Interface target with the warnings every Fieldcast target is compiled with.
# Whether they are errors stands in a file that the compiler reads, so that switching it rebuilds nothing.
if(FIELDCAST_WERROR)
    set(werror -Werror)
    # What sanitizers add to the code lets GCC see values that are not set where there are none (its manual, "-fsanitize").
    if(FIELDCAST_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
        string(APPEND werror " -Wno-error=maybe-uninitialized")
    endif()
endif()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/werror.rsp CONTENT "@werror@\n" @ONLY)
add_library(fieldcast_warnings INTERFACE)
target_compile_options(fieldcast_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations> # libstdc++ 12's own stable_sort
    @${PROJECT_BINARY_DIR}/werror.rsp)
