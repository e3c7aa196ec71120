// SPDX-License-Identifier: Apache-2.0
// core/lightfield's vocabulary and that of the messages are one: same numbers, same words.
#include "core/lightfield/vocabulary.h"

#include "fieldcast/v1/light_field.pb.h"

#include <algorithm>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>
#include <set>

namespace fieldcast {
namespace {

/// "svgf+" -> "_SVGF_PLUS", "g-buffer" -> "_G_BUFFER".
std::string as_in_messages(std::string_view word) {
    std::string name("_");
    for (const char c : word) {
        if (c == '+') {
            name += "_PLUS";
        } else {
            name += c == '-' ? '_' : static_cast<char>(std::toupper(c));
        }
    }
    return name;
}

/// Every value of `Enum` is in the message's enumeration under a name that begins or ends with its word, and the other
/// way round; number 0 stands for no value there.
template <class Enum> void expect_same(const google::protobuf::EnumDescriptor& messages) {
    std::set<int> theirs;
    for (int i = 0; i < messages.value_count(); ++i) {
        theirs.insert(messages.value(i)->number());
    }
    EXPECT_EQ(theirs.erase(0), 1U) << messages.name();
    std::set<std::string_view> words;
    for (const Enum value : kAll<Enum>) {
        const int number = static_cast<int>(value);
        EXPECT_TRUE(words.insert(word_of(value)).second) << word_of(value) << " stands for two values";
        EXPECT_EQ(from_word<Enum>(word_of(value)), value);
        ASSERT_EQ(theirs.erase(number), 1U) << messages.name() << " has no number " << number;
        const std::string& name = messages.FindValueByNumber(number)->name();
        EXPECT_NE(name.find(as_in_messages(word_of(value))), std::string::npos) << name << ", " << word_of(value);
    }
    EXPECT_TRUE(theirs.empty()) << messages.name() << " has number " << *theirs.begin() << ", the vocabulary has not";
}

TEST(Vocabulary, IsThatOfTheMessages) {
    expect_same<PlaneFormat>(*v1::PlaneFormat_descriptor());
    expect_same<PlaneSemantic>(*v1::PlaneSemantic_descriptor());
    expect_same<Codec>(*v1::Codec_descriptor());
    expect_same<DeliveryMode>(*v1::DeliveryMode_descriptor());
    expect_same<PlaneSet>(*v1::PlaneSet_descriptor());
    expect_same<WarpPlane>(*v1::WarpPlane_descriptor());
    expect_same<Denoiser>(*v1::Denoiser_descriptor());
    expect_same<DenoisedImages>(*v1::DenoisedImages_descriptor());
}

TEST(Vocabulary, NumbersThatAreNoValuesHaveNone) {
    EXPECT_FALSE(from_number<Codec>(0).has_value());
    EXPECT_FALSE(from_number<Codec>(5).has_value());
    EXPECT_FALSE(from_number<Codec>(0x101).has_value()) << "not that of its low byte";
    EXPECT_FALSE(from_word<Codec>("").has_value());
    EXPECT_FALSE(from_word<Codec>("zst").has_value());
}

TEST(Vocabulary, EveryPlaneCanBeSentLossless) {
    for (const PlaneSemantic semantic : kAll<PlaneSemantic>) {
        EXPECT_TRUE(std::ranges::any_of(kAll<Codec>, [&](Codec codec) {
            return !is_lossy(codec) && carries(codec, usual_format(semantic));
        })) << word_of(semantic);
        EXPECT_TRUE(may_have_format(semantic, usual_format(semantic)));
    }
}

TEST(Vocabulary, PicturesAreWhatLossyCodecsCarry) {
    std::string pictures;
    for (const PlaneSemantic semantic : kAll<PlaneSemantic>) {
        if (is_picture(semantic)) {
            pictures.append(" ").append(word_of(semantic));
        }
    }
    EXPECT_EQ(pictures, " diffuse specular colour residual_colour total_light");
}

TEST(Vocabulary, ListsItsWordsForPeople) {
    EXPECT_EQ(alternatives<DeliveryMode>(), "views, scene or warp");
    EXPECT_EQ(alternatives<Codec>(), "raw, zstd, jpeg or h264");
    EXPECT_EQ(alternatives<Codec>(std::span(kAll<Codec>).first(1)), "raw");
}

TEST(Vocabulary, AFrameHasThePlanesOfItsMode) {
    using enum PlaneSemantic;
    const auto with_residual = std::array{WarpPlane::kResidual, WarpPlane::kId};
    EXPECT_EQ(planes_of(DeliveryMode::kViews, PlaneSet::kWithGBuffer, with_residual), std::vector{kColour});
    EXPECT_EQ(planes_of(DeliveryMode::kScene, PlaneSet::kTotalLight, with_residual), std::vector{kTotalLight});
    EXPECT_EQ(planes_of(DeliveryMode::kWarp, PlaneSet::kTotalLight, with_residual),
              (std::vector{kColour, kInverseDepth, kResidualColour, kResidualInverseDepth, kId}));
}

} // namespace
} // namespace fieldcast
