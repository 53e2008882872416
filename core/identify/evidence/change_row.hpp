#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/identify/evidence/channel_tests.hpp"
#include "core/identify/fit/recording.hpp"
#include "core/model/model_spec.hpp"

namespace mpm {

/// Row from which on some CV's channels do what they did not do before (`ChangeScan`), of several
/// CVs the most certain one. Only CVs of which `tests` rejects a channel are asked: elsewhere what
/// wanders would be dated. Nothing where none did, in several runs, and where the recording is too
/// long to remember. Arguments as of `ChannelTests`.
[[nodiscard]] std::optional<Eigen::Index> change_row(const ModelSpec& model,
                                                     const Recording& recording,
                                                     const Eigen::MatrixXd& residuals,
                                                     const ChannelTests& tests);

}  // namespace mpm
