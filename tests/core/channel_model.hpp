#pragma once

#include <utility>
#include <vector>

#include "core/model/model_spec.hpp"

namespace mpm::test {

/// A model of these channels, about an operating point of zeros, sampled each second.
inline ModelSpec channel_model(int inputs, int cvs, std::vector<ChannelSpec> channels) {
  ModelSpec spec;
  spec.sample_time_s = 1.0;
  spec.input_count = inputs;
  spec.cv_count = cvs;
  spec.input_blocks.resize(static_cast<std::size_t>(inputs));
  spec.output_blocks.resize(static_cast<std::size_t>(cvs));
  spec.input_origin = Eigen::VectorXd::Zero(inputs);
  spec.output_origin = Eigen::VectorXd::Zero(cvs);
  spec.channels = std::move(channels);
  return spec;
}

}  // namespace mpm::test
