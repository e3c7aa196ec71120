# SPDX-License-Identifier: Apache-2.0
# Interface target with the warnings every Fieldcast target is compiled with.
add_library(fieldcast_warnings INTERFACE)
target_compile_options(fieldcast_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations> # libstdc++ 12's own stable_sort
    $<$<BOOL:${FIELDCAST_WERROR}>:-Werror>)
