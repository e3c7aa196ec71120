// SPDX-License-Identifier: Apache-2.0
#include "core/wire/encode.h"

#include "core/codec/crc32c.h"
#include "core/lightfield/normal_precision.h"
#include "core/wire/base_view.h"

#include <algorithm>
#include <deque>
#include <set>

namespace fieldcast::wire {

namespace {

using Clock = std::chrono::steady_clock;

EncodedPlane without_strips(const Plane& plane, codec::Encoding encoding) {
    return {plane.semantic, plane.format, encoding, plane.width_px, plane.height_px, {}};
}

/// A plane to encode, the planes to which its strips may refer, and the destination of the strips.
struct Job {
    const Plane* plane = nullptr;
    const Plane* reference = nullptr; ///< null: none
    bool is_reference_optional = false;
    float exposure = 1.0F;
    EncodedPlane* encoded = nullptr;
    const Plane* base = nullptr; ///< the image of the base view; null: none, or the codec does not predict
    const EncodedPlane* encoded_base = nullptr;
};

StripBytes share(std::vector<std::byte> bytes) {
    const std::uint32_t crc32c = codec::crc32c(bytes);
    return {std::make_shared<const std::vector<std::byte>>(std::move(bytes)), crc32c};
}

/// The plane that the strip of `band` may be predicted from; null: none. Rows of the base view that some clients get in
/// another form cannot serve.
const Plane* base_of(const Job& job, codec::RowBand band) {
    if (job.base == nullptr) {
        return nullptr;
    }
    const auto found = std::ranges::find(job.encoded_base->strips, band, &EncodedStrip::band);
    const bool is_good = found != job.encoded_base->strips.end() && codec::can_be_base(*found->best.bytes);
    return is_good ? job.base : nullptr;
}

void encode_strip(const Job& job, EncodedStrip& strip) {
    codec::StripOptions options{
        .encoding = job.encoded->encoding, .reference = job.reference, .exposure = job.exposure};
    options.base = base_of(job, strip.band);
    strip.best = share(codec::encode_strip(*job.plane, strip.band, options));
    if (!codec::needs_reference(*strip.best.bytes)) {
        strip.alone = strip.best;
    } else if (job.is_reference_optional) {
        options.reference = nullptr;
        strip.alone = share(codec::encode_strip(*job.plane, strip.band, options));
    }
}

/// Encodes all strips of all planes in one parallel loop, which keeps all threads busy until the end.
void encode_all(std::span<const Job> jobs, WorkerPool& pool) {
    struct Item {
        Job job;
        std::size_t strip = 0;
    };
    std::vector<Item> items;
    for (const Job& job : jobs) {
        for (const codec::RowBand band : codec::strip_bands(job.plane->height_px)) {
            items.push_back({job, job.encoded->strips.size()});
            job.encoded->strips.push_back({.band = band});
        }
    }
    pool.for_each(items.size(), [&items](std::size_t i) {
        const auto& [job, index] = items[i];
        encode_strip(job, job.encoded->strips[index]);
    });
}

/// `reference` if `plane` may refer to it, that is, if both have one format and size; else null.
const Plane* fitting(const Plane* reference, const Plane& plane) {
    const bool fits = reference != nullptr && reference->format == plane.format &&
                      reference->width_px == plane.width_px && reference->height_px == plane.height_px;
    return fits ? reference : nullptr;
}

const Plane* find_view(const Views* views, LatticePosition position) {
    if (views == nullptr) {
        return nullptr;
    }
    const auto found = std::ranges::find(views->views, position, &View::position);
    return found == views->views.end() ? nullptr : &found->image;
}

/// Keeps planes that were converted to another format while they are encoded.
class ConvertedPlanes {
public:
    /// `plane` in `format`; null if it is null.
    const Plane* in_format(const Plane* plane, PlaneFormat format) {
        if (plane == nullptr || plane->format == format) {
            return plane;
        }
        FC_ASSERT(format == PlaneFormat::kOct2x8, "only normals are sent in another format");
        return &planes_.emplace_back(coarse_normals(*plane));
    }

private:
    std::deque<Plane> planes_; // a deque keeps the addresses of its elements
};

/// Encodes the base views, then the views that are predicted from them. `jobs` are in the order of `views`.
void encode_predicted(const Views& views, EncodedViews& encoded, std::vector<Job> jobs, WorkerPool& pool) {
    std::vector<Job> bases;
    std::vector<Job> others;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const LatticePosition position = views.views[i].position;
        const LatticePosition base = base_position(position);
        if (position == base) {
            bases.push_back(jobs[i]);
            continue;
        }
        jobs[i].base = find_view(&views, base);
        jobs[i].encoded_base = jobs[i].base != nullptr ? &encoded.views.at(base).image : nullptr;
        others.push_back(jobs[i]);
    }
    encode_all(bases, pool);
    encode_all(others, pool);
}

} // namespace

