#pragma once

#include "tests/boiler/story.hpp"

namespace mpm::boiler {

/// What the page shows of a story; of report::page_html(). In the workshop's folder.
[[nodiscard]] Json page_data(const Story& story);

}  // namespace mpm::boiler
