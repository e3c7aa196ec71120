# SPDX-License-Identifier: Apache-2.0
# fieldcast_shaders(TARGET KERNELS … [SOURCE_DIR DIR]): each NAME.comp of DIR (default: shaders/) becomes a validated
# DIR/NAME.spv.h in the build tree, included as "shaders/NAME.spv.h", with the words of the kernel in `NAME_spv`.
find_program(GLSLANG glslangValidator REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)

function(fieldcast_shaders target)
    cmake_parse_arguments(ARG "" "SOURCE_DIR" "KERNELS" ${ARGN})
    if(NOT ARG_SOURCE_DIR)
        set(ARG_SOURCE_DIR ${PROJECT_SOURCE_DIR}/shaders)
    endif()
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${ARG_SOURCE_DIR} NORMALIZE is_generated)
    if(is_generated)
        set(output_dir ${ARG_SOURCE_DIR})
    else()
        cmake_path(RELATIVE_PATH ARG_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE folder)
        set(output_dir ${CMAKE_BINARY_DIR}/${folder})
    endif()
    set(compile ${GLSLANG} --quiet --target-env vulkan1.3 -I${PROJECT_SOURCE_DIR} -I${PROJECT_SOURCE_DIR}/shaders)
    set(headers)
    foreach(kernel ${ARG_KERNELS})
        set(source ${ARG_SOURCE_DIR}/${kernel}.comp)
        set(spirv ${output_dir}/${kernel}.spv)
        file(MAKE_DIRECTORY ${output_dir})
        # The dependency file names ${spirv}, so that comes first in OUTPUT.
        add_custom_command(
            OUTPUT ${spirv} ${spirv}.h
            COMMAND ${compile} --depfile ${spirv}.d -o ${spirv} ${source}
            COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${spirv}
            COMMAND ${compile} --vn ${kernel}_spv -o ${spirv}.h ${source}
            DEPENDS ${source}
            DEPFILE ${spirv}.d
            COMMENT "Compiling kernel ${kernel}" VERBATIM)
        list(APPEND headers ${spirv}.h)
    endforeach()
    add_custom_target(${target}_spirv DEPENDS ${headers})
    add_library(${target} INTERFACE)
    add_dependencies(${target} ${target}_spirv)
    target_include_directories(${target} INTERFACE ${CMAKE_BINARY_DIR} ${PROJECT_SOURCE_DIR})
endfunction()
