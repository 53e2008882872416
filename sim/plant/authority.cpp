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
  for (const config::Authority& authority : authorities_)
    acting_(authority.input) += authority.per_unit *
                                (input(authority.input) - origin_(authority.input)) *
                                (input(authority.of) - origin_(authority.of));
  process_->advance(acting_);
}

}  // namespace mpm::sim
