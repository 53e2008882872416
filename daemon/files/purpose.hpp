#pragma once

namespace mpm::files {

/// What a file is read for: to judge the unit, or to keep whatever of it is there.
enum class Purpose { kJudge, kKeep };

}  // namespace mpm::files
