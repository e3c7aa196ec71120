// SPDX-License-Identifier: Apache-2.0
#include "server/session/ladder.h"

#include "server/session/quality_rungs.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace fieldcast::session {

static_assert(std::is_trivially_copyable_v<Rung>, "a ladder has many rungs, so they must not allocate");

namespace {

// Expected bytes after a step, as a share of those before; see docs/benchmarks.md, "Codecs". They only decide how many
// steps are taken at once; measurements afterwards correct them.
constexpr double kLossyShareOfViews = 0.15;
constexpr double kLossyShareOfPlanes = 0.5; // depth, normal, id and material stay as they are
constexpr double kQualityShare = 0.7;
constexpr double kSizeStep = 2.0 / 3.0;

std::vector<wire::PlaneChoice> choices_of(const feed::Selection& selection) {
    if (const auto* views = std::get_if<feed::ViewSelection>(&selection)) {
        return {{.semantic = PlaneSemantic::kColour, .encoding = views->format.encoding}};
    }
    return std::get<feed::PlaneSelection>(selection).choices;
}

/// The planes of a configuration, whatever its mode, that lossy codecs can carry.
std::vector<wire::PlaneChoice> pictures_of(const Configuration& granted) {
    std::vector<wire::PlaneChoice> choices = choices_of(granted.selection);
    std::erase_if(choices, [](const wire::PlaneChoice& choice) {
        return !is_picture(choice.semantic);
    });
    return choices;
}

bool is_encoded_lossy(const wire::PlaneChoice& choice) {
    return is_lossy(choice.encoding.codec);
}

template <class Numbers> bool contains(const Numbers& numbers, int number) {
    return std::ranges::find(numbers, number) != numbers.end();
}

/// Replaces the codec preference for `plane` in `wanted`.
void set_codec(v1::Configure& wanted, PlaneSemantic plane, Codec codec, std::uint8_t quality) {
    const v1::PlaneSemantic semantic = wire::to_proto(plane);
    const auto same = [&](const v1::CodecPreference& p) { return p.semantic() == semantic; };
    const auto found = std::ranges::find_if(*wanted.mutable_codecs(), same);
    v1::CodecPreference& preference = found != wanted.mutable_codecs()->end() ? *found : *wanted.add_codecs();
    preference.set_semantic(semantic);
    preference.clear_codecs();
    preference.add_codecs(wire::to_proto(codec));
    preference.set_quality(quality);
}

} // namespace

/// Builds the rungs of a ladder, each from the one before.
class LadderBuilder {
public:
    LadderBuilder(const v1::Adaptation& bounds, const Configuration& granted, Ladder& ladder)
        : granted_(granted), bounds_(bounds), ladder_(ladder), rungs_(ladder.rungs_),
          has_views_(!is_made_by_client(granted.mode)) {}

    void build() {
        rungs_.push_back(Rung{});
        add_codec();
        add_qualities();
        add_rates();
        if (has_views_) {
            add_sizes();
            add_grids();
            add_scene();
        }
    }

private:
    Rung& add(Rung::Step step, double share) {
        Rung rung = rungs_.back();
        rung.cost *= share;
        rung.step = step;
        return rungs_.emplace_back(rung);
    }

    /// The first lossy codec that the client allows and that can carry one of `planes`.
    std::optional<Codec> allowed_codec(std::span<const PlaneSemantic> planes) const {
        for (const Codec codec : kAll<Codec>) {
            const auto can_carry = [&](PlaneSemantic plane) { return carries(codec, usual_format(plane)); };
            if (is_lossy(codec) && contains(bounds_.codecs(), wire::to_proto(codec)) &&
                std::ranges::any_of(planes, can_carry)) {
                return codec;
            }
        }
        return std::nullopt;
    }

