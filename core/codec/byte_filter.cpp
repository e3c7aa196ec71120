// SPDX-License-Identifier: Apache-2.0
#include "core/codec/byte_filter.h"

#include "core/base/error.h"
#include "core/codec/channel_layout.h"

#include <algorithm>
#include <vector>

namespace fieldcast::codec {

namespace {

constexpr std::size_t kCostRowStep = 8;

/// ⌊(a + b) / 2⌋ without a wider type.
template <class Lane> Lane mean(Lane a, Lane b) {
    return static_cast<Lane>((a & b) + ((a ^ b) >> 1));
}

template <class Lane> constexpr Lane lane_mask(int bits) {
    return static_cast<Lane>(~std::uint32_t{0} >> (32 - bits));
}

/// Small errors of either sign → small numbers, and back. `bits` wide, modulo 2^bits.
template <class Lane> Lane fold(Lane error, int bits) {
    const auto sign = static_cast<Lane>(0U - (error >> (bits - 1)));
    return static_cast<Lane>((static_cast<std::uint32_t>(error) << 1 ^ sign) & lane_mask<Lane>(bits));
}

template <class Lane> Lane unfold(Lane folded, int bits) {
    return static_cast<Lane>((folded >> 1 ^ (0U - (folded & 1U))) & lane_mask<Lane>(bits));
}

/// One channel of one row, and the rows that predict it. `up` and `reference` may be null.
template <class Lane> struct ChannelRow {
    const Lane* values = nullptr;
    const Lane* up = nullptr;
    const Lane* reference = nullptr;
    std::size_t width = 0;
};

/// Differences from the predictions, modulo the lane's range. No value depends on another: vectorisable.
template <class Lane> void predict(Predictor predictor, const ChannelRow<Lane>& row, Lane* errors) {
    const auto [x, up, reference, width] = row;
    const auto set = [errors](std::size_t i, Lane value, Lane prediction) {
        errors[i] = static_cast<Lane>(value - prediction);
    };
    if (predictor == Predictor::kNone) {
        std::copy_n(x, width, errors);
        return;
    }
    if (predictor == Predictor::kReference) {
        for (std::size_t i = 0; i < width; ++i) {
            set(i, x[i], reference[i]);
        }
        return;
    }
    const bool uses_up = predictor != Predictor::kLeft && up != nullptr;
    set(0, x[0], uses_up ? up[0] : Lane{0});
    for (std::size_t i = 1; i < width && !uses_up; ++i) {
        set(i, x[i], x[i - 1]);
    }
    for (std::size_t i = 1; i < width && uses_up && predictor == Predictor::kGradient; ++i) {
        set(i, x[i], static_cast<Lane>(x[i - 1] + up[i] - up[i - 1]));
    }
    for (std::size_t i = 1; i < width && uses_up && predictor == Predictor::kAverage; ++i) {
        set(i, x[i], mean(x[i - 1], up[i]));
    }
}

/// Undoes `predict` for all channels at once: the chains of additions of several channels run side by side.
template <class Channels, class Predict>
void restore(const typename Channels::Lane* errors, std::size_t width, typename Channels::Lane* x,
             const Predict& prediction) {
    using Lane = typename Channels::Lane;
    std::array<Lane, Channels::kChannels> left{};
    for (std::size_t i = 0; i < width; ++i) {
        for (std::size_t c = 0; c < Channels::kChannels; ++c) {
            const std::size_t at = c * width + i;
            left[c] = static_cast<Lane>((errors[at] + prediction(left[c], at, i)) & lane_mask<Lane>(Channels::bits(c)));
            x[at] = left[c];
        }
    }
}

template <class Channels>
void restore_row(Predictor predictor, const typename Channels::Lane* errors, const typename Channels::Lane* up,
                 const typename Channels::Lane* reference, std::size_t width, typename Channels::Lane* x) {
    using Lane = typename Channels::Lane;
    switch (predictor) {
    case Predictor::kNone:
        std::copy_n(errors, Channels::kChannels * width, x);
        return;
    case Predictor::kReference:
        return restore<Channels>(errors, width, x, [=](Lane, std::size_t at, std::size_t) { return reference[at]; });
    case Predictor::kLeft:
        break;
    case Predictor::kGradient:
        if (up != nullptr) {
            return restore<Channels>(errors, width, x, [=](Lane left, std::size_t at, std::size_t i) {
                return static_cast<Lane>(left + up[at] - (i > 0 ? up[at - 1] : Lane{0}));
            });
        }
        break;
    case Predictor::kAverage:
        if (up != nullptr) {
            return restore<Channels>(errors, width, x, [=](Lane left, std::size_t at, std::size_t i) {
                return i > 0 ? mean(left, up[at]) : up[at];
            });
        }
        break;
    }
    restore<Channels>(errors, width, x, [](Lane left, std::size_t, std::size_t) { return left; });
}

/// A band whose pixels have the layout `Channels`.
template <class Channels> class BandFilter {
public:
    using Lane = typename Channels::Lane;

    BandFilter(ByteFilter filter, BandSize size)
        : filter_(filter), width_(size.width_px), rows_(size.row_count), lane_count_(Channels::kChannels * width_),
          current_(lane_count_), above_(lane_count_), reference_(lane_count_), errors_(lane_count_) {}

    void filter(const std::byte* pixels, const std::byte* reference, std::byte* filtered) {
        for (std::size_t y = 0; y < rows_; ++y) {
            make_errors(pixels, reference, y);
            Channels::split(errors_.data(), width_, filtered + y * width_, width_ * rows_);
            std::swap(current_, above_);
        }
    }

    void unfilter(const std::byte* filtered, const std::byte* reference, std::byte* pixels) {
        for (std::size_t y = 0; y < rows_; ++y) {
            Channels::join(filtered + y * width_, width_ * rows_, width_, errors_.data());
            unfold_errors();
            load_reference(reference, y);
            restore_row<Channels>(filter_.predictor, errors_.data(), y > 0 ? above_.data() : nullptr, reference_.data(),
                                  width_, current_.data());
            Channels::store(current_.data(), width_, pixels + y * row_bytes());
            std::swap(current_, above_);
        }
    }

    std::uint64_t cost(const std::byte* pixels, const std::byte* reference) {
        std::uint64_t bit_count = 0;
        filter_.is_folded = true; // for the estimate only, which needs the sizes of errors
        for (std::size_t y = 0; y < rows_; y += kCostRowStep) {
            if (y > 0) {
                Channels::load(pixels + (y - 1) * row_bytes(), width_, above_.data());
            }
            make_errors(pixels, reference, y);
            for (const Lane error : errors_) {
                bit_count += static_cast<std::uint64_t>(std::bit_width(error));
            }
        }
        return bit_count;
    }

private:
    std::size_t row_bytes() const { return width_ * Channels::kPixelBytes; }

    void load_reference(const std::byte* reference, std::size_t y) {
        if (filter_.predictor == Predictor::kReference) {
            Channels::load(reference + y * row_bytes(), width_, reference_.data());
        }
    }

    void make_errors(const std::byte* pixels, const std::byte* reference, std::size_t y) {
        Channels::load(pixels + y * row_bytes(), width_, current_.data());
        load_reference(reference, y);
        for (std::size_t c = 0; c < Channels::kChannels; ++c) {
            const std::size_t at = c * width_;
            predict<Lane>(filter_.predictor, {&current_[at], y > 0 ? &above_[at] : nullptr, &reference_[at], width_},
                          &errors_[at]);
            const int bits = Channels::bits(c);
            for (std::size_t i = at; i < at + width_; ++i) {
                const auto error = static_cast<Lane>(errors_[i] & lane_mask<Lane>(bits));
                errors_[i] = filter_.is_folded ? fold(error, bits) : error;
            }
        }
    }

    void unfold_errors() {
        for (std::size_t c = 0; c < Channels::kChannels && filter_.is_folded; ++c) {
            for (std::size_t i = c * width_; i < (c + 1) * width_; ++i) {
                errors_[i] = unfold(errors_[i], Channels::bits(c));
            }
        }
    }

    ByteFilter filter_;
    std::size_t width_;
    std::size_t rows_;
    std::size_t lane_count_;
    std::vector<Lane> current_;
    std::vector<Lane> above_;
    std::vector<Lane> reference_;
    std::vector<Lane> errors_;
};

/// Calls `use` with a BandFilter for the filter's layout. False: no such layout for pixels of that size.
template <class Use> bool with_channels(ByteFilter filter, BandSize size, const Use& use) {
    switch (static_cast<int>(size.pixel_bytes * 100) + static_cast<int>(filter.layout)) {
    case 201:
        return use(BandFilter<WordChannels<std::uint8_t, 2>>(filter, size)), true;
    case 202:
        return use(BandFilter<WordChannels<std::uint16_t, 1>>(filter, size)), true;
    case 301:
        return use(BandFilter<WordChannels<std::uint8_t, 3>>(filter, size)), true;
    case 303:
        return use(BandFilter<GreenByteChannels>(filter, size)), true;
    case 401:
        return use(BandFilter<WordChannels<std::uint8_t, 4>>(filter, size)), true;
    case 402:
        return use(BandFilter<WordChannels<std::uint16_t, 2>>(filter, size)), true;
    case 404:
        return use(BandFilter<WordChannels<std::uint32_t, 1>>(filter, size)), true;
    case 411:
        return use(BandFilter<PackedFloatChannels>(filter, size)), true;
    default:
        return false;
    }
}

void check_sizes(ByteFilter filter, BandSize size, std::size_t pixels, std::size_t reference) {
    FC_ASSERT(pixels == size.bytes() && size.width_px > 0, "band sizes differ");
    FC_ASSERT(reference == (filter.predictor == Predictor::kReference ? pixels : 0), "reference of another size");
}

} // namespace

ByteFilter filter_for(PlaneFormat format) {
    switch (format) {
    case PlaneFormat::kF32:
        return {Predictor::kGradient, Layout::kWords32, true};
    case PlaneFormat::kOct2x16:
    case PlaneFormat::kR16:
        return {Predictor::kGradient, Layout::kWords16, true};
    case PlaneFormat::kU32:
        return {Predictor::kNone, Layout::kBytes, false};
    case PlaneFormat::kR11G11B10F:
        return {Predictor::kAverage, Layout::kPackedFloats, true};
    case PlaneFormat::kRg8:
        return {Predictor::kGradient, Layout::kBytes, false};
    case PlaneFormat::kOct2x8:
        return {Predictor::kGradient, Layout::kBytes, true};
    case PlaneFormat::kRgb8:
        return {Predictor::kGradient, Layout::kGreenBytes, false};
    }
    return {};
}

std::optional<ByteFilter> filter_from_numbers(PlaneFormat format, std::uint8_t predictor, std::uint8_t layout,
                                              bool is_folded) {
    const ByteFilter filter{static_cast<Predictor>(predictor), static_cast<Layout>(layout), is_folded};
    const bool fits = with_channels(filter, {1, 1, bytes_per_pixel(format)}, [](const auto&) {}) &&
                      (filter.layout != Layout::kPackedFloats || format == PlaneFormat::kR11G11B10F);
    return fits && filter.predictor <= Predictor::kReference ? std::optional(filter) : std::nullopt;
}

void filter_band(ByteFilter filter, BandSize size, std::span<const std::byte> pixels,
                 std::span<const std::byte> reference, std::span<std::byte> filtered) {
    check_sizes(filter, size, pixels.size(), reference.size());
    FC_ASSERT(filtered.size() == pixels.size(), "band sizes differ");
    const bool is_known =
        with_channels(filter, size, [&](auto band) { band.filter(pixels.data(), reference.data(), filtered.data()); });
    FC_ASSERT(is_known, "filter does not fit the pixels");
}

void unfilter_band(ByteFilter filter, BandSize size, std::span<const std::byte> filtered,
                   std::span<const std::byte> reference, std::span<std::byte> pixels) {
    check_sizes(filter, size, pixels.size(), reference.size());
    FC_ASSERT(filtered.size() == pixels.size(), "band sizes differ");
    const bool is_known = with_channels(
        filter, size, [&](auto band) { band.unfilter(filtered.data(), reference.data(), pixels.data()); });
    FC_ASSERT(is_known, "filter does not fit the pixels");
}

std::uint64_t filter_cost(ByteFilter filter, BandSize size, std::span<const std::byte> pixels,
                          std::span<const std::byte> reference) {
    check_sizes(filter, size, pixels.size(), reference.size());
    std::uint64_t cost = 0;
    const bool is_known =
        with_channels(filter, size, [&](auto band) { cost = band.cost(pixels.data(), reference.data()); });
    FC_ASSERT(is_known, "filter does not fit the pixels");
    return cost;
}

} // namespace fieldcast::codec
