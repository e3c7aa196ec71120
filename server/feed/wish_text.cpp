// SPDX-License-Identifier: Apache-2.0
#include "server/feed/wish.h"

namespace fieldcast::feed {

namespace {

const char* word_of(PlaneSemantic semantic) {
    switch (semantic) {
    case PlaneSemantic::kDiffuse:
        return "diffuse";
    case PlaneSemantic::kSpecular:
        return "specular";
    case PlaneSemantic::kDepth:
        return "depth";
    case PlaneSemantic::kNormal:
        return "normal";
    case PlaneSemantic::kId:
        return "id";
    case PlaneSemantic::kMaterial:
        return "material";
    case PlaneSemantic::kColour:
        return "colour";
    case PlaneSemantic::kInverseDepth:
        return "inverse depth";
    case PlaneSemantic::kResidualColour:
        return "residual colour";
    case PlaneSemantic::kResidualInverseDepth:
        return "residual inverse depth";
    case PlaneSemantic::kTotalLight:
        return "total light";
    }
    return "unknown";
}

std::string size_text(std::uint32_t a, std::uint32_t b) {
    return std::to_string(a) + "x" + std::to_string(b);
}

std::string text(const PlanesWish& wish) {
    std::string list;
    for (const wire::PlaneChoice& choice : wish.choices) {
        list += (list.empty() ? "planes " : ", ") + std::string(word_of(choice.semantic)) + " " +
                (choice.format == PlaneFormat::kOct2x8 ? "oct2x8 " : "") + to_text(choice.encoding);
    }
    return list;
}

std::string text(const ViewsWish& wish) {
    return "views " + size_text(wish.grid.rows, wish.grid.cols) + " of " +
           size_text(wish.format.width_px, wish.format.height_px) + " " + to_text(wish.format.encoding);
}

} // namespace

std::string to_text(const Wish& wish) {
    return std::visit([](const auto& kind) { return text(kind); }, wish);
}

std::string to_text(const codec::Encoding& encoding) {
    switch (encoding.codec) {
    case codec::CodecId::kRaw:
        return "raw";
    case codec::CodecId::kZstdFiltered:
        return "zstd";
    case codec::CodecId::kJpeg:
        return "jpeg " + std::to_string(encoding.quality);
    case codec::CodecId::kH264:
        return "h264 " + std::to_string(encoding.quality);
    }
    return "unknown";
}

} // namespace fieldcast::feed
