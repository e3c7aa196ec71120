// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/named_picture.h"
#include "bench/picture_id.h"
#include "report/page.h"

#include <nlohmann/json.hpp>

namespace fieldcast::bench {

/// One picture made by every row, and its reference.
struct ShownPictures {
    PictureId id;
    std::vector<NamedPicture> pictures;
};

/// The report of a result of `quality`. If `shown` has no pictures, the report has none.
report::Page quality_page(const nlohmann::ordered_json& result, const ShownPictures& shown);

} // namespace fieldcast::bench