    void add_codec() {
        const std::vector<wire::PlaneChoice>& pictures = ladder_.pictures_;
        const auto lossy = std::ranges::find_if(pictures, is_encoded_lossy);
        quality_ = lossy == pictures.end() ? std::uint8_t{0} : lossy->encoding.quality;
        std::vector<PlaneSemantic> lossless;
        for (const wire::PlaneChoice& picture : pictures) {
            if (!is_encoded_lossy(picture)) {
                lossless.push_back(picture.semantic);
            }
        }
        const std::optional<Codec> codec = allowed_codec(lossless);
        if (!codec) {
            return;
        }
        quality_ = quality_ > 0 ? quality_ : granted_.feed->info().lossy_quality;
        Rung& rung = add(Rung::Step::kCodec, has_views_ ? kLossyShareOfViews : kLossyShareOfPlanes);
        rung.codec = codec;
        rung.quality = quality_;
    }

    void add_qualities() {
        const std::uint32_t smallest = bounds_.min_quality();
        if (smallest == 0) {
            return;
        }
        for (auto next = kQualityRungs.rbegin(); next != kQualityRungs.rend() && *next >= smallest; ++next) {
            if (*next < quality_) {
                quality_ = *next;
                add(Rung::Step::kQuality, kQualityShare).quality = quality_;
            }
        }
    }

    void add_rates() {
        constexpr int kHalvings = 3;
        const float smallest = bounds_.min_frames_per_second();
        float rate = granted_.frames_per_second;
        for (int i = 0; i < kHalvings && smallest > 0.0F && rate / 2.0F >= smallest; ++i) {
            rate /= 2.0F;
            add(Rung::Step::kRate, 0.5).rate_divisor = static_cast<std::uint8_t>(2 << i);
        }
    }

    void add_sizes() {
        const std::uint32_t smallest = bounds_.min_view_height_px();
        const wire::ViewSet& set = granted_.view_set;
        std::uint32_t height = set.height_px;
        while (smallest > 0 && height > smallest) {
            const auto next = static_cast<std::uint32_t>(std::lround(height * kSizeStep));
            const std::uint32_t before = height;
            height = std::max(smallest, next);
            const double scale = static_cast<double>(height) / set.height_px;
            const double share = static_cast<double>(height) / before;
            Rung& rung = add(Rung::Step::kSize, share * share);
            rung.width_px = std::max(1U, static_cast<std::uint32_t>(std::lround(set.width_px * scale)));
            rung.height_px = height;
        }
    }

    void add_grids() {
        std::uint32_t rows = granted_.view_set.grid.rows;
        std::uint32_t cols = granted_.view_set.grid.cols;
        const std::uint32_t min_rows = bounds_.min_rows();
        const std::uint32_t min_cols = bounds_.min_cols();
        const auto fewer = [](std::uint32_t count) { return count - std::max(1U, count / 6); };
        while (min_rows > 0 && min_cols > 0 && (rows > min_rows || cols > min_cols)) {
            const double before = static_cast<double>(rows) * cols;
            rows = rows > min_rows ? std::max(min_rows, fewer(rows)) : rows;
            cols = cols > min_cols ? std::max(min_cols, fewer(cols)) : cols;
            Rung& rung = add(Rung::Step::kGrid, static_cast<double>(rows) * cols / before);
            rung.rows = rows;
            rung.cols = cols;
        }
    }

    /// Mode SCENE: the client renders its views itself. Added only if the two planes are smaller than the views were.
    void add_scene() {
        if (!contains(bounds_.modes(), v1::DELIVERY_MODE_SCENE)) {
            return;
        }
        const feed::ChannelInfo& channel = granted_.feed->info();
        const wire::ViewSet& set = granted_.view_set;
        const std::vector<PlaneSemantic> light = planes_of(DeliveryMode::kScene, PlaneSet::kIllumination, {});
        const double planes = static_cast<double>(light.size()) * channel.source_count * channel.source_width_px *
                              static_cast<double>(channel.source_height_px);
        const double views = static_cast<double>(set.grid.view_count()) * set.width_px * set.height_px;
        const Rung before = rungs_.back();
        const double encoding = quality_ > 0 ? kLossyShareOfViews : 1.0;
        const double cost = planes / views * encoding / before.rate_divisor;
        if (cost >= before.cost) {
            return;
        }
        rungs_.push_back({.cost = cost,
                          .step = Rung::Step::kMode,
                          .codec = quality_ > 0 ? allowed_codec(light) : std::nullopt,
                          .is_scene = true,
                          .quality = quality_,
                          .rate_divisor = before.rate_divisor});
    }

