#pragma once

#include <cstddef>
#include <string>

#include "daemon/report/identification/identification_run.hpp"

namespace mpm::report {

/// Columns of the sentences.
inline constexpr std::size_t kReasonWidth = 96;

/// The word that programs go by: `identified`, `no_relation`, ...
[[nodiscard]] std::string reason_word(LeftOut left_out);

/// Why a channel is not in the model, for a person; empty where it is.
[[nodiscard]] std::string reason_text(const IdentificationRun& run, const ChannelAnswer& answer);

/// What makes one doubt the model as a whole, a sentence each.
[[nodiscard]] std::vector<std::string> doubts_of_model(const IdentificationRun& run);

}  // namespace mpm::report
