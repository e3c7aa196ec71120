// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/scene/bundle.h"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <stop_token>

namespace fieldcast::client::play {

/// Receives bytes of a bundle in order. The first call may come with any `total_bytes`; it must not change.
using TakePiece = std::function<void(std::uint64_t total_bytes, std::span<const std::byte> piece)>;

/// Fetches the bundle of `hash` from `offset` on; returns when it is complete, throws when it is not.
using FetchBundle = std::function<void(const scene::SceneHash& hash, std::uint64_t offset, const TakePiece& take)>;

/// Scenes fetched from servers, one folder per scene hash:
///
///     HASH/        the unpacked scene; appears complete, by one rename
///     HASH.part    what has arrived of a bundle; a later transfer resumes behind it
///     HASH.lock    held by the process that fetches, so that others wait and then find the scene
///     HASH.XXXXXX  being unpacked; left over only if the process was killed
class SceneCache {
public:
    /// Creates `folder`. Throws std::system_error.
    explicit SceneCache(std::filesystem::path folder);

    /// $XDG_CACHE_HOME/fieldcast, or ~/.cache/fieldcast.
    static std::filesystem::path default_folder();

    /// Where the scene lies; fetches it if it is not here. Nothing that fails the SHA-256 check is unpacked.
    /// Throws what `fetch` throws, net::NetError for a bundle that is refused, std::system_error for the disk.
    scene::UnpackedBundle get(const scene::SceneHash& hash, const FetchBundle& fetch, const std::stop_token& stop);

    /// Forgets a scene whose files were changed behind our back.
    void forget(const scene::SceneHash& hash);

    static constexpr std::uint64_t kMaxBundleBytes = 1ULL << 30;

private:
    std::filesystem::path folder_;
};

} // namespace fieldcast::client::play
