#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "config/scenario_config.hpp"
#include "sim/plant/process.hpp"

namespace mpm::sim {

/// A process some of whose inputs do more or less than they say, by how far another one is from its
/// operating point (two valves on one pipe): at the operating point nothing shows.
class WithAuthority : public Process {
 public:
  /// `origin`: of the inputs, own units; aux inputs behind them have none.
  WithAuthority(std::unique_ptr<Process> process, std::vector<config::Authority> authorities,
                Eigen::VectorXd origin);

  [[nodiscard]] int input_count() const override { return process_->input_count(); }
  void set_time_s(double time_s) override { process_->set_time_s(time_s); }
  [[nodiscard]] const Eigen::VectorXd& output() const override { return process_->output(); }
  void advance(const Eigen::Ref<const Eigen::VectorXd>& input) override;

 private:
  std::unique_ptr<Process> process_;
  std::vector<config::Authority> authorities_;
  Eigen::VectorXd origin_, acting_;
};

}  // namespace mpm::sim
