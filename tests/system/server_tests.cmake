# SPDX-License-Identifier: Apache-2.0
# The server without Vulkan: synthetic channels stand in for rendered ones.
add_library(server_synthetic STATIC ${CMAKE_CURRENT_LIST_DIR}/server_synthetic.cpp)
target_include_directories(server_synthetic PUBLIC ${PROJECT_SOURCE_DIR}/tests/system)
target_link_libraries(server_synthetic PUBLIC fieldcast_server_feed PRIVATE fieldcast_warnings)
add_library(server_client STATIC ${CMAKE_CURRENT_LIST_DIR}/server_client.cpp)
target_include_directories(server_client PUBLIC ${PROJECT_SOURCE_DIR}/tests/system)
target_link_libraries(server_client PUBLIC fieldcast_proto_grpc PRIVATE fieldcast_warnings INTERFACE grpc_end)

fieldcast_test(server_session_test LABELS quick tsan
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_adaptation_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_budget_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_credits_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_demand_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_feed_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_field_limits_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_negotiate_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_session_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_steering_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_timings_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_view_memory_test.cpp
    DEPENDS server_synthetic fieldcast_server_session)
fieldcast_test(server_own_camera_test LABELS quick tsan
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_own_camera_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_own_session_test.cpp
    DEPENDS server_synthetic fieldcast_server_camera fieldcast_server_session)
fieldcast_test(server_recording_test LABELS quick tsan
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_golden_recording_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_recorded_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_recording_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_replay_session_test.cpp
    DEPENDS server_synthetic fieldcast_server_recording fieldcast_server_session)

# Writes tests/data/recordings/v1.fcrec; run once per version of the file format, never to make a failing test pass.
add_executable(make_golden_recording ${CMAKE_CURRENT_LIST_DIR}/make_golden_recording.cpp)
target_link_libraries(make_golden_recording PRIVATE server_synthetic fieldcast_server_recording fieldcast_warnings)

fieldcast_test(server_flags_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_config_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_flags_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_inspect_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_protocol_page_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_typos_test.cpp
    DEPENDS fieldcast_server_ops nlohmann_json::nlohmann_json)
find_package(OpenSSL REQUIRED)
add_library(certificate_authority STATIC ${CMAKE_CURRENT_LIST_DIR}/certificate_authority.cpp)
target_include_directories(certificate_authority PUBLIC ${PROJECT_SOURCE_DIR}/tests/system)
target_link_libraries(certificate_authority PRIVATE OpenSSL::Crypto GTest::gtest fieldcast_warnings)
fieldcast_test(server_access_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_access_test.cpp
    DEPENDS certificate_authority fieldcast_server_access)
add_library(http_client STATIC ${CMAKE_CURRENT_LIST_DIR}/http_client.cpp)
target_include_directories(http_client PUBLIC ${PROJECT_SOURCE_DIR}/tests/system)
target_link_libraries(http_client PRIVATE OpenSSL::SSL OpenSSL::Crypto fieldcast_warnings)
fieldcast_test(server_listener_test LABELS quick tsan
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_listener_test.cpp
    DEPENDS fieldcast_server_listener)
target_include_directories(server_listener_test PRIVATE ${CMAKE_CURRENT_LIST_DIR})
fieldcast_test(server_metrics_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_metrics_test.cpp
    DEPENDS fieldcast_server_metrics)
fieldcast_test(server_web_test LABELS quick tsan
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_request_reader_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_slow_callers_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_web_test.cpp
    DEPENDS certificate_authority http_client fieldcast_server_web)
fieldcast_test(server_channel_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_clock_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_encoder_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_turns_test.cpp
    DEPENDS fieldcast_server_channel)
# Not under the thread sanitizer: the distribution's gRPC is built without it, so every handover between its threads looks
# like a race. What the server's own threads share is in the tests with the label tsan.
if(NOT FIELDCAST_SANITIZE MATCHES thread)
    fieldcast_test(server_service_test LABELS quick
        SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_catalog_test.cpp
                ${CMAKE_CURRENT_LIST_DIR}/server_observation_test.cpp
                ${CMAKE_CURRENT_LIST_DIR}/server_service_test.cpp
                ${CMAKE_CURRENT_LIST_DIR}/server_steering_service_test.cpp
        DEPENDS server_client server_synthetic fieldcast_server_service)
    fieldcast_test(server_replay_test LABELS quick
        SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_replay_test.cpp
        DEPENDS server_client server_synthetic fieldcast_server_recording fieldcast_server_service)
    fieldcast_test(server_limits_test LABELS quick
        SOURCES ${CMAKE_CURRENT_LIST_DIR}/relay.cpp
                ${CMAKE_CURRENT_LIST_DIR}/served_channel.cpp
                ${CMAKE_CURRENT_LIST_DIR}/server_hostile_test.cpp
                ${CMAKE_CURRENT_LIST_DIR}/server_limits_test.cpp
        DEPENDS http_client server_client server_synthetic fieldcast_server_service)
    fieldcast_test(server_security_test LABELS quick
        SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_security_test.cpp
        DEPENDS certificate_authority server_client server_synthetic fieldcast_server_service)
