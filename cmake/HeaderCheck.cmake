# SPDX-License-Identifier: Apache-2.0
# fieldcast_check_headers(FOLDER …): compiles each header below the folders alone, as part of `all`, with the include
# paths of the targets of its folder. A header that needs another one included first does not compile. Left out are
# headers that a source of the same name includes first: compiling that says the same.
# Call it after all targets are defined; folders that are not built are left out.

function(fieldcast_check_headers)
    get_property(built DIRECTORY ${PROJECT_SOURCE_DIR} PROPERTY SUBDIRECTORIES)
    foreach(folder ${ARGN})
        if(${PROJECT_SOURCE_DIR}/${folder} IN_LIST built)
            _fieldcast_check_folder(${PROJECT_SOURCE_DIR}/${folder})
        endif()
    endforeach()
endfunction()

# One source per header; a header of a subdirectory that has targets of its own is checked there.
function(_fieldcast_check_folder folder)
    get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
    get_property(children DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
    foreach(child ${children})
        _fieldcast_check_folder(${child})
    endforeach()
    file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${folder}/*.h)
    if(NOT headers OR NOT targets)
        return()
    endif()

    set(sources)
    foreach(header ${headers})
        string(REGEX REPLACE "\\.h$" ".cpp" own_source ${PROJECT_SOURCE_DIR}/${header})
        if(EXISTS ${own_source})
            file(STRINGS ${own_source} first_include REGEX "^#include" LIMIT_COUNT 1)
            if(first_include STREQUAL "#include \"${header}\"")
                continue()
            endif()
        endif()
        set(source ${PROJECT_BINARY_DIR}/headers/${header}.cpp)
        set(content "#include \"${header}\"\n#include \"${header}\"\n") # twice: also checks the guard
        file(CONFIGURE OUTPUT ${source} CONTENT "${content}" @ONLY)
        list(APPEND sources ${source})
    endforeach()
    if(NOT sources)
        return()
    endif()
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE name)
    string(REPLACE "/" "_" name fieldcast_headers_${name})
    add_library(${name} OBJECT ${sources})
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
    target_compile_options(${name} PRIVATE -O0 -g0)
    foreach(target ${targets})
        get_target_property(type ${target} TYPE)
        if(type MATCHES "LIBRARY|EXECUTABLE")
            add_dependencies(${name} ${target}) # generated headers exist then
            target_include_directories(${name} SYSTEM PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
            target_compile_definitions(${name} PRIVATE $<TARGET_PROPERTY:${target},COMPILE_DEFINITIONS>)
        endif()
    endforeach()
endfunction()
