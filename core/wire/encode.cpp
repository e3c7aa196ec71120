// SPDX-License-Identifier: Apache-2.0
#include "core/wire/encode.h"

#include "core/codec/crc32c.h"

#include <algorithm>
#include <set>

namespace fieldcast::wire {

namespace {

using Clock = std::chrono::steady_clock;

EncodedPlane without_strips(const Plane& plane, codec::CodecId codec) {
    return {plane.semantic, plane.format, codec, plane.width_px, plane.height_px, {}};
}

/// A plane to encode and where to put its strips.
struct Job {
    const Plane* plane = nullptr;
    EncodedPlane* encoded = nullptr;
};

/// Encodes all strips of all planes as one loop, so that threads stay busy to the end.
void encode_all(std::span<const Job> jobs, WorkerPool& pool) {
    struct Item {
        Job job;
        std::size_t strip = 0;
    };
    std::vector<Item> items;
    for (const Job& job : jobs) {
        for (const codec::RowBand band : codec::strip_bands(job.plane->height_px)) {
            items.push_back({job, job.encoded->strips.size()});
            job.encoded->strips.push_back({band, nullptr, 0});
        }
    }
    pool.for_each(items.size(), [&items](std::size_t i) {
        const auto& [job, index] = items[i];
        EncodedStrip& strip = job.encoded->strips[index];
        auto bytes = codec::encode_strip(*job.plane, strip.band, job.encoded->codec);
        strip.crc32c = codec::crc32c(bytes);
        strip.bytes = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
    });
}

} // namespace

std::uint64_t EncodedPlane::encoded_bytes() const {
    std::uint64_t sum = 0;
    for (const EncodedStrip& strip : strips) {
        sum += strip.bytes->size();
    }
    return sum;
}

EncodedPlane encode_plane(const Plane& plane, codec::CodecId codec, WorkerPool& pool) {
    EncodedPlane encoded = without_strips(plane, codec);
    const Job job{&plane, &encoded};
    encode_all(std::span(&job, 1), pool);
    return encoded;
}

const EncodedPlane* EncodedSource::find(PlaneChoice choice) const {
    const auto found = std::ranges::find_if(planes, [&](const EncodedPlane& plane) {
        return plane.semantic == choice.semantic && plane.codec == choice.codec;
    });
    return found == planes.end() ? nullptr : &*found;
}

EncodedSource encode_source(const SourceFrame& frame, std::span<const PlaneChoice> choices, WorkerPool& pool) {
    const auto begin = Clock::now();
    const std::set<PlaneChoice> distinct(choices.begin(), choices.end());
    EncodedSource source;
    source.header = frame.header;
    source.planes.reserve(distinct.size()); // jobs point into it
    std::vector<Job> jobs;
    for (const PlaneChoice choice : distinct) {
        const Plane* plane = frame.find(choice.semantic);
        FC_ASSERT(plane != nullptr, "a plane was chosen that the frame does not have");
        jobs.push_back({plane, &source.planes.emplace_back(without_strips(*plane, choice.codec))});
    }
    encode_all(jobs, pool);
    source.encode_time = Clock::now() - begin;
    return source;
}

EncodedViews encode_views(const Views& views, const ViewFormat& format, WorkerPool& pool) {
    const auto begin = Clock::now();
    EncodedViews encoded;
    encoded.header = views.header;
    encoded.format = format;
    std::vector<Job> jobs;
    for (const View& view : views.views) {
        FC_ASSERT(view.image.semantic == PlaneSemantic::kColour && view.image.format == PlaneFormat::kRgb8 &&
                      view.image.width_px == format.width_px && view.image.height_px == format.height_px,
                  "view differs from its format");
        const auto [entry, is_new] = encoded.views.try_emplace(view.position);
        FC_ASSERT(is_new, "two views at one lattice position");
        entry->second = {without_strips(view.image, format.codec), view.discards};
        jobs.push_back({&view.image, &entry->second.image});
    }
    encode_all(jobs, pool);
    encoded.encode_time = Clock::now() - begin;
    return encoded;
}

} // namespace fieldcast::wire
