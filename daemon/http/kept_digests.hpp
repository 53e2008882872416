#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "daemon/history/digest.hpp"

namespace mpm::http {

/// What the journal of a unit in `folder` says, oldest first: of its last files, as many as hold no
/// more than `most_bytes`. Where there is no journal, or one that is none, nothing; of a damaged
/// file what stands before the damage.
void for_each_kept_digest(const std::string& folder, const std::string& unit,
                          std::uint64_t most_bytes,
                          const std::function<void(const history::Digest&)>& take);

}  // namespace mpm::http
