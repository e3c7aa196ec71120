// SPDX-License-Identifier: Apache-2.0
#include "server/recording/form.h"

#include "core/base/error.h"

#include <array>
#include <charconv>
#include <vector>

namespace fieldcast::recording {

namespace {

std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(':', begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

bool read_kind(const std::string& word, Form& form) {
    if (word == "views") {
        form.kind = Form::Kind::kViews;
    } else if (word == "planes") {
        form.kind = Form::Kind::kIllumination;
    } else if (word == "g-buffer") {
        form.kind = Form::Kind::kGBuffer;
    } else {
        return false;
    }
    return true;
}

bool read_codec(const std::string& word, Form& form) {
    if (word == "raw") {
        form.codec = codec::CodecId::kRaw;
    } else if (word == "zstd") {
        form.codec = codec::CodecId::kZstdFiltered;
    } else if (word == "jpeg") {
        form.codec = codec::CodecId::kJpeg;
    } else {
        return false;
    }
    return true;
}

bool read_quality(const std::string& word, Form& form) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), form.quality);
    return error == std::errc{} && end == word.data() + word.size() && form.quality >= 1 &&
           form.quality <= codec::kMaxQuality && codec::is_lossy(form.codec);
}

codec::Encoding encoding_of(const Form& form, const feed::ChannelInfo& channel) {
    const std::uint8_t quality = form.quality != 0 ? form.quality : channel.lossy_quality;
    return {.codec = form.codec, .quality = codec::is_lossy(form.codec) ? quality : std::uint8_t{0}};
}

feed::PlanesWish planes_of(const Form& form, const feed::ChannelInfo& channel) {
    feed::PlanesWish wish;
    for (const PlaneSemantic semantic : {PlaneSemantic::kDiffuse, PlaneSemantic::kSpecular}) {
        wish.choices.push_back({.semantic = semantic, .encoding = encoding_of(form, channel)});
    }
    if (form.kind == Form::Kind::kGBuffer) {
        for (const PlaneSemantic semantic :
             {PlaneSemantic::kDepth, PlaneSemantic::kNormal, PlaneSemantic::kId, PlaneSemantic::kMaterial}) {
            wish.choices.push_back({.semantic = semantic});
        }
    }
    return wish;
}

} // namespace

std::optional<Form> parse_form(const std::string& text) {
    const std::vector<std::string> words = words_of(text);
    Form form;
    if (!read_kind(words[0], form)) {
        return std::nullopt;
    }
    std::size_t next = 1;
    if (form.kind == Form::Kind::kViews && next < words.size()) {
        if (const auto grid = parse_grid(words[next])) {
            form.grid = grid;
            ++next;
            const auto size = next < words.size() ? parse_grid(words[next]) : std::nullopt; // WxH reads like RxC
            if (size) {
                form.size_px = glm::uvec2(size->rows, size->cols);
                ++next;
            }
        }
    }
    if (next < words.size() && read_codec(words[next], form)) {
        ++next;
        if (next < words.size() && read_quality(words[next], form)) {
            ++next;
        }
    }
    return next == words.size() ? std::optional(form) : std::nullopt;
}

feed::Wish wish_of(const Form& form, const feed::ChannelInfo& channel) {
    if (form.kind != Form::Kind::kViews) {
        return planes_of(form, channel);
    }
    ViewGrid grid = form.grid.value_or(channel.largest_grid);
    grid.geometry = channel.largest_grid.geometry;
    const glm::uvec2 source(channel.source_width_px, channel.source_height_px);
    const glm::uvec2 size = form.size_px.value_or(source);
    const std::string place = "recording of channel '" + channel.name + "': ";
    if (const auto problem = grid_problem(grid)) {
        throw UserError(place + *problem);
    }
    if (size.x == 0 || size.y == 0 || size.x > source.x || size.y > source.y) {
        throw UserError(place + "views of " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                        " pixels; sides are at least 1 and at most the source's, " + std::to_string(source.x) + "x" +
                        std::to_string(source.y));
    }
    return feed::ViewsWish{.format = {.geometry = grid.geometry,
                                      .fovy_rad = channel.fovy_rad,
                                      .width_px = size.x,
                                      .height_px = size.y,
                                      .encoding = encoding_of(form, channel)},
                           .grid = grid};
}

} // namespace fieldcast::recording
