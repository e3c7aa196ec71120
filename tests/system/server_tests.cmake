# SPDX-License-Identifier: Apache-2.0
# The server without Vulkan: synthetic channels stand in for rendered ones.
add_library(server_synthetic STATIC ${CMAKE_CURRENT_LIST_DIR}/server_synthetic.cpp)
target_include_directories(server_synthetic PUBLIC ${PROJECT_SOURCE_DIR}/tests/system)
target_link_libraries(server_synthetic PUBLIC fieldcast_server_feed PRIVATE fieldcast_warnings)

fieldcast_test(server_session_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_feed_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_negotiate_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_session_test.cpp
    DEPENDS server_synthetic fieldcast_server_session)
fieldcast_test(server_flags_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_config_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_flags_test.cpp
    DEPENDS fieldcast_server_ops)
find_package(OpenSSL REQUIRED)
add_library(certificate_authority STATIC ${CMAKE_CURRENT_LIST_DIR}/certificate_authority.cpp)
target_include_directories(certificate_authority PUBLIC ${PROJECT_SOURCE_DIR}/tests/system)
target_link_libraries(certificate_authority PRIVATE OpenSSL::Crypto GTest::gtest fieldcast_warnings)
fieldcast_test(server_access_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_access_test.cpp
    DEPENDS certificate_authority fieldcast_server_access)
fieldcast_test(server_channel_test LABELS quick
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_clock_test.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_encoder_test.cpp
    DEPENDS fieldcast_server_channel)
# Not under the thread sanitizer: the distribution's gRPC is built without it, so every handover between its threads looks
# like a race. What the server's own threads share is in server_session_test.
if(NOT FIELDCAST_SANITIZE MATCHES thread)
    fieldcast_test(server_service_test LABELS quick
        SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_catalog_test.cpp
                ${CMAKE_CURRENT_LIST_DIR}/server_client.cpp
                ${CMAKE_CURRENT_LIST_DIR}/server_service_test.cpp
        DEPENDS server_synthetic fieldcast_server_service)
    fieldcast_test(server_security_test LABELS quick
        SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_client.cpp
                ${CMAKE_CURRENT_LIST_DIR}/server_security_test.cpp
        DEPENDS certificate_authority server_synthetic fieldcast_server_service)
endif()

# Renders; the tests that need a device skip without one.
fieldcast_test(server_process_test LABELS gpu TIMEOUT 300
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/server_client.cpp
            ${CMAKE_CURRENT_LIST_DIR}/server_process_test.cpp
    DEPENDS fieldcast_proto_grpc)
target_include_directories(server_process_test PRIVATE ${PROJECT_SOURCE_DIR}/tests/system)
target_compile_definitions(server_process_test PRIVATE FIELDCAST_SERVER="$<TARGET_FILE:fieldcast-server>")
add_dependencies(server_process_test fieldcast-server)
