// SPDX-License-Identifier: Apache-2.0
#include "client/net/connection.h"
#include "client/play/cache_entry.h"
#include "client/play/scene_cache.h"
#include "tests/fixtures/test_folder.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <thread>

namespace fieldcast::test {
namespace {

using client::net::NetError;
using client::play::SceneCache;
using client::play::TakePiece;

namespace fs = std::filesystem;

constexpr const char* kSceneText = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]})";

class SceneCacheTest : public testing::Test {
protected:
    SceneCacheTest() {
        fs::create_directories(folder_ / "made");
        std::ofstream(folder_ / "made" / "empty.gltf") << kSceneText;
        options_.sky = {0.1F, 0.2F, 0.3F};
        bundle_ = scene::make_bundle(folder_ / "made" / "empty.gltf", options_);
        hash_ = scene::hash_bundle(bundle_);
    }

    /// Delivers `bundle` from `offset` on, byte by byte; the line is cut after `cut_after` bytes.
    void deliver(std::span<const std::byte> bundle, std::uint64_t offset, const TakePiece& take,
                 std::uint64_t cut_after = UINT64_MAX) {
        ++transfers_;
        for (std::uint64_t i = offset; i < bundle.size(); ++i) {
            if (i - offset == cut_after) {
                throw NetError("cut", true);
            }
            take(bundle.size(), bundle.subspan(i, 1));
        }
    }

    client::play::FetchBundle whole() {
        return [this](const scene::SceneHash&, std::uint64_t offset, const TakePiece& take) {
            deliver(bundle_, offset, take);
        };
    }

    fs::path cache_folder() const { return folder_ / "cache"; }
    fs::path cached(const std::string& suffix = "") const { return cache_folder() / (scene::to_hex(hash_) + suffix); }

    const test::TestFolder own_;
    const fs::path folder_ = own_ / "cache";
    scene::LoadOptions options_;
    std::vector<std::byte> bundle_;
    scene::SceneHash hash_{};
    std::atomic<int> transfers_ = 0;
};

TEST_F(SceneCacheTest, FetchesOnceAndKeepsTheOptions) {
    SceneCache cache(cache_folder());
    cache.get(hash_, whole(), {});
    const scene::UnpackedBundle again = cache.get(hash_, whole(), {});
    EXPECT_EQ(transfers_, 1);
    EXPECT_EQ(again.options.sky, options_.sky);
    EXPECT_EQ(scene::hash_bundle(scene::make_bundle(again.file, again.options)), hash_);
    EXPECT_FALSE(fs::exists(cached(".part")));
}

TEST_F(SceneCacheTest, ResumesWhereATransferWasCut) {
    SceneCache cache(cache_folder());
    const auto cut = [this](const scene::SceneHash&, std::uint64_t offset, const TakePiece& take) {
        deliver(bundle_, offset, take, 20);
    };
    EXPECT_THROW(cache.get(hash_, cut, {}), NetError);
    EXPECT_EQ(fs::file_size(cached(".part")), 20U);
    std::uint64_t resumed_at = 0;
    const auto rest = [&](const scene::SceneHash&, std::uint64_t offset, const TakePiece& take) {
        resumed_at = offset;
        deliver(bundle_, offset, take);
    };
    cache.get(hash_, rest, {});
    EXPECT_EQ(resumed_at, 20U);
    EXPECT_TRUE(fs::exists(cached("/entry.json")));
}

TEST_F(SceneCacheTest, ReplacesADamagedPart) {
    SceneCache cache(cache_folder());
    std::ofstream(cached(".part")) << "rubbish";
    cache.get(hash_, whole(), {});
    EXPECT_EQ(transfers_, 2); // the rest, then everything
    EXPECT_TRUE(fs::exists(cached("/entry.json")));
}

TEST_F(SceneCacheTest, ReplacesAPartThatIsLongerThanTheBundle) {
    SceneCache cache(cache_folder());
    std::ofstream(cached(".part")) << std::string(bundle_.size() + 1, 'x');
    const auto like_a_server = [this](const scene::SceneHash&, std::uint64_t offset, const TakePiece& take) {
        if (offset > bundle_.size()) {
            throw NetError("OUT_OF_RANGE", false);
        }
        deliver(bundle_, offset, take);
    };
    cache.get(hash_, like_a_server, {});
    EXPECT_TRUE(fs::exists(cached("/entry.json")));
}

TEST_F(SceneCacheTest, RefusesWhatHasAnotherHash) {
    SceneCache cache(cache_folder());
    bundle_.back() ^= std::byte{1};
    EXPECT_THROW(cache.get(hash_, whole(), {}), NetError);
    EXPECT_FALSE(fs::exists(cached()));
    EXPECT_FALSE(fs::exists(cached(".part")));
}

TEST_F(SceneCacheTest, RefusesABundleThatIsNone) {
    SceneCache cache(cache_folder());
    bundle_.assign(100, std::byte{0xFF}); // the hash is right, the content is not
    hash_ = scene::hash_bundle(bundle_);
    EXPECT_THROW(cache.get(hash_, whole(), {}), NetError);
    const auto left_over = std::count_if(fs::directory_iterator(cache_folder()), fs::directory_iterator(),
                                         [](const fs::directory_entry& entry) { return entry.is_directory(); });
    EXPECT_EQ(left_over, 0);
}

TEST_F(SceneCacheTest, RefusesABundleThatIsTooLarge) {
    SceneCache cache(cache_folder());
    const auto boast = [](const scene::SceneHash&, std::uint64_t, const TakePiece& take) {
        take(SceneCache::kMaxBundleBytes + 1, std::vector<std::byte>(1));
    };
    EXPECT_THROW(cache.get(hash_, boast, {}), NetError);
}

TEST_F(SceneCacheTest, ConcurrentClientsFetchOnce) {
    std::vector<std::jthread> clients;
    std::atomic<int> successes = 0;
    for (int i = 0; i < 4; ++i) {
        clients.emplace_back([&] {
            SceneCache cache(cache_folder());
            successes += fs::exists(cache.get(hash_, whole(), {}).file) ? 1 : 0;
        });
    }
    clients.clear();
    EXPECT_EQ(successes, 4);
    EXPECT_EQ(transfers_, 1);
}

TEST_F(SceneCacheTest, ForgetsAScene) {
    SceneCache cache(cache_folder());
    cache.get(hash_, whole(), {});
    cache.forget(hash_);
    EXPECT_FALSE(fs::exists(cached()));
    cache.get(hash_, whole(), {});
    EXPECT_EQ(transfers_, 2);
}

TEST_F(SceneCacheTest, DistrustsAnEntryThatPointsOutside) {
    for (const char* file : {"../made/empty.gltf", "/etc/passwd", ""}) {
        std::ofstream(folder_ / "entry.json") << R"({"file": ")" << file << R"(", "sky": [0, 0, 0]})";
        EXPECT_FALSE(client::play::read_cache_entry(folder_)) << file;
    }
    std::ofstream(folder_ / "entry.json") << R"({"file": "a.gltf", "sky": [0, 0, "x"]})";
    EXPECT_FALSE(client::play::read_cache_entry(folder_));
    std::ofstream(folder_ / "entry.json") << "{";
    EXPECT_FALSE(client::play::read_cache_entry(folder_));
}

} // namespace
} // namespace fieldcast::test
