// SPDX-License-Identifier: Apache-2.0
// Byte streams by ITU-T H.264 (08/2021): annex B; sections 7.3.1 (NAL units), 7.3.2.1 (sequence parameter set),
// 7.3.2.2 (picture parameter set), 7.3.3 (slice header, its first element).
#include "core/codec/h264_stream.h"

#include <optional>
#include <string>
#include <vector>

namespace fieldcast::codec {

namespace {

enum UnitType : std::uint8_t { kSlice = 1, kIdrSlice = 5, kSequence = 7, kPicture = 8 };

constexpr std::uint32_t kBaseline = 66;
constexpr std::uint32_t kMain = 77;
constexpr std::uint32_t kHigh = 100;
constexpr std::uint32_t kMaxReferences = 1;
constexpr std::size_t kMaxUnits = 16; ///< ours have 3, or 1

using Bytes = std::span<const std::byte>;

/// Reads the bits of a unit without its emulation prevention bytes. After the end it returns zeros and sets `is_over`.
class BitReader {
public:
    explicit BitReader(Bytes unit) : unit_(unit) {}

    std::uint32_t bits(unsigned count) {
        std::uint32_t value = 0;
        for (unsigned i = 0; i < count; ++i) {
            value = value << 1 | bit();
        }
        return value;
    }

    bool flag() { return bit() != 0; }

    /// Exp-Golomb code, section 9.1; too large ones count as an early end.
    std::uint32_t number() {
        unsigned zeros = 0;
        while (!is_over_ && bit() == 0) {
            is_over_ = ++zeros > 31;
        }
        return is_over_ ? 0 : (1U << zeros) - 1 + bits(zeros);
    }

    bool is_over() const { return is_over_; }

private:
    std::uint32_t bit() {
        if (left_ == 0 && !next_byte()) {
            is_over_ = true;
            return 0;
        }
        return current_ >> --left_ & 1U;
    }

    bool next_byte() {
        if (zeros_ >= 2 && at_ < unit_.size() && unit_[at_] == std::byte{3}) {
            ++at_;
            zeros_ = 0;
        }
        if (at_ == unit_.size()) {
            return false;
        }
        current_ = std::to_integer<std::uint32_t>(unit_[at_++]);
        zeros_ = current_ == 0 ? zeros_ + 1 : 0;
        left_ = 8;
        return true;
    }

