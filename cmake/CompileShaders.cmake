# SPDX-License-Identifier: Apache-2.0
# fieldcast_shaders(TARGET KERNELS … [SOURCE_DIR DIR]): each NAME.comp of DIR (default: shaders/) becomes a validated
# DIR/NAME.spv.h in the build tree, included as "shaders/NAME.spv.h", with the words of the kernel in `NAME_spv`.
# Kernels after TRACED trace rays: they are compiled once per traversal, as NAME_bvh and NAME_rayquery. Names after
# RASTER are pairs of NAME.vert and NAME.frag, those after FRAGMENTS only NAME.frag, compiled as NAME_vert and NAME_frag.
find_program(GLSLANG glslangValidator REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)

# One file under one name; uses the variables of fieldcast_shaders.
macro(fieldcast_shader file name)
    set(source ${ARG_SOURCE_DIR}/${file})
    set(spirv ${output_dir}/${name}.spv)
    # The dependency file names ${spirv}, so that comes first in OUTPUT.
    add_custom_command(
        OUTPUT ${spirv} ${spirv}.h
        COMMAND ${compile} ${ARGN} --depfile ${spirv}.d -o ${spirv} ${source}
        COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${spirv}
        COMMAND ${compile} ${ARGN} --vn ${name}_spv -o ${spirv}.h ${source}
        DEPENDS ${source}
        DEPFILE ${spirv}.d
        COMMENT "Compiling kernel ${name}" VERBATIM)
    list(APPEND headers ${spirv}.h)
endmacro()

function(fieldcast_shaders target)
    cmake_parse_arguments(ARG "" "SOURCE_DIR" "KERNELS;TRACED;RASTER;FRAGMENTS" ${ARGN})
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
    file(MAKE_DIRECTORY ${output_dir})
    foreach(kernel ${ARG_KERNELS})
        fieldcast_shader(${kernel}.comp ${kernel})
    endforeach()
    foreach(kernel ${ARG_TRACED})
        fieldcast_shader(${kernel}.comp ${kernel}_bvh)
        fieldcast_shader(${kernel}.comp ${kernel}_rayquery -DTRAVERSAL_RAY_QUERY)
    endforeach()
    foreach(pair ${ARG_RASTER})
        fieldcast_shader(${pair}.vert ${pair}_vert)
        fieldcast_shader(${pair}.frag ${pair}_frag)
    endforeach()
    foreach(name ${ARG_FRAGMENTS})
        fieldcast_shader(${name}.frag ${name}_frag)
    endforeach()
    add_custom_target(${target}_spirv DEPENDS ${headers})
    add_library(${target} INTERFACE)
    add_dependencies(${target} ${target}_spirv)
    target_include_directories(${target} INTERFACE ${CMAKE_BINARY_DIR} ${PROJECT_SOURCE_DIR})
endfunction()
