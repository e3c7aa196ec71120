// SPDX-License-Identifier: Apache-2.0
// Ends gRPC before a test program does: its threads would otherwise run on into the end of the process, where what they
// still hold (of OpenSSL, say) looks like a leak.
#include <grpc/grpc.h>
#include <gtest/gtest.h>

namespace fieldcast::test {
namespace {

class GrpcEnd : public testing::Environment {
public:
    void SetUp() override { grpc_init(); } // so that the last object of a test does not end it in a thread of its own
    void TearDown() override { grpc_shutdown_blocking(); }
};

[[maybe_unused]] testing::Environment* const kGrpcEnd = testing::AddGlobalTestEnvironment(new GrpcEnd);

} // namespace
} // namespace fieldcast::test
