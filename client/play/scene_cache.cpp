// SPDX-License-Identifier: Apache-2.0
#include "client/play/scene_cache.h"

#include "client/net/net_error.h"
#include "client/play/cache_entry.h"
#include "core/base/log.h"

#include <cerrno>
#include <condition_variable>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <mutex>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace fieldcast::client::play {
namespace {

namespace fs = std::filesystem;
using std::chrono_literals::operator""ms;

[[noreturn]] void throw_errno(const std::string& what) {
    throw std::system_error(errno, std::generic_category(), what);
}

/// An exclusive lock between processes, held during the lifetime of this. The kernel releases it when a process dies.
class FolderLock {
public:
    FolderLock(const fs::path& file, const std::stop_token& stop)
        : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
        if (descriptor_ < 0) {
            throw_errno(file.string());
        }
        // A stop request could not interrupt a blocking flock(), so try again every 50 ms.
        std::mutex mutex;
        std::condition_variable_any stopped;
        std::unique_lock lock(mutex);
        while (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
            if (errno != EWOULDBLOCK && errno != EINTR) {
                throw_errno(file.string());
            }
            if (stopped.wait_for(lock, stop, 50ms, [&] { return stop.stop_requested(); })) {
                ::close(descriptor_);
                throw std::system_error(std::make_error_code(std::errc::operation_canceled), "waiting for a scene");
            }
        }
    }
    ~FolderLock() { ::close(descriptor_); }
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int descriptor_;
};

/// The received part of a bundle, on disk.
class PartFile {
public:
    explicit PartFile(fs::path file) : file_(std::move(file)) {}

    std::uint64_t size() const {
        std::error_code missing;
        const auto bytes = fs::file_size(file_, missing);
        return missing ? 0 : bytes;
    }

    /// Appends the bytes from `fetch`. If `fetch` throws, the bytes received so far stay on disk.
    void complete(const scene::SceneHash& hash, const FetchBundle& fetch) {
        std::ofstream out(file_, std::ios::binary | std::ios::app);
        std::uint64_t arrived = size();
        fetch(hash, arrived, [&](std::uint64_t total_bytes, std::span<const std::byte> piece) {
            if (total_bytes > SceneCache::kMaxBundleBytes ||
                piece.size() > total_bytes - std::min(total_bytes, arrived)) {
                throw net::NetError("scene of " + std::to_string(total_bytes >> 20) + " MiB, at most " +
                                        std::to_string(SceneCache::kMaxBundleBytes >> 20) + " MiB",
                                    false);
            }
            out.write(reinterpret_cast<const char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
            arrived += piece.size();
        });
        out.close();
        if (!out) {
            throw std::system_error(std::make_error_code(std::errc::io_error), file_.string());
        }
    }

    std::vector<std::byte> read() const {
        std::vector<std::byte> bytes(size());
        std::ifstream in(file_, std::ios::binary);
        in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        if (!in) {
            throw std::system_error(std::make_error_code(std::errc::io_error), file_.string());
        }
        return bytes;
    }

    void remove() const {
        std::error_code ignored;
        fs::remove(file_, ignored);
    }

private:
    fs::path file_;
};

/// Fetches the rest of the bundle. Removes the part file after any error but an interrupted transfer.
std::vector<std::byte> fetch_rest(const scene::SceneHash& hash, PartFile& part, const FetchBundle& fetch) {
    try {
        part.complete(hash, fetch);
        std::vector<std::byte> bundle = part.read();
        if (scene::hash_bundle(bundle) == hash) {
            return bundle;
        }
        throw net::NetError("the server sent another bundle than that of scene " + scene::to_hex(hash), false);
    } catch (const net::NetError& error) {
        if (!error.is_transient()) {
            part.remove();
        }
        throw;
    }
}

std::vector<std::byte> fetch_verified(const scene::SceneHash& hash, const fs::path& part_file,
                                      const FetchBundle& fetch) {
    PartFile part(part_file);
    const bool resumes = part.size() > 0;
    try {
        return fetch_rest(hash, part, fetch);
    } catch (const net::NetError& error) {
        if (!resumes || error.is_transient()) {
            throw;
        }
        log::warn("partial scene is unusable; fetching the scene again", {{"hash", scene::to_hex(hash)}});
        return fetch_rest(hash, part, fetch);
    }
}

/// Unpacks into a temporary folder and renames it, so that `target` appears complete or not at all.
void unpack_into(const fs::path& target, std::span<const std::byte> bundle) {
    std::string name = target.string() + ".XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) {
        throw_errno(name);
    }
    const fs::path folder(name);
    try {
        const Decoded<scene::UnpackedBundle> unpacked = scene::unpack_bundle(bundle, folder);
        if (!unpacked) {
            throw net::NetError("scene bundle refused: " + unpacked.error().message, false);
        }
        write_cache_entry(folder, *unpacked);
        fs::rename(folder, target);
    } catch (...) {
        std::error_code ignored;
        fs::remove_all(folder, ignored);
        throw;
    }
}

} // namespace

SceneCache::SceneCache(fs::path folder) : folder_(std::move(folder)) {
    fs::create_directories(folder_);
}

fs::path SceneCache::default_folder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache == '/') {
        return fs::path(cache) / "fieldcast";
    }
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
        return fs::path(home) / ".cache" / "fieldcast";
    }
    throw UserError("no folder for the scene cache: neither XDG_CACHE_HOME nor HOME is set; use --cache");
}

scene::UnpackedBundle SceneCache::get(const scene::SceneHash& hash, const FetchBundle& fetch,
                                      const std::stop_token& stop) {
    const fs::path target = folder_ / scene::to_hex(hash);
    if (auto entry = read_cache_entry(target)) {
        return *entry;
    }
    const FolderLock lock(target.string() + ".lock", stop);
    if (auto entry = read_cache_entry(target)) { // another process fetched it while we waited
        return *entry;
    }
    const fs::path part_file = target.string() + ".part";
    const std::vector<std::byte> bundle = fetch_verified(hash, part_file, fetch);
    fs::remove_all(target); // it has no valid entry
    unpack_into(target, bundle);
    PartFile(part_file).remove();
    log::info("scene cached", {{"hash", scene::to_hex(hash)}, {"bytes", bundle.size()}});
    if (auto entry = read_cache_entry(target)) {
        return *entry;
    }
    throw std::system_error(std::make_error_code(std::errc::io_error), target.string());
}

void SceneCache::forget(const scene::SceneHash& hash) {
    const fs::path target = folder_ / scene::to_hex(hash);
    const FolderLock lock(target.string() + ".lock", {});
    fs::remove_all(target);
}

} // namespace fieldcast::client::play
