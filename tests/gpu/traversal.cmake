# SPDX-License-Identifier: Apache-2.0
# Ray traversal: the BVH on the CPU, and both traversals on the device against brute force and Embree.
if(TARGET fieldcast_bench_rays)
    fieldcast_test(bvh_tests LABELS quick
        SOURCES traversal_bvh_test.cpp traversal_reference.cpp
        DEPENDS fieldcast_bench_rays)
    fieldcast_test(traversal_tests LABELS gpu
        SOURCES gpu_test.cpp traversal_alpha_test.cpp traversal_reference.cpp traversal_scenes_test.cpp
                traversal_test.cpp
        DEPENDS fieldcast_bench_rays)
endif()
