// SPDX-License-Identifier: Apache-2.0
#include "server/session/ladder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace fieldcast::session {

namespace {

// Expected bytes after a step, as a share of those before; see docs/benchmarks.md, "Codecs". They only choose how far
// to go at once: what is measured afterwards decides.
constexpr double kJpegShareOfViews = 0.15;
constexpr double kJpegShareOfPlanes = 0.5; // depth, normal, id and material stay as they are
constexpr double kQualityShare = 0.7;
constexpr double kSizeStep = 2.0 / 3.0;
constexpr std::uint32_t kQualityStep = 20;

bool has_views(const Configuration& granted) {
    return granted.mode == v1::DELIVERY_MODE_VIEWS;
}

std::span<const v1::PlaneSemantic> lossy_planes(const Configuration& granted) {
    static constexpr std::array kViews{v1::PLANE_SEMANTIC_COLOUR};
    static constexpr std::array kSource{v1::PLANE_SEMANTIC_DIFFUSE, v1::PLANE_SEMANTIC_SPECULAR};
    static constexpr std::array kTotal{v1::PLANE_SEMANTIC_TOTAL_LIGHT};
    if (has_views(granted)) {
        return kViews;
    }
    const auto& choices = std::get<feed::PlanesWish>(granted.wish).choices;
    return choices.front().semantic == PlaneSemantic::kTotalLight ? std::span<const v1::PlaneSemantic>(kTotal)
                                                                  : std::span<const v1::PlaneSemantic>(kSource);
}

/// Encoding of the planes that may become lossy.
codec::Encoding encoding_of(const Configuration& granted) {
    if (const auto* views = std::get_if<feed::ViewsWish>(&granted.wish)) {
        return views->format.encoding;
    }
    return std::get<feed::PlanesWish>(granted.wish).choices.front().encoding;
}

/// JPEG of that quality for those planes, in front of everything else that was said about them.
void set_jpeg(v1::Configure& wanted, std::span<const v1::PlaneSemantic> planes, std::uint32_t quality) {
    for (const v1::PlaneSemantic semantic : planes) {
        const auto same = [&](const v1::CodecPreference& p) { return p.semantic() == semantic; };
        const auto found = std::ranges::find_if(*wanted.mutable_codecs(), same);
        v1::CodecPreference& preference = found != wanted.mutable_codecs()->end() ? *found : *wanted.add_codecs();
        preference.set_semantic(semantic);
        preference.clear_codecs();
        preference.add_codecs(v1::CODEC_JPEG);
        preference.set_quality(quality);
    }
}

/// Builds rungs, each on the one before.
class Builder {
public:
    Builder(const v1::Configure& wanted, const Configuration& granted)
        : granted_(granted), bounds_(wanted.adaptation()), rungs_{Rung{.wanted = wanted, .cost = 1.0, .change = ""}} {}

    std::vector<Rung> build() {
        add_codec();
        add_qualities();
        add_rates();
        if (has_views(granted_)) {
            add_sizes();
            add_grids();
            add_scene();
        }
        return std::move(rungs_);
    }

private:
    Rung& add(double share, std::string change) {
        Rung rung = rungs_.back();
        rung.cost *= share;
        rung.change = std::move(change);
        return rungs_.emplace_back(std::move(rung));
    }

    bool allows_jpeg() const {
        return std::ranges::find(bounds_.codecs(), static_cast<int>(v1::CODEC_JPEG)) != bounds_.codecs().end();
    }

    void add_codec() {
        const codec::Encoding now = encoding_of(granted_);
        quality_ = now.quality;
        if (codec::is_lossy(now.codec) || !allows_jpeg()) {
            return;
        }
        quality_ = granted_.feed->info().lossy_quality;
        Rung& rung = add(has_views(granted_) ? kJpegShareOfViews : kJpegShareOfPlanes,
                         "JPEG of quality " + std::to_string(quality_));
        set_jpeg(rung.wanted, lossy_planes(granted_), quality_);
    }

    void add_qualities() {
        const std::uint32_t smallest = std::min<std::uint32_t>(bounds_.min_quality(), codec::kMaxQuality);
        while (quality_ > 0 && smallest > 0 && quality_ > smallest) {
            quality_ = std::max(smallest, quality_ > kQualityStep ? quality_ - kQualityStep : 1);
            set_jpeg(add(kQualityShare, "quality " + std::to_string(quality_)).wanted, lossy_planes(granted_),
                     quality_);
        }
    }

