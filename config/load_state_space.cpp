#include <algorithm>
#include <utility>

#include "config/load_sections.hpp"
#include "config/yaml_text.hpp"
#include "core/identify/fit/calibration.hpp"
#include "core/model/eigenvalues.hpp"
#include "core/text/number_text.hpp"

namespace mpm::config {
namespace {

constexpr Eigen::Index kMostStates = 500;
constexpr double kUnitCircle = 1.0 + 1e-6;
constexpr double kSettled = 1e-12;  // of the largest states that a pulse left

std::string shape(Eigen::Index rows, Eigen::Index cols) {
  return std::to_string(rows) + " x " + std::to_string(cols);
}

/// Rows of numbers; nothing (reported) where they are not of one length.
std::optional<Eigen::MatrixXd> read_matrix(const Value& value) {
  const std::vector<Value> rows = value.items();
  Eigen::MatrixXd matrix;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<double> row = rows[i].numbers();
    const std::size_t length = rows[i].items().size();
    if (row.size() != length) return std::nullopt;
    if (i == 0) matrix.resize(static_cast<Eigen::Index>(rows.size()), static_cast<int>(length));
    if (static_cast<Eigen::Index>(length) != matrix.cols()) {
      rows[i].error("this row has " + counted(length, "number") + ", the first one " +
                    std::to_string(matrix.cols()));
      return std::nullopt;
    }
    for (std::size_t j = 0; j < length; ++j)
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = row[j];
  }
  return matrix;
}

std::optional<Eigen::MatrixXd> read_matrix(const Map& map, std::string_view key) {
  const Value* value = map.require(key);
  return value != nullptr ? read_matrix(*value) : std::nullopt;
}

bool has_shape(const Map& map, std::string_view key, const Eigen::MatrixXd& matrix,
               Eigen::Index rows, Eigen::Index cols, const std::string& why) {
  if (matrix.rows() == rows && matrix.cols() == cols) return true;
  map.find(key)->error("must be " + shape(rows, cols) + " (" + why + "), not " +
                       shape(matrix.rows(), matrix.cols()));
  return false;
}

/// Whether every step response is made of numbers, as far as any program looks at one.
bool stays_finite(const StateSpaceSpec& system) {
  Eigen::MatrixXd states = system.b;
  Eigen::MatrixXd response = system.d;
  double largest = 0.0;
  for (int k = 0; k < kLongestResponse + 2; ++k) {
    response += system.c * states;
    if (!response.allFinite()) return false;
    const double size = states.cwiseAbs().maxCoeff();
    largest = std::max(largest, size);
    if (size <= kSettled * largest) break;
    states = system.a * states;
  }
  return true;
}

}  // namespace

void load_state_space(const Map& map, UnitConfig& config) {
  const Eigen::Index inputs = config.model.input_count;
  const Eigen::Index cvs = config.model.cv_count;
  const std::optional<Eigen::MatrixXd> a = read_matrix(map, "A");
  const std::optional<Eigen::MatrixXd> b = read_matrix(map, "B");
  const std::optional<Eigen::MatrixXd> c = read_matrix(map, "C");
  std::optional<Eigen::MatrixXd> d = Eigen::MatrixXd(Eigen::MatrixXd::Zero(cvs, inputs));
  if (map.find("D") != nullptr) d = read_matrix(map, "D");
  if (!a || !b || !c || !d) return;

  const Eigen::Index states = a->rows();
  if (states == 0 || states > kMostStates) {
    map.find("A")->error("must have 1 to " + std::to_string(kMostStates) + " rows");
    return;
  }
  bool fits = has_shape(map, "A", *a, states, states, "square");
  fits &= has_shape(map, "B", *b, states, inputs, "states x MVs and DVs");
  fits &= has_shape(map, "C", *c, cvs, states, "CVs x states");
  fits &= map.find("D") == nullptr || has_shape(map, "D", *d, cvs, inputs, "CVs x MVs and DVs");
  Eigen::VectorXd x0;
  if (const Value* start = map.find("x0")) {
    const std::vector<double> numbers = start->numbers();
    if (numbers.size() != start->items().size()) return;
    x0 = Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<int>(numbers.size()));
    if (x0.size() != states && x0.size() != 0) {
      start->error("must have " + counted(static_cast<std::uint64_t>(states), "number") +
                   ", one per state");
      return;
    }
  }
  if (!fits) return;
  StateSpaceSpec system{*a, *b, *c, *d, x0};
  if (!stays_finite(system)) {
    map.find("A")->error("has a response that no number can hold within " +
                         std::to_string(kLongestResponse) + " samples");
    return;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(*a, false);
  if (solver.info() == Eigen::Success) {
    const double pole = solver.eigenvalues().cwiseAbs().maxCoeff();
    if (pole > kUnitCircle)
      map.find("A")->warning("is unstable: an eigenvalue at |z| = " + yaml_text(pole));
  }
  config.model.state_space = std::move(system);
}

}  // namespace mpm::config
