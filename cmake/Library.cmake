# SPDX-License-Identifier: Apache-2.0
# fieldcast_library(NAME SOURCES … DEPENDS … PRIVATE …): one folder = one target.
# DEPENDS are public; PRIVATE libraries stay behind the folder's own headers.
function(fieldcast_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} PUBLIC ${ARG_DEPENDS} PRIVATE fieldcast_warnings ${ARG_PRIVATE})
endfunction()