PlaneFormat format_of(const PlaneChoice& choice) {
    return choice.format.value_or(usual_format(choice.semantic));
}

std::uint64_t EncodedPlane::encoded_bytes() const {
    std::uint64_t sum = 0;
    for (const EncodedStrip& strip : strips) {
        sum += strip.best.bytes->size();
    }
    return sum;
}

bool EncodedPlane::stands_alone() const {
    return std::ranges::all_of(strips, [](const EncodedStrip& strip) { return strip.alone.bytes != nullptr; });
}

const EncodedPlane* EncodedSource::find(PlaneChoice choice) const {
    const auto found = std::ranges::find_if(planes, [&](const EncodedPlane& plane) {
        return plane.semantic == choice.semantic && plane.encoding == choice.encoding &&
               plane.format == format_of(choice);
    });
    return found == planes.end() ? nullptr : &*found;
}

EncodedSource encode_source(const SourceFrame& frame, std::span<const PlaneChoice> choices, const KeyFrame& key,
                            WorkerPool& pool) {
    const auto begin = Clock::now();
    const std::set<PlaneChoice> distinct(choices.begin(), choices.end());
    EncodedSource source;
    source.header = frame.header;
    source.key_frame_id = key.frame_id;
    source.planes.reserve(distinct.size()); // jobs point into it
    ConvertedPlanes converted;
    std::vector<Job> jobs;
    for (const PlaneChoice& choice : distinct) {
        const PlaneFormat format = format_of(choice);
        const Plane* plane = converted.in_format(frame.find(choice.semantic), format);
        FC_ASSERT(plane != nullptr, "the frame has every chosen plane");
        // The tiles of residual planes differ in every frame.
        const bool may_refer = key.source != nullptr && !is_residual(choice.semantic);
        const Plane* reference = may_refer ? key.source->find(choice.semantic) : nullptr;
        jobs.push_back({plane, fitting(converted.in_format(reference, format), *plane), key.is_optional,
                        frame.header.settings.exposure,
                        &source.planes.emplace_back(without_strips(*plane, choice.encoding))});
    }
    encode_all(jobs, pool);
    source.encode_time = Clock::now() - begin;
    return source;
}

EncodedViews encode_views(const Views& views, const ViewFormat& format, const KeyFrame& key, WorkerPool& pool) {
    const auto begin = Clock::now();
    EncodedViews encoded;
    encoded.header = views.header;
    encoded.format = format;
    encoded.key_frame_id = key.frame_id;
    std::vector<Job> jobs;
    for (const View& view : views.views) {
        FC_ASSERT(view.image.semantic == PlaneSemantic::kColour && view.image.format == PlaneFormat::kRgb8 &&
                      view.image.width_px == format.width_px && view.image.height_px == format.height_px,
                  "every view has the size of the ViewFormat");
        const auto [entry, is_new] = encoded.views.try_emplace(view.position);
        FC_ASSERT(is_new, "each lattice position has one view");
        entry->second = {without_strips(view.image, format.encoding), view.discards};
        jobs.push_back({&view.image, fitting(find_view(key.views, view.position), view.image), key.is_optional,
                        views.header.settings.exposure, &entry->second.image});
    }
    if (row_of(format.encoding.codec).predicts_views) {
        encode_predicted(views, encoded, jobs, pool);
    } else {
        encode_all(jobs, pool);
    }
    encoded.encode_time = Clock::now() - begin;
    return encoded;
}

} // namespace fieldcast::wire
