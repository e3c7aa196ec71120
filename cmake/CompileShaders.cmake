# SPDX-License-Identifier: Apache-2.0
# fieldcast_shaders(TARGET KERNELS …): each shaders/NAME.comp becomes shaders/NAME.spv.h with `NAME_spv`, validated.
find_program(GLSLANG glslangValidator REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)

function(fieldcast_shaders target)
    cmake_parse_arguments(ARG "" "" "KERNELS" ${ARGN})
    set(headers)
    foreach(kernel ${ARG_KERNELS})
        set(source ${PROJECT_SOURCE_DIR}/shaders/${kernel}.comp)
        set(spirv ${CMAKE_BINARY_DIR}/shaders/${kernel}.spv)
        set(header ${CMAKE_BINARY_DIR}/shaders/${kernel}.spv.h)
        add_custom_command(
            OUTPUT ${header}
            COMMAND ${GLSLANG} --quiet --target-env vulkan1.3 -I${PROJECT_SOURCE_DIR}/shaders --depfile ${spirv}.d
                    -o ${spirv} ${source}
            COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${spirv}
            COMMAND ${GLSLANG} --quiet --target-env vulkan1.3 -I${PROJECT_SOURCE_DIR}/shaders --vn ${kernel}_spv
                    -o ${header} ${source}
            DEPENDS ${source}
            DEPFILE ${spirv}.d
            COMMENT "Compiling kernel ${kernel}" VERBATIM)
        list(APPEND headers ${header})
    endforeach()
    add_custom_target(${target}_spirv DEPENDS ${headers})
    add_library(${target} INTERFACE)
    add_dependencies(${target} ${target}_spirv)
    target_include_directories(${target} INTERFACE ${CMAKE_BINARY_DIR} ${PROJECT_SOURCE_DIR})
endfunction()
