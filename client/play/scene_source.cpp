// SPDX-License-Identifier: Apache-2.0
#include "client/play/scene_source.h"

#include "client/net/catalog.h"
#include "client/play/attempts.h"
#include "client/play/scene_cache.h"
#include "core/base/log.h"
#include "core/base/printable.h"
#include "core/scene/gltf/loader.h"

#include <algorithm>

namespace fieldcast::client::play {
namespace {

scene::SceneHash hash_of_channel(const std::vector<net::ChannelInfo>& channels, const std::string& name) {
    if (name.empty()) {
        return channels.front().scene_hash;
    }
    const auto found = std::find_if(channels.begin(), channels.end(),
                                    [&](const net::ChannelInfo& channel) { return channel.name == name; });
    if (found == channels.end()) {
        throw UserError("the server has no channel '" + name + "'; its first is '" +
                        printable(channels.front().name) + "'");
    }
    return found->scene_hash;
}

/// Repeats `attempt` until it succeeds, fails permanently, or patience ends.
template <class Attempt> auto persistently(const ServerOptions& server, const std::stop_token& stop, Attempt attempt) {
    Attempts attempts(server.reconnects, server.patience);
    while (true) {
        try {
            return attempt(net::Connection(server.address, server.access));
        } catch (const net::NetError& error) {
            if (!error.is_transient() || !attempts.wait_for_next(stop, error.obstacle())) {
                throw;
            }
            log::debug("trying again", {{"reason", error.what()}});
        }
    }
}

scene::Scene load_cached(SceneCache& cache, const scene::SceneHash& hash, const FetchBundle& fetch,
                         const std::stop_token& stop) {
    const scene::UnpackedBundle unpacked = cache.get(hash, fetch, stop);
    scene::Scene scene = scene::load_scene(unpacked.file, unpacked.options);
    if (scene.hash != hash) {
        throw UserError("the cached scene is not the one that was fetched");
    }
    return scene;
}

} // namespace

scene::Scene obtain_scene(const ServerOptions& server, const std::string& channel,
                          const std::filesystem::path& cache_folder, const std::stop_token& stop) {
    const scene::SceneHash hash = persistently(server, stop, [&](const net::Connection& connection) {
        return hash_of_channel(net::list_channels(connection), channel);
    });
    SceneCache cache(cache_folder);
    // An interrupted transfer leaves its bytes in the cache, so the next attempt fetches only the rest.
    const FetchBundle fetch = [&](const scene::SceneHash& wanted, std::uint64_t offset, const TakePiece& take) {
        const net::Connection connection(server.address, server.access);
        net::fetch_scene(
            connection, wanted, offset, [&](const net::BundlePiece& piece) { take(piece.total_bytes, piece.bytes); },
            stop);
    };
    const auto load = [&](const net::Connection&) { return load_cached(cache, hash, fetch, stop); };
    try {
        return persistently(server, stop, load);
    } catch (const UserError& error) {
        log::warn("cached scene is damaged; fetching it again", {{"reason", error.what()}});
        cache.forget(hash);
        return persistently(server, stop, load);
    }
}

} // namespace fieldcast::client::play
