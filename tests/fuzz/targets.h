// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

// What is fuzzed: everything that reads bytes from outside. A target takes any bytes. It fails by a crash, by what a
// sanitizer says, by an exception, or by taking too long or too much memory.
namespace fieldcast::fuzz {

using Bytes = std::span<const std::byte>;

struct Target {
    std::string_view name; ///< of its file, and of its folder in tests/fuzz/corpus
    void (*run)(Bytes input);
};

std::span<const Target> all_targets();
const Target* find_target(std::string_view name); ///< null: there is none

void bundle(Bytes input);         ///< core/scene/bundle: what a server sends as a scene
void cache_entry(Bytes input);    ///< client/play/cache_entry: a file that other programs may have changed
void client_message(Bytes input); ///< server/session: what clients send
void config(Bytes input);         ///< server/command_line/config_file
void environment(Bytes input);    ///< core/scene/environment: .hdr and .exr
void frame(Bytes input);          ///< core/wire: chunks of frames, in any order
void gltf(Bytes input);           ///< core/scene/gltf_loader
void http_request(Bytes input);   ///< server/web/request_reader
void image(Bytes input);          ///< core/image/image_file: PNG, JPEG, WebP
void metrics_page(Bytes input);   ///< client/load/metrics_page: what a server tells about itself
void recording(Bytes input);      ///< server/recording: files that a server is told to replay
void scenario(Bytes input);       ///< client/load/scenario_file
void server_message(Bytes input); ///< client/net/configure, clock_sync: what servers send
void strip(Bytes input);          ///< core/codec: strips of every codec
void token(Bytes input);          ///< server/access/token_list, core/base/bearer_token
void uri(Bytes input);            ///< core/scene/uri, core/base/host_port, client/net/access: paths and addresses

} // namespace fieldcast::fuzz
