// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/bundle.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>

namespace fieldcast::client::play {

/// Receives the bytes of a bundle, in order. `total_bytes` is the same in all calls.
using TakePiece = std::function<void(std::uint64_t total_bytes, std::span<const std::byte> piece)>;

/// Fetches the bundle of `hash` from byte `offset` on. Returns when it is complete, throws otherwise.
using FetchBundle = std::function<void(const scene::SceneHash& hash, std::uint64_t offset, const TakePiece& take)>;

/// Scenes fetched from servers, one folder per scene hash:
///
///     HASH/        the unpacked scene; a rename makes it appear complete
///     HASH.part    the received part of a bundle, after which a later transfer resumes
///     HASH.lock    held by the process that fetches the scene; other processes wait and then use that scene
///     HASH.XXXXXX  a scene that is being unpacked; remains only if the process was killed
class SceneCache {
public:
    /// Creates `folder`. Throws std::system_error.
    explicit SceneCache(std::filesystem::path folder);

    /// $XDG_CACHE_HOME/fieldcast, or ~/.cache/fieldcast.
    static std::filesystem::path default_folder();

    /// The files of the scene, which it fetches if they are not in the cache. Unpacks only bundles that pass the
    /// SHA-256 check. Throws what `fetch` throws, net::NetError for a bad bundle, std::system_error for disk errors.
    scene::UnpackedBundle get(const scene::SceneHash& hash, const FetchBundle& fetch, const std::stop_token& stop);

    /// Removes a scene whose files another program has changed.
    void forget(const scene::SceneHash& hash);

    static constexpr std::uint64_t kMaxBundleBytes = 1ULL << 30;

private:
    std::filesystem::path folder_;
};

} // namespace fieldcast::client::play
