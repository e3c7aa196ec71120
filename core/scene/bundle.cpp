// SPDX-License-Identifier: Apache-2.0
// The bundle, all integers little endian:
//
//     8 bytes "FCBUNDLE"   u32 version = 1
//     3 × f32 sky          zeros when there is an environment image
//     path    glTF file
//     path    environment image; length 0: none
//     u32     file count
//     per file, sorted by the bytes of the path:  path, u64 size, bytes
//
// where `path` is a u16 length and that many bytes, relative to the scene's folder.
#include "core/scene/bundle.h"

#include "core/scene/environment.h"
#include "core/scene/gltf/document.h"
#include "core/scene/uri.h"

#include <bit>
#include <fstream>
#include <functional>
#include <memory>
#include <openssl/evp.h>
#include <set>
#include <system_error>

namespace fieldcast::scene {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kMagic = "FCBUNDLE";
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMaxFiles = 1U << 16;

using Sink = std::function<void(std::span<const std::byte>)>;

template <class T> void write_integer(const Sink& sink, T value) {
    std::array<std::byte, sizeof(T)> bytes;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
        bytes[i] = static_cast<std::byte>(value >> (8 * i) & 0xFFU);
    }
    sink(bytes);
}

void write_path(const Sink& sink, const std::string& path) {
    write_integer(sink, static_cast<std::uint16_t>(path.size()));
    sink(std::as_bytes(std::span(path)));
}

void write_bundle(const SceneFiles& files, const LoadOptions& options, const Sink& sink) {
    sink(std::as_bytes(std::span(kMagic)));
    write_integer(sink, kVersion);
    const glm::vec3 sky = files.environment.empty() ? options.sky : glm::vec3(0.0F);
    check_sky(sky);
    for (int i = 0; i < 3; ++i) {
        write_integer(sink, std::bit_cast<std::uint32_t>(sky[i] + 0.0F)); // −0 and 0 are the same sky
    }
    write_path(sink, files.main);
    write_path(sink, files.environment);
    write_integer(sink, static_cast<std::uint32_t>(files.bytes.size()));
    for (const auto& [path, bytes] : files.bytes) {
        write_path(sink, path);
        write_integer(sink, static_cast<std::uint64_t>(bytes.size()));
        sink(bytes);
    }
}

