#pragma once

#include <Eigen/Core>

namespace mpm {

class Archive;

/// Nonlinear functions of a point: what a regression takes as columns beside the linear ones.
class FeatureMap {
 public:
  FeatureMap(int dimension, int outputs) : dimension_(dimension), outputs_(outputs) {}
  virtual ~FeatureMap() = default;
  FeatureMap(const FeatureMap&) = delete;
  FeatureMap& operator=(const FeatureMap&) = delete;

  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] int outputs() const { return outputs_; }

  /// Fits itself to standardised points (dimension x count, count >= 2) like those to come. May
  /// allocate.
  virtual void begin(const Eigen::Ref<const Eigen::MatrixXd>& points) = 0;
  /// outputs() values for a point of dimension() values. No allocation. Before `begin` all 0.
  virtual void apply(const double* point, double* features) const = 0;
  /// What `begin` made of the points.
  virtual void archive(Archive& a) = 0;

 private:
  int dimension_, outputs_;
};

}  // namespace mpm
