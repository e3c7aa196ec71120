# SPDX-License-Identifier: Apache-2.0
# The client against a scripted server, its scene cache, its flags; and both programs together.
find_package(CLI11 REQUIRED)
add_library(client_fake_server STATIC ${CMAKE_CURRENT_LIST_DIR}/client_fake_server.cpp)
target_include_directories(client_fake_server PUBLIC ${PROJECT_SOURCE_DIR}/tests/system)
target_link_libraries(client_fake_server PUBLIC fieldcast_wire fieldcast_proto_grpc PRIVATE fieldcast_warnings
                      INTERFACE grpc_end)

fieldcast_test(client_session_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/client_session_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/client_agreement_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/client_backoff_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/client_clock_sync_test.cpp
    DEPENDS client_fake_server fieldcast_client_net)
fieldcast_test(client_play_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/client_play_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/client_scene_cache_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/client_statistics_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/client_steering_test.cpp
    DEPENDS client_fake_server fieldcast_client_play)
fieldcast_test(client_options_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/client_options_test.cpp ${PROJECT_SOURCE_DIR}/client/flag_report.cpp
            ${PROJECT_SOURCE_DIR}/client/options.cpp
            ${PROJECT_SOURCE_DIR}/client/setting_text.cpp
    DEPENDS fieldcast_client_play CLI11::CLI11)

fieldcast_test(client_access_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/client_access_test.cpp
    DEPENDS fieldcast_client_net)

if(TARGET fieldcast-load AND NOT FIELDCAST_SANITIZE MATCHES thread)
    fieldcast_test(printed_text_test LABELS system
        SOURCES ${CMAKE_CURRENT_LIST_DIR}/printed_text_test.cpp
        DEPENDS client_fake_server test_program)
    add_dependencies(printed_text_test fieldcast-server fieldcast-client fieldcast-load)
    target_compile_definitions(printed_text_test PRIVATE FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>"
        FIELDCAST_CLIENT="$<TARGET_FILE:fieldcast-client>" FIELDCAST_LOAD="$<TARGET_FILE:fieldcast-load>")
endif()

fieldcast_test(security_process_test LABELS gpu system TIMEOUT 300
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/security_process_test.cpp
    DEPENDS certificate_authority test_program)
add_dependencies(security_process_test fieldcast-server fieldcast-client)
target_compile_definitions(security_process_test PRIVATE
    FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>" FIELDCAST_CLIENT="$<TARGET_FILE:fieldcast-client>")

fieldcast_test(roundtrip_test LABELS system TIMEOUT 600
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/roundtrip_test.cpp
    DEPENDS test_program fieldcast_gpu fieldcast_image)
add_dependencies(roundtrip_test fieldcast-server fieldcast-client)
target_compile_definitions(roundtrip_test PRIVATE
    FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>" FIELDCAST_CLIENT="$<TARGET_FILE:fieldcast-client>")

find_package(Python3 REQUIRED COMPONENTS Interpreter)
# Bad networks: the imitated one, and the real one where the kernel has netem and we are root; else it says why and skips.
add_test(NAME relay_test COMMAND Python3::Interpreter -B bench/network/relay_test.py
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
set_tests_properties(relay_test PROPERTIES LABELS quick TIMEOUT 120)
if(NOT FIELDCAST_SANITIZE) # it measures latency
    add_test(NAME netem_test COMMAND Python3::Interpreter -B bench/network/networks.py --programs ${CMAKE_BINARY_DIR}
        --method netem --seconds 20 --size 160x90 --client-flags "--grid 2x2 --patience 60"
        WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(netem_test PROPERTIES LABELS system TIMEOUT 900 SKIP_RETURN_CODE 77 RUN_SERIAL ON)
endif()