    Bytes unit_;
    std::size_t at_ = 0;
    unsigned zeros_ = 0; ///< consecutive zero bytes before the next byte
    std::uint32_t current_ = 0;
    unsigned left_ = 0; ///< unread bits of `current_`
    bool is_over_ = false;
};

/// Position of the next start code (00 00 01); the end if there is none.
std::size_t find_start(Bytes stream, std::size_t from) {
    for (std::size_t at = from; at + 3 <= stream.size(); ++at) {
        if (stream[at] == std::byte{0} && stream[at + 1] == std::byte{0} && stream[at + 2] == std::byte{1}) {
            return at;
        }
    }
    return stream.size();
}

/// The units between start codes, without zeros that follow them; nothing if there are none, or too many.
std::optional<std::vector<Bytes>> units_of(Bytes stream) {
    std::vector<Bytes> units;
    std::size_t at = find_start(stream, 0);
    if (at > 1) { // a start code may have one more zero
        return std::nullopt;
    }
    while (at < stream.size()) {
        const std::size_t begin = at + 3;
        at = find_start(stream, begin);
        std::size_t end = at;
        while (end > begin && stream[end - 1] == std::byte{0}) {
            --end;
        }
        if (end == begin || units.size() == kMaxUnits) {
            return std::nullopt;
        }
        units.push_back(stream.subspan(begin, end - begin));
    }
    return units.empty() ? std::nullopt : std::optional(units);
}

/// Reads the fields of high profiles; false unless they say 4:2:0, 8 bits, and no scaling matrices.
bool is_usual_high(BitReader& bits) {
    const bool is_420 = bits.number() == 1;
    const bool is_8_bit = bits.number() == 0 && bits.number() == 0;
    return is_420 && is_8_bit && !bits.flag() && !bits.flag();
}

/// Reads the picture order count of types 0 and 2. False for type 1, whose list no encoder needs.
bool is_usual_order(BitReader& bits) {
    const std::uint32_t type = bits.number();
    if (type == 0) {
        return bits.number() <= 12;
    }
    return type == 2;
}

/// Whether the crop rectangle leaves width_px × height_px of `width` × `height` macroblocks.
bool is_size(BitReader& bits, std::uint64_t width, std::uint64_t height, std::uint32_t width_px,
             std::uint32_t height_px) {
    std::uint64_t across = 0;
    std::uint64_t down = 0;
    if (bits.flag()) {
        across = std::uint64_t{bits.number()} + bits.number();
        down = std::uint64_t{bits.number()} + bits.number();
    }
    return 16 * width == width_px + 2 * across && 16 * height == height_px + 2 * down && 2 * across < 16 &&
           2 * down < 16;
}

bool is_usual_sequence(Bytes unit, std::uint32_t width_px, std::uint32_t height_px) {
    BitReader bits(unit.subspan(1));
    const std::uint32_t profile = bits.bits(8);
    bits.bits(16); // constraints, level
    const bool is_first = bits.number() == 0;
    const bool is_known = profile == kBaseline || profile == kMain || (profile == kHigh && is_usual_high(bits));
    const bool is_counted = is_known && bits.number() <= 12 && is_usual_order(bits);
    if (!is_first || !is_counted || bits.number() > kMaxReferences || bits.flag()) {
        return false;
    }
    const std::uint64_t width = std::uint64_t{bits.number()} + 1;
    const std::uint64_t height = std::uint64_t{bits.number()} + 1;
    const bool has_frames_only = bits.flag();
    bits.flag(); // direct_8x8_inference_flag
    return has_frames_only && is_size(bits, width, height, width_px, height_px) && !bits.is_over();
}

bool is_usual_picture_set(Bytes unit) {
    BitReader bits(unit.subspan(1));
    const bool is_first = bits.number() == 0 && bits.number() == 0;
    bits.bits(2); // entropy coding, order of bottom fields
    const bool has_one_group = bits.number() == 0;
    return is_first && has_one_group && bits.number() < kMaxReferences && !bits.is_over();
}

bool is_first_slice(Bytes unit) {
    BitReader bits(unit.subspan(1));
    return bits.number() == 0 && !bits.is_over();
}

std::uint8_t type_of(Bytes unit) {
    return std::to_integer<std::uint8_t>(unit[0]) & 0x1FU;
}

} // namespace

Decoded<void> check_h264_stream(std::span<const std::byte> stream, H264Picture kind, std::uint32_t width_px,
                                std::uint32_t height_px) {
    const auto units = units_of(stream);
    if (!units) {
        return decode_error("H.264: no byte stream");
    }
    const bool is_alone = kind == H264Picture::kAlone;
    const std::size_t first_slice = is_alone ? 2 : 0;
    if (is_alone && (units->size() < 3 || type_of((*units)[0]) != kSequence || type_of((*units)[1]) != kPicture)) {
        return decode_error("H.264: expected a sequence and a picture parameter set, then slices");
    }
    if (is_alone && !is_usual_sequence((*units)[0], width_px, height_px)) {
        return decode_error("H.264: the sequence is not of frames of " + std::to_string(width_px) + "x" +
                            std::to_string(height_px) + ", 4:2:0, 8 bits, one reference");
    }
    if (is_alone && !is_usual_picture_set((*units)[1])) {
        return decode_error("H.264: the picture has slice groups or several references");
    }
    for (std::size_t i = first_slice; i < units->size(); ++i) {
        const Bytes unit = (*units)[i];
        if (type_of(unit) != (is_alone ? kIdrSlice : kSlice) || is_first_slice(unit) != (i == first_slice)) {
            return decode_error("H.264: expected the slices of one picture");
        }
    }
    return {};
}

} // namespace fieldcast::codec