endif()

# Not a test: what bench/network/networks.py --synthetic measures.
add_executable(synthetic_server ${CMAKE_CURRENT_LIST_DIR}/synthetic_server.cpp)
target_link_libraries(synthetic_server PRIVATE server_synthetic fieldcast_server_service fieldcast_warnings)

# Renders; the tests that need a device skip without one.
fieldcast_test(server_process_test LABELS gpu system TIMEOUT 300
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_process_test.cpp
    DEPENDS server_client test_program fieldcast_wire)
target_compile_definitions(server_process_test PRIVATE FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>")
add_dependencies(server_process_test fieldcast-server)

# Processes: the programs beside the test.
add_library(test_program STATIC ${CMAKE_CURRENT_LIST_DIR}/program.cpp)
target_include_directories(test_program PUBLIC ${PROJECT_SOURCE_DIR}/tests/system)
target_link_libraries(test_program PRIVATE GTest::gtest fieldcast_warnings)
fieldcast_test(descriptor_process_test LABELS system TIMEOUT 300
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/descriptor_process_test.cpp
    DEPENDS http_client test_program)
add_dependencies(descriptor_process_test fieldcast-server)
target_compile_definitions(descriptor_process_test PRIVATE FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>")
add_library(running_server STATIC ${CMAKE_CURRENT_LIST_DIR}/running_server.cpp)
target_link_libraries(running_server PUBLIC test_program http_client server_client PRIVATE GTest::gtest fieldcast_warnings)
find_package(nlohmann_json REQUIRED)
fieldcast_test(operation_process_test LABELS gpu system TIMEOUT 600
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/operation_process_test.cpp
    DEPENDS certificate_authority running_server nlohmann_json::nlohmann_json)
add_dependencies(operation_process_test fieldcast-server fieldcast-client)
target_compile_definitions(operation_process_test PRIVATE
    FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>" FIELDCAST_CLIENT="$<TARGET_FILE:fieldcast-client>")

fieldcast_test(change_process_test LABELS gpu system TIMEOUT 600
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/change_process_test.cpp
    DEPENDS running_server nlohmann_json::nlohmann_json)
add_dependencies(change_process_test fieldcast-server fieldcast-client)
target_compile_definitions(change_process_test PRIVATE
    FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>" FIELDCAST_CLIENT="$<TARGET_FILE:fieldcast-client>")

# Through the proxy of deploy/; skips where it cannot be installed. See tests/deploy.
if(NOT FIELDCAST_SANITIZE MATCHES thread)
    add_executable(envoy_test ${CMAKE_CURRENT_LIST_DIR}/envoy_test.cpp ${CMAKE_CURRENT_LIST_DIR}/served_channel.cpp)
    target_link_libraries(envoy_test PRIVATE certificate_authority http_client server_client test_program server_synthetic
                          fieldcast_server_service fieldcast_warnings GTest::gmock GTest::gtest_main)
    add_dependencies(envoy_test fieldcast-client)
    add_dependencies(tests_system envoy_test)
    target_compile_definitions(envoy_test PRIVATE FIELDCAST_CLIENT="$<TARGET_FILE:fieldcast-client>")
    gtest_discover_tests(envoy_test WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} DISCOVERY_TIMEOUT 60
                         PROPERTIES LABELS system TIMEOUT 180 FIXTURES_REQUIRED envoy)
endif()
fieldcast_test(channels_process_test LABELS gpu system TIMEOUT 600
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/channels_process_test.cpp
    DEPENDS fieldcast_base running_server nlohmann_json::nlohmann_json)
add_dependencies(channels_process_test fieldcast-server fieldcast-client)
target_compile_definitions(channels_process_test PRIVATE
    FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>" FIELDCAST_CLIENT="$<TARGET_FILE:fieldcast-client>")
fieldcast_test(start_process_test LABELS gpu system TIMEOUT 600
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/start_process_test.cpp
    DEPENDS test_program)
add_dependencies(start_process_test fieldcast-server)
target_compile_definitions(start_process_test PRIVATE FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>")
fieldcast_test(own_process_test LABELS gpu TIMEOUT 600
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/own_process_test.cpp
    DEPENDS running_server)
add_dependencies(own_process_test fieldcast-server)
target_compile_definitions(own_process_test PRIVATE FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>")
fieldcast_test(demand_process_test LABELS gpu TIMEOUT 600
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/demand_process_test.cpp
    DEPENDS running_server)
add_dependencies(demand_process_test fieldcast-server)
target_compile_definitions(demand_process_test PRIVATE FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>")
