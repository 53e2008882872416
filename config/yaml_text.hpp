#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

/// Values as YAML that reads back as the same value.
namespace mpm::config {

[[nodiscard]] std::string yaml_text(double value);
[[nodiscard]] std::string yaml_text(int value);
[[nodiscard]] std::string yaml_text(bool value);
/// Quoted unless it is a plain word that YAML takes for nothing else.
[[nodiscard]] std::string yaml_text(const std::string& text);
[[nodiscard]] std::string yaml_text(const std::vector<double>& values);
[[nodiscard]] std::string yaml_text(const std::vector<std::string>& values);
[[nodiscard]] std::string yaml_text(const Eigen::MatrixXd& matrix);

}  // namespace mpm::config
