#pragma once

#include "tests/boiler/story.hpp"

/// The page's chapters, in the order of the thesis's chapter 5.
namespace mpm::boiler {

[[nodiscard]] Json rest_chapter(const Story& story);
[[nodiscard]] Json model_chapter(const Story& story);
[[nodiscard]] Json commissioning_chapter(const Story& story);
[[nodiscard]] Json change_chapter(const Story& story);
[[nodiscard]] Json diagnosis_chapter(const Story& story);
[[nodiscard]] Json repair_chapter(const Story& story);
[[nodiscard]] Json others_chapter(const Story& story);

}  // namespace mpm::boiler
