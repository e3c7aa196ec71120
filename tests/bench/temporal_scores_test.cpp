// SPDX-License-Identifier: Apache-2.0
#include "bench/quality/temporal_scores.h"

#include <cmath>
#include <gtest/gtest.h>

namespace fieldcast::bench {
namespace {

image::RgbF32 grey(float value) {
    return {4, 3, std::vector<glm::vec3>(12, glm::vec3(value))};
}

/// Every pixel was where it is now.
image::Correspondence at_rest() {
    image::Correspondence map{4, 3, {}};
    for (std::size_t i = 0; i < 12; ++i) {
        map.place.emplace_back(glm::vec2(static_cast<float>(i % 4) + 0.5F, static_cast<float>(i / 4) + 0.5F));
    }
    return map;
}

// Differences of 0.25 and 0.125 are exact in single precision.
TEST(TemporalScores, SubtractTheReferencesOwnChange) {
    TemporalScores scores;
    const SuccessivePictures reference{grey(0.25F), grey(0.375F)};
    scores.add({grey(0.5F), grey(0.75F)}, &reference, at_rest());
    const auto json = scores.to_json();
    EXPECT_EQ(json["warped_error"], 0.25);
    EXPECT_EQ(json["warped_error_excess"], 0.125);
    EXPECT_TRUE(json["flicker"].is_null());
}

TEST(TemporalScores, HaveNoExcessWhileReferencesAreMissing) {
    TemporalScores scores;
    const SuccessivePictures reference{grey(0.25F), grey(0.375F)};
    scores.add({grey(0.5F), grey(0.75F)}, &reference, at_rest());
    scores.add({grey(0.5F), grey(0.5F)}, nullptr, at_rest());
    EXPECT_EQ(scores.to_json()["warped_error"], 0.125);
    EXPECT_TRUE(scores.to_json()["warped_error_excess"].is_null());
}

TEST(TemporalScores, LeaveOutViewsThatShowNothingOfBefore) {
    image::Correspondence nothing = at_rest();
    nothing.place.assign(12, std::nullopt);
    TemporalScores scores;
    scores.add({grey(0.5F), grey(0.75F)}, nullptr, nothing);
    EXPECT_TRUE(scores.to_json()["warped_error"].is_null());
}

TEST(TemporalScores, MeanFlickerOverViews) {
    TemporalScores scores;
    scores.add_at_rest({0, 0}, grey(0.5F));
    scores.add_at_rest({0, 2}, grey(0.5F));
    scores.add_at_rest({0, 0}, grey(0.5F));
    scores.add_at_rest({0, 2}, grey(0.75F));
    // One view does not change; the other's deviation is 0.25 / √2.
    EXPECT_NEAR(scores.to_json()["flicker"].get<double>(), 0.125 / std::sqrt(2.0), 1e-9);
}

} // namespace
} // namespace fieldcast::bench