class Sha256 {
public:
    Sha256() : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free) {
        check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
    }
    void add(std::span<const std::byte> bytes) {
        check(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
    }
    SceneHash finish() {
        SceneHash hash{};
        unsigned size = 0;
        check(EVP_DigestFinal_ex(context_.get(), hash.data(), &size) == 1 && size == hash.size());
        return hash;
    }

private:
    static void check(bool is_ok) { FC_ASSERT(is_ok, "SHA-256 is not available"); }

    std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

/// Reads a bundle front to back. After the first failure all values are zero, and `error` holds the reason.
class BundleReader {
public:
    explicit BundleReader(std::span<const std::byte> bytes) : rest_(bytes) {}

    std::span<const std::byte> take(std::uint64_t size, const char* what) {
        if (size > rest_.size()) {
            fail(std::string("bundle: truncated at ") + what);
            return {};
        }
        const auto taken = rest_.first(size);
        rest_ = rest_.subspan(size);
        return taken;
    }
    template <class T> T take_integer(const char* what) {
        T value = 0;
        unsigned shift = 0;
        for (const std::byte byte : take(sizeof(T), what)) {
            value = static_cast<T>(value | static_cast<T>(static_cast<T>(byte) << shift));
            shift += 8;
        }
        return value;
    }
    /// Reads a path; its only valid form is the shortest one.
    std::string take_path(const char* what) {
        const auto bytes = take(take_integer<std::uint16_t>(what), what);
        const std::string path(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        if (error.empty() && !path.empty()) {
            const Decoded<std::string> checked = check_relative_path(path);
            if (!checked || *checked != path) {
                fail("bundle: " +
                     (checked ? std::string("path is not in its shortest form") : checked.error().message));
            }
        }
        return path;
    }
    void fail(std::string message) {
        if (error.empty()) {
            error = std::move(message);
        }
        rest_ = {};
    }
    bool is_at_end() const { return rest_.empty(); }

    std::string error;

private:
    std::span<const std::byte> rest_;
};

struct BundleEntry {
    std::string path;
    std::span<const std::byte> bytes;
};

struct BundleContents {
    glm::vec3 sky{0.0F};
    std::string main;
    std::string environment;
    std::vector<BundleEntry> entries;
};

void read_entries(BundleReader& reader, BundleContents& contents) {
    const auto count = reader.take_integer<std::uint32_t>("file count");
    if (count > kMaxFiles) {
        reader.fail("bundle: has more than " + std::to_string(kMaxFiles) + " files");
    }
    for (std::uint32_t i = 0; i < count && reader.error.empty(); ++i) {
        BundleEntry entry;
        entry.path = reader.take_path("path");
        entry.bytes = reader.take(reader.take_integer<std::uint64_t>("file size"), "file");
        if (entry.path.empty() || (i > 0 && entry.path <= contents.entries.back().path)) {
            reader.fail("bundle: files are not sorted or not unique");
        }
        contents.entries.push_back(std::move(entry));
    }
}

/// Refuses a file "a" beside a file "a/b", and a glTF file or environment that is not in the bundle.
void check_entries(BundleReader& reader, const BundleContents& contents) {
    std::set<std::string_view> paths;
    for (const BundleEntry& entry : contents.entries) {
        paths.insert(entry.path);
    }
    for (const BundleEntry& entry : contents.entries) {
        const std::string_view path = entry.path;
        for (std::size_t slash = path.find('/'); slash != std::string_view::npos; slash = path.find('/', slash + 1)) {
            if (paths.contains(path.substr(0, slash))) {
                reader.fail("bundle: the path of a file is also that of a folder");
            }
        }
    }
    if (!paths.contains(contents.main) || contents.main.find('/') != std::string::npos) {
        reader.fail("bundle: the glTF file is missing or not in the topmost folder");
    }
    if (!contents.environment.empty() &&
        (!paths.contains(contents.environment) || !contents.environment.starts_with(kEnvironmentStem))) {
        reader.fail("bundle: the environment image is missing or misplaced");
    }
}

Decoded<BundleContents> read_bundle(std::span<const std::byte> bundle) {
    BundleReader reader(bundle);
    BundleContents contents;
    const auto magic = reader.take(kMagic.size(), "magic");
    if (std::string_view(reinterpret_cast<const char*>(magic.data()), magic.size()) != kMagic) {
        return decode_error("bundle: is not a scene bundle");
    }
    if (const auto version = reader.take_integer<std::uint32_t>("version"); version != kVersion) {
        reader.fail("bundle: version " + std::to_string(version) + " is not supported");
    }
    for (int i = 0; i < 3; ++i) {
        contents.sky[i] = std::bit_cast<float>(reader.take_integer<std::uint32_t>("sky"));
        if (!(contents.sky[i] >= 0.0F && contents.sky[i] <= std::numeric_limits<float>::max())) {
            reader.fail("bundle: sky is negative or not finite");
        }
    }
    contents.main = reader.take_path("glTF path");
    contents.environment = reader.take_path("environment path");
    read_entries(reader, contents);
    if (reader.error.empty()) {
        check_entries(reader, contents);
    }
    if (!reader.is_at_end()) {
        reader.fail("bundle: has bytes after the last file");
    }
    return reader.error.empty() ? Decoded<BundleContents>(std::move(contents)) : decode_error(reader.error);
}

bool write_file(const fs::path& file, std::span<const std::byte> bytes) {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    return !error && stream.good();
}

} // namespace

SceneHash hash_files(const SceneFiles& files, const LoadOptions& options) {
    Sha256 sha;
    write_bundle(files, options, [&](std::span<const std::byte> bytes) { sha.add(bytes); });
    return sha.finish();
}

std::vector<std::byte> make_bundle(const fs::path& file, const LoadOptions& options) {
    const SceneFiles files = read_scene_files(file, options);
    std::uint64_t size = 0;
    write_bundle(files, options, [&](std::span<const std::byte> bytes) { size += bytes.size(); });
    std::vector<std::byte> bundle;
    bundle.reserve(size);
    write_bundle(files, options,
                 [&](std::span<const std::byte> bytes) { bundle.insert(bundle.end(), bytes.begin(), bytes.end()); });
    return bundle;
}

SceneHash hash_bundle(std::span<const std::byte> bundle) {
    Sha256 sha;
    sha.add(bundle);
    return sha.finish();
}

std::string to_hex(const SceneHash& hash) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (const std::uint8_t byte : hash) {
        text += kDigits[byte >> 4U];
        text += kDigits[byte & 0xFU];
    }
    return text;
}

Decoded<UnpackedBundle> unpack_bundle(std::span<const std::byte> bundle, const fs::path& folder) {
    const Decoded<BundleContents> contents = read_bundle(bundle);
    if (!contents) {
        return tl::unexpected(contents.error());
    }
    std::error_code error;
    fs::create_directories(folder, error);
    // A folder with foreign contents could hold links that lead out of it.
    if (error || !fs::is_empty(folder, error) || error) {
        return decode_error("bundle: " + folder.string() + " is not a new or empty folder");
    }
    for (const BundleEntry& entry : contents->entries) {
        if (!write_file(folder / entry.path, entry.bytes)) {
            return decode_error("bundle: cannot write " + (folder / entry.path).string());
        }
    }
    UnpackedBundle unpacked{folder / contents->main, {}};
    if (contents->environment.empty()) {
        unpacked.options.sky = contents->sky;
    } else {
        unpacked.options.environment = folder / contents->environment;
    }
    return unpacked;
}

} // namespace fieldcast::scene
