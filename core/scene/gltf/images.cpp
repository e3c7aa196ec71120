// SPDX-License-Identifier: Apache-2.0
#include "core/scene/gltf/images.h"

#include "core/image/image_file.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <thread>

namespace fieldcast::scene {

namespace {

constexpr unsigned kMaxThreads = 8;

struct CompressedImage {
    std::string name;
    std::span<const std::byte> bytes;
};

/// Decodes images on several threads. Reports the failure that is the first in the order of the file.
class ImageDecoder {
public:
    ImageDecoder(const GltfDocument& document, std::vector<CompressedImage> sources, const SceneLimits& limits)
        : document_(document), sources_(std::move(sources)), limits_(limits), images_(sources_.size()),
          failures_(sources_.size()) {}

    std::vector<Image> run() {
        const auto wanted = static_cast<unsigned>(std::min<std::size_t>(sources_.size(), kMaxThreads));
        const unsigned thread_count = std::clamp(std::thread::hardware_concurrency(), 1U, std::max(wanted, 1U));
        {
            std::vector<std::jthread> threads;
            for (unsigned i = 0; i < thread_count; ++i) {
                threads.emplace_back([this] { decode_all(); });
            }
        }
        for (const std::exception_ptr& failure : failures_) {
            if (failure) {
                std::rethrow_exception(failure);
            }
        }
        return std::move(images_);
    }

private:
    void decode_all() {
        for (std::size_t i = next_++; i < sources_.size() && !has_failed_; i = next_++) {
            try {
                images_[i] = decode(sources_[i]);
            } catch (...) {
                failures_[i] = std::current_exception();
                has_failed_ = true;
            }
        }
    }

    Image decode(const CompressedImage& source) {
        const std::string name = document_.name + ": " + source.name;
        image::Rgba8 decoded = image::decode_rgba8(source.bytes, name, {limits_.max_image_pixels});
        const std::uint64_t pixels = std::uint64_t{decoded.width_px} * decoded.height_px;
        if (total_pixels_.fetch_add(pixels) + pixels > limits_.max_total_image_pixels) {
            document_.refuse(source.name, "all images together exceed " +
                                              std::to_string(limits_.max_total_image_pixels) +
                                              " pixels; use fewer or smaller textures");
        }
        return {source.name, decoded.width_px, decoded.height_px, std::move(decoded.pixels)};
    }

    const GltfDocument& document_;
    const std::vector<CompressedImage> sources_;
    const SceneLimits limits_;
    std::vector<Image> images_;                // each thread writes the elements it took
    std::vector<std::exception_ptr> failures_; // likewise
    std::atomic<std::size_t> next_ = 0;
    std::atomic<std::uint64_t> total_pixels_ = 0;
    std::atomic<bool> has_failed_ = false;
};

} // namespace

std::vector<Image> decode_images(const GltfDocument& document, GltfBufferViews& views, const SceneLimits& limits,
                                 std::vector<Texture>& textures) {
    std::map<std::uint32_t, std::uint32_t> kept; // file's image -> scene's image
    std::vector<CompressedImage> sources;
    for (Texture& texture : textures) {
        const GltfImage& image = document.images[texture.image];
        const auto [found, is_new] = kept.try_emplace(texture.image, static_cast<std::uint32_t>(sources.size()));
        if (is_new) {
            sources.push_back({image.name, image.buffer_view < 0 ? image.bytes : views.bytes(image.buffer_view)});
        }
        texture.image = found->second;
    }
    return ImageDecoder(document, std::move(sources), limits).run();
}

} // namespace fieldcast::scene
