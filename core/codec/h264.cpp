// SPDX-License-Identifier: Apache-2.0
#include "core/codec/h264.h"

#include "core/codec/h264_stream.h"
#include "core/codec/video_picture.h"

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <wels/codec_api.h>

namespace fieldcast::codec {

namespace {

using Bytes = std::vector<std::byte>;

struct EncoderEnd {
    void operator()(ISVCEncoder* encoder) const {
        encoder->Uninitialize();
        WelsDestroySVCEncoder(encoder);
    }
};

struct DecoderEnd {
    void operator()(ISVCDecoder* decoder) const {
        decoder->Uninitialize();
        WelsDestroyDecoder(decoder);
    }
};

using Encoder = std::unique_ptr<ISVCEncoder, EncoderEnd>;
using Decoder = std::unique_ptr<ISVCDecoder, DecoderEnd>;

/// Quantiser: 24 for quality 75, 6 (twice the step) per 19 of quality.
int quantiser(std::uint8_t quality) {
    return static_cast<int>(std::lround(48.0 - 0.32 * quality));
}

void set_sizes(SEncParamExt& options, const VideoPicture& picture, std::uint8_t quality) {
    constexpr float kAnyRate = 30.0F; // nothing depends on it without rate control
    constexpr int kAnyBits = 5'000'000;
    options.iPicWidth = static_cast<int>(picture.width_px);
    options.iPicHeight = static_cast<int>(picture.height_px);
    options.fMaxFrameRate = kAnyRate;
    options.iTargetBitrate = kAnyBits;
    options.iSpatialLayerNum = 1;
    SSpatialLayerConfig& layer = options.sSpatialLayers[0];
    layer.iVideoWidth = options.iPicWidth;
    layer.iVideoHeight = options.iPicHeight;
    layer.fFrameRate = kAnyRate;
    layer.iSpatialBitrate = kAnyBits;
    layer.iDLayerQp = quantiser(quality);
    layer.uiProfileIdc = PRO_HIGH;
    layer.sSliceArgument.uiSliceMode = SM_SINGLE_SLICE;
}

/// Uses one quantiser for the whole picture, no adaptation and one thread, so that equal pictures become equal bytes.
Encoder make_encoder(const VideoPicture& picture, std::uint8_t quality) {
    ISVCEncoder* made = nullptr;
    if (WelsCreateSVCEncoder(&made) != 0) {
        throw std::runtime_error("OpenH264 cannot create an encoder");
    }
    SEncParamExt options;
    made->GetDefaultParams(&options);
    options.iUsageType = CAMERA_VIDEO_REAL_TIME;
    options.iRCMode = RC_OFF_MODE;
    options.iComplexityMode = LOW_COMPLEXITY;
    options.iEntropyCodingModeFlag = 1;
    options.iNumRefFrame = 1;
    options.iMultipleThreadIdc = 1;
    options.bEnableFrameSkip = false;
    options.bEnableBackgroundDetection = false;
    options.bEnableAdaptiveQuant = false;
    options.bEnableSceneChangeDetect = false;
    set_sizes(options, picture, quality);
    int quiet = WELS_LOG_QUIET;
    made->SetOption(ENCODER_OPTION_TRACE_LEVEL, &quiet);
    if (made->InitializeExt(&options) != 0) {
        WelsDestroySVCEncoder(made);
        throw std::runtime_error("OpenH264 cannot encode pictures of " + std::to_string(picture.width_px) + "x" +
                                 std::to_string(picture.height_px));
    }
    return Encoder(made);
}

Bytes encode(ISVCEncoder& encoder, VideoPicture& picture) {
    SSourcePicture source{};
    source.iColorFormat = videoFormatI420;
    source.iPicWidth = static_cast<int>(picture.width_px);
    source.iPicHeight = static_cast<int>(picture.height_px);
    source.iStride[0] = source.iPicWidth;
    source.iStride[1] = source.iStride[2] = source.iPicWidth / 2;
    source.pData[0] = picture.luma.data();
    source.pData[1] = picture.blue.data();
    source.pData[2] = picture.red.data();
    SFrameBSInfo coded{};
    if (encoder.EncodeFrame(&source, &coded) != cmResultSuccess || coded.eFrameType == videoFrameTypeSkip) {
        throw std::runtime_error("OpenH264 did not encode a picture");
    }
    Bytes bytes;
    for (int i = 0; i < coded.iLayerNum; ++i) {
        const SLayerBSInfo& layer = coded.sLayerInfo[i];
        int size = 0;
        for (int unit = 0; unit < layer.iNalCount; ++unit) {
            size += layer.pNalLengthInByte[unit];
        }
        const auto* const begin = reinterpret_cast<const std::byte*>(layer.pBsBuf);
        bytes.insert(bytes.end(), begin, begin + size);
    }
    return bytes;
}

Decoder make_decoder() {
    ISVCDecoder* made = nullptr;
    if (WelsCreateDecoder(&made) != 0) {
        throw std::runtime_error("OpenH264 cannot create a decoder");
    }
    Decoder decoder(made);
    int quiet = WELS_LOG_QUIET;
    decoder->SetOption(DECODER_OPTION_TRACE_LEVEL, &quiet);
    SDecodingParam options{};
    options.sVideoProperty.eVideoBsType = VIDEO_BITSTREAM_AVC;
    options.eEcActiveIdc = ERROR_CON_DISABLE; // damage is an error and is never concealed
    if (decoder->Initialize(&options) != 0) {
        throw std::runtime_error("OpenH264 cannot initialise its decoder");
    }
    return decoder;
}

/// A decoded picture; its samples belong to the decoder.
struct Output {
    std::array<std::uint8_t*, 3> channels{};
    SBufferInfo facts{};

