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

# fieldcast_kernel_table(TARGET KERNELS … TRACED …): writes "shaders/kernel_ids.h" with the names of the kernels as an
# enumeration, KernelId::kTraceSource of trace_source; "shaders/kernel_code.h" with their code, and a row for each,
# {id, name, code for bvh, code for ray queries}, in "shaders/kernel_rows.inc".
function(fieldcast_kernel_table target)
    cmake_parse_arguments(ARG "" "" "KERNELS;TRACED" ${ARGN})
    set(names ${ARG_KERNELS} ${ARG_TRACED})
    list(SORT names)
    set(ids)
    set(includes)
    set(rows)
    foreach(name ${names})
        string(REPLACE "_" ";" words ${name})
        set(id k)
        foreach(word ${words})
            string(SUBSTRING ${word} 0 1 initial)
            string(SUBSTRING ${word} 1 -1 rest)
            string(TOUPPER ${initial} initial)
            string(APPEND id ${initial}${rest})
        endforeach()
        set(bvh ${name})
        set(ray_query ${name})
        if(name IN_LIST ARG_TRACED)
            set(bvh ${name}_bvh)
            set(ray_query ${name}_rayquery)
            string(APPEND includes "#include \"shaders/${ray_query}.spv.h\"\n")
        endif()
        string(APPEND includes "#include \"shaders/${bvh}.spv.h\"\n")
        string(APPEND ids "    ${id},\n")
        string(APPEND rows "    {KernelId::${id}, \"${name}\", ${bvh}_spv, ${ray_query}_spv},\n")
    endforeach()
    set(folder ${CMAKE_BINARY_DIR}/shaders)
    set(head "// SPDX-License-Identifier: Apache-2.0\n// Written by cmake/CompileShaders.cmake.\n")
    file(CONFIGURE OUTPUT ${folder}/kernel_ids.h CONTENT
        "${head}#pragma once\n\nnamespace fieldcast::render {\n\nenum class KernelId {\n${ids}};\n\n} // namespace fieldcast::render\n" @ONLY)
    file(CONFIGURE OUTPUT ${folder}/kernel_code.h CONTENT "${head}#pragma once\n\n${includes}" @ONLY)
    file(CONFIGURE OUTPUT ${folder}/kernel_rows.inc CONTENT "${rows}" @ONLY)
endfunction()