    const Configuration& granted_;
    const v1::Adaptation& bounds_;
    const Ladder& ladder_;
    std::vector<Rung>& rungs_;
    const bool has_views_;
    std::uint8_t quality_ = 0; ///< of lossy planes on the last rung; 0: all are lossless
};

Ladder::Ladder(const v1::Configure& wanted, const Configuration& granted)
    : wanted_(wanted), grid_(granted.view_set.grid), frames_per_second_(granted.frames_per_second),
      pictures_(pictures_of(granted)) {
    wanted_.clear_adaptation();
    wanted_.clear_resume_token();
    LadderBuilder(wanted.adaptation(), granted, *this).build();
}

v1::Configure Ladder::configure(const Rung& rung) const {
    v1::Configure wanted = wanted_;
    if (rung.rate_divisor > 1) {
        wanted.set_max_frames_per_second(frames_per_second_ / static_cast<float>(rung.rate_divisor));
    }
    if (rung.is_scene) {
        wanted.clear_modes();
        wanted.add_modes(v1::DELIVERY_MODE_SCENE);
        wanted.set_planes(v1::PLANE_SET_ILLUMINATION);
        for (const PlaneSemantic plane : planes_of(DeliveryMode::kScene, PlaneSet::kIllumination, {})) {
            if (rung.codec) {
                set_codec(wanted, plane, *rung.codec, rung.quality);
            }
        }
        return wanted;
    }
    for (const wire::PlaneChoice& picture : pictures_) {
        const codec::Encoding granted = picture.encoding;
        if (rung.quality > 0 && is_encoded_lossy(picture)) {
            set_codec(wanted, picture.semantic, granted.codec, std::min(rung.quality, granted.quality));
        } else if (rung.codec && carries(*rung.codec, wire::format_of(picture))) {
            set_codec(wanted, picture.semantic, *rung.codec, rung.quality);
        }
    }
    if (rung.height_px > 0) {
        wanted.set_view_width_px(rung.width_px);
        wanted.set_view_height_px(rung.height_px);
    }
    if (rung.rows > 0) {
        wire::to_proto(grid_, *wanted.mutable_grid());
        wanted.mutable_grid()->set_rows(rung.rows);
        wanted.mutable_grid()->set_cols(rung.cols);
    }
    return wanted;
}

std::string Ladder::change(const Rung& rung) const {
    const auto product = [](std::uint32_t a, std::uint32_t b) { return std::to_string(a) + "x" + std::to_string(b); };
    switch (rung.step) {
    case Rung::Step::kNone:
        break;
    case Rung::Step::kCodec:
        return std::string(rung.codec ? word_of(*rung.codec) : "") + " of quality " + std::to_string(rung.quality);
    case Rung::Step::kQuality:
        return "quality " + std::to_string(rung.quality);
    case Rung::Step::kRate:
        return "1/" + std::to_string(rung.rate_divisor) + " of the frames";
    case Rung::Step::kSize:
        return "views of " + product(rung.width_px, rung.height_px);
    case Rung::Step::kGrid:
        return product(rung.rows, rung.cols) + " views";
    case Rung::Step::kMode:
        return "mode " + std::string(word_of(DeliveryMode::kScene));
    }
    return "as asked for";
}

} // namespace fieldcast::session