    bool is_picture() const { return facts.iBufferStatus == 1; }
};

/// Empty if the picture is damaged. The decoder keeps a picture back in case an earlier one follows, so it is flushed.
std::optional<Output> decode(ISVCDecoder& decoder, std::span<const std::byte> stream) {
    Output output;
    const auto* const bytes = reinterpret_cast<const unsigned char*>(stream.data());
    if (decoder.DecodeFrameNoDelay(bytes, static_cast<int>(stream.size()), output.channels.data(), &output.facts) !=
        dsErrorFree) {
        return std::nullopt;
    }
    if (!output.is_picture()) {
        output = {};
        decoder.FlushFrame(output.channels.data(), &output.facts);
    }
    return output.is_picture() ? std::optional(output) : std::nullopt;
}

} // namespace

std::vector<std::byte> encode_h264(std::span<const std::byte> rgb, RgbSize size, std::uint8_t quality) {
    VideoPicture picture = video_from_rgb(rgb, size);
    return encode(*make_encoder(picture, quality), picture);
}

std::vector<std::byte> encode_h264_from(std::span<const std::byte> base, std::span<const std::byte> rgb, RgbSize size,
                                        std::uint8_t quality) {
    VideoPicture first = video_from_rgb(base, size);
    VideoPicture picture = video_from_rgb(rgb, size);
    const Encoder encoder = make_encoder(picture, quality);
    encode(*encoder, first);
    return encode(*encoder, picture);
}

Decoded<void> decode_h264(std::span<const std::byte> base, std::span<const std::byte> picture, RgbSize size,
                          std::span<std::byte> rgb) {
    const std::uint32_t width_px = video_side(size.width_px);
    const std::uint32_t height_px = video_side(size.row_count);
    if (width_px > kMaxH264Side || height_px > kMaxH264Side) {
        return decode_error("H.264: sides are at most " + std::to_string(kMaxH264Side));
    }
    const Decoder decoder = make_decoder();
    if (!base.empty()) {
        if (auto checked = check_h264_stream(base, H264Picture::kAlone, width_px, height_px); !checked) {
            return checked;
        }
        if (!decode(*decoder, base)) {
            return decode_error("H.264: the base is damaged");
        }
    }
    const auto kind = base.empty() ? H264Picture::kAlone : H264Picture::kPredicted;
    if (auto checked = check_h264_stream(picture, kind, width_px, height_px); !checked) {
        return checked;
    }
    const auto output = decode(*decoder, picture);
    if (!output) {
        return decode_error("H.264: the picture is damaged");
    }
    const SSysMEMBuffer& buffer = output->facts.UsrData.sSystemBuffer;
    if (buffer.iWidth != static_cast<int>(width_px) || buffer.iHeight != static_cast<int>(height_px)) {
        return decode_error("H.264: the picture has another size");
    }
    const auto channel = [&](std::size_t index, int stride) {
        return VideoChannel{output->channels[index], static_cast<std::size_t>(stride)};
    };
    rgb_from_video(channel(0, buffer.iStride[0]), channel(1, buffer.iStride[1]), channel(2, buffer.iStride[1]), size,
                   rgb);
    return {};
}

} // namespace fieldcast::codec
