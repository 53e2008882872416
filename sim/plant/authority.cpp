#include "sim/plant/authority.hpp"

#include <utility>

namespace mpm::sim {

WithAuthority::WithAuthority(std::unique_ptr<Process> process,
                             std::vector<config::Authority> authorities, Eigen::VectorXd origin)
    : process_(std::move(process)),
      authorities_(std::move(authorities)),
      origin_(std::move(origin)),
      acting_(Eigen::VectorXd::Zero(process_->input_count())) {}

void WithAuthority::advance(const Eigen::Ref<const Eigen::VectorXd>& input) {
  acting_ = input;
  for (const config::Authority& authority : authorities_) {
    const double away = input(authority.input) - origin_(authority.input);
    double gain = away < 0.0 ? authority.below : authority.above;
    if (authority.of >= 0)
      gain *= 1.0 + authority.per_unit * (input(authority.of) - origin_(authority.of));
    acting_(authority.input) += (gain - 1.0) * away;
  }
  process_->advance(acting_);
}

}  // namespace mpm::sim
