// SPDX-License-Identifier: Apache-2.0
#include "server/service/grpc_server.h"
#include "tests/server/server_client.h"
#include "tests/server/synthetic.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace fieldcast::test {
namespace {

class Catalog : public testing::Test {
protected:
    Catalog() { context_.set_deadline(std::chrono::system_clock::now() + kCallDeadline); }

    /// Everything that FetchScene sends, checking that chunks follow each other.
    grpc::Status fetch(const std::string& hash, std::uint64_t offset, std::string& bytes) {
        v1::FetchSceneRequest request;
        request.set_scene_hash(hash);
        request.set_offset(offset);
        const auto reader = stub_->FetchScene(&context_, request);
        v1::SceneChunk chunk;
        while (reader->Read(&chunk)) {
            EXPECT_EQ(chunk.offset(), offset + bytes.size());
            EXPECT_EQ(chunk.total_bytes(), bundle().size());
            EXPECT_LE(chunk.data().size(), 1U << 20);
            bytes += chunk.data();
        }
        return reader->Finish();
    }

    const std::vector<std::byte>& bundle() const { return *feed_->info().bundle; }

    bool is_bundle_from(std::uint64_t offset, const std::string& bytes) const {
        const auto rest = std::span(bundle()).subspan(offset);
        return std::ranges::equal(rest, std::as_bytes(std::span(bytes)));
    }

    const std::string hash_ = std::string(32, '\xAB');
    std::shared_ptr<feed::Feed> feed_ = std::make_shared<feed::Feed>(synthetic_info());
    service::GrpcServer server_{{.host = "127.0.0.1", .port = 0}, {feed_}, {}};
    std::unique_ptr<v1::Catalog::Stub> stub_ = v1::Catalog::NewStub(connect(server_.port()));
    grpc::ClientContext context_;
};

TEST_F(Catalog, TellsWhatItOffersAndItsLimits) {
    v1::GetServerInfoResponse info;
    ASSERT_TRUE(stub_->GetServerInfo(&context_, {}, &info).ok());
    EXPECT_FALSE(info.version().empty());
    ASSERT_EQ(info.modes_size(), 3);
    EXPECT_EQ(info.modes(0), v1::DELIVERY_MODE_VIEWS);
    EXPECT_EQ(info.modes(1), v1::DELIVERY_MODE_SCENE);
    EXPECT_EQ(info.modes(2), v1::DELIVERY_MODE_WARP);
    EXPECT_EQ(info.limits().max_views(), 72U);
    EXPECT_EQ(info.limits().max_view_width_px(), 64U);
}

TEST_F(Catalog, ListsChannels) {
    v1::ListChannelsResponse list;
    ASSERT_TRUE(stub_->ListChannels(&context_, {}, &list).ok());
    ASSERT_EQ(list.channels_size(), 1);
    const v1::Channel& channel = list.channels(0);
    EXPECT_EQ(channel.name(), "synthetic");
    EXPECT_EQ(channel.scene_hash(), hash_);
    EXPECT_EQ(channel.largest_grid().rows(), 6U);
    EXPECT_EQ(channel.guard_band().right_px(), 3U);
    EXPECT_EQ(channel.cameras(0).control(), v1::CAMERA_CONTROL_FIXED);
}

TEST_F(Catalog, FetchesABundle) {
    std::string bytes;
    ASSERT_TRUE(fetch(hash_, 0, bytes).ok());
    EXPECT_TRUE(is_bundle_from(0, bytes));
}

TEST_F(Catalog, ResumesABundle) {
    std::string bytes;
    ASSERT_TRUE(fetch(hash_, 1'234'567, bytes).ok());
    EXPECT_TRUE(is_bundle_from(1'234'567, bytes));
}

TEST_F(Catalog, SaysThatABundleIsComplete) {
    std::string bytes;
    ASSERT_TRUE(fetch(hash_, bundle().size(), bytes).ok());
    EXPECT_TRUE(bytes.empty());
}

TEST_F(Catalog, RefusesOffsetsBeyondTheEnd) {
    std::string bytes;
    EXPECT_EQ(fetch(hash_, bundle().size() + 1, bytes).error_code(), grpc::StatusCode::OUT_OF_RANGE);
}

TEST_F(Catalog, RefusesUnknownScenes) {
    std::string bytes;
    EXPECT_EQ(fetch(std::string(32, 'x'), 0, bytes).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(Catalog, RefusesHashesOfAnotherLength) {
    std::string bytes;
    EXPECT_EQ(fetch("short", 0, bytes).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

} // namespace
} // namespace fieldcast::test