    void add_rates() {
        constexpr int kHalvings = 3;
        const float smallest = bounds_.min_frames_per_second();
        float rate = granted_.frames_per_second;
        for (int i = 0; i < kHalvings && smallest > 0.0F && rate / 2.0F >= smallest; ++i) {
            rate /= 2.0F;
            add(0.5, "1/" + std::to_string(2 << i) + " of the frames").wanted.set_max_frames_per_second(rate);
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
            const auto width = std::max(1U, static_cast<std::uint32_t>(std::lround(set.width_px * scale)));
            const double share = static_cast<double>(height) / before;
            Rung& rung = add(share * share, "views of " + std::to_string(width) + "x" + std::to_string(height));
            rung.wanted.set_view_width_px(width);
            rung.wanted.set_view_height_px(height);
        }
    }

    void add_grids() {
        const ViewGrid& grid = granted_.view_set.grid;
        std::uint32_t rows = grid.rows;
        std::uint32_t cols = grid.cols;
        const std::uint32_t min_rows = bounds_.min_rows();
        const std::uint32_t min_cols = bounds_.min_cols();
        const auto fewer = [](std::uint32_t count) { return count - std::max(1U, count / 6); };
        while (min_rows > 0 && min_cols > 0 && (rows > min_rows || cols > min_cols)) {
            const double before = static_cast<double>(rows) * cols;
            rows = rows > min_rows ? std::max(min_rows, fewer(rows)) : rows;
            cols = cols > min_cols ? std::max(min_cols, fewer(cols)) : cols;
            Rung& rung = add(static_cast<double>(rows) * cols / before,
                             std::to_string(rows) + "x" + std::to_string(cols) + " views");
            wire::to_proto(grid, *rung.wanted.mutable_grid()); // spacing and anchor as granted
            rung.wanted.mutable_grid()->set_rows(rows);
            rung.wanted.mutable_grid()->set_cols(cols);
        }
    }

    /// The client makes all views that it asked for by itself. Helps where two planes are less than the views were.
    void add_scene() {
        if (std::ranges::find(bounds_.modes(), static_cast<int>(v1::DELIVERY_MODE_SCENE)) == bounds_.modes().end()) {
            return;
        }
        const feed::ChannelInfo& channel = granted_.feed->info();
        const wire::ViewSet& set = granted_.view_set;
        constexpr double kIlluminationPlanes = 2.0;
        const double planes = kIlluminationPlanes * channel.source_count * channel.source_width_px *
                              static_cast<double>(channel.source_height_px);
        const double views = static_cast<double>(set.grid.view_count()) * set.width_px * set.height_px;
        const Rung& before = rungs_.back();
        const Rung& first = rungs_.front();
        const double encoding = quality_ > 0 ? kJpegShareOfViews : 1.0;
        const double rate =
            before.wanted.max_frames_per_second() > 0.0F
                ? static_cast<double>(before.wanted.max_frames_per_second() / granted_.frames_per_second)
                : 1.0;
        const double cost = planes / views * encoding * std::min(rate, 1.0);
        if (cost >= before.cost) {
            return;
        }
        Rung rung = first;
        rung.wanted.set_max_frames_per_second(before.wanted.max_frames_per_second());
        rung.wanted.clear_modes();
        rung.wanted.add_modes(v1::DELIVERY_MODE_SCENE);
        rung.wanted.set_planes(v1::PLANE_SET_ILLUMINATION);
        if (quality_ > 0) {
            static constexpr std::array kSource{v1::PLANE_SEMANTIC_DIFFUSE, v1::PLANE_SEMANTIC_SPECULAR};
            set_jpeg(rung.wanted, kSource, quality_);
        }
        rung.cost = cost;
        rung.change = "mode SCENE";
        rungs_.push_back(std::move(rung));
    }

    const Configuration& granted_;
    const v1::Adaptation& bounds_;
    std::uint32_t quality_ = 0; ///< of JPEG on the last rung; 0: it is lossless
    std::vector<Rung> rungs_;
};

} // namespace

std::vector<Rung> make_ladder(const v1::Configure& wanted, const Configuration& granted) {
    return Builder(wanted, granted).build();
}

} // namespace fieldcast::session
