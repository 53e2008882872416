// A kernel and its approximations on given points, to be compared with a peer's on the same ones:
//   bench_kernel POINTS exact | gram | nystrom LANDMARKS COMPONENTS | random FREQUENCIES
// POINTS: a text file, "dimension count" and then the points, a line each; behind them, of `exact`,
// one value of a response per point. Prints "microseconds values" (per point; of `exact` and `gram`
// of all; before them the ridge of `exact`, and the kernel's width of `gram` and `nystrom`) and
// then the numbers, row by row: the fitted values, the kernel matrix, the features.
#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/nonlinear/kernel.hpp"
#include "core/nonlinear/kernel_ridge.hpp"
#include "core/nonlinear/nystrom_map.hpp"
#include "core/nonlinear/random_map.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kRepeats = 5;
constexpr std::uint64_t kSeed = 1;

struct Given {
  MatrixXd points;  // dimension x count
  VectorXd response;
};

Given read(const std::string& path) {
  std::ifstream file(path);
  Index dimension = 0, count = 0;
  if (!(file >> dimension >> count)) throw std::runtime_error("cannot read " + path);
  Given given{MatrixXd(dimension, count), VectorXd::Zero(count)};
  for (Index p = 0; p < count; ++p)
    for (Index d = 0; d < dimension; ++d) file >> given.points(d, p);
  if (!file) throw std::runtime_error(path + ": too few numbers");
  for (double& value : given.response) file >> value;
  return given;
}

/// Of this process: what others do meanwhile does not count.
double computing_time_us() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

double microseconds(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const double begin = computing_time_us();
    work();
    times.push_back(computing_time_us() - begin);
  }
  std::nth_element(times.begin(), times.begin() + kRepeats / 2, times.end());
  return times[kRepeats / 2];
}

void print(double took, const MatrixXd& values) {
  std::cout << took << ' ' << values.size() << '\n' << std::setprecision(17);
  for (Index row = 0; row < values.rows(); ++row) {
    for (Index column = 0; column < values.cols(); ++column)
      std::cout << values(row, column) << ' ';
    std::cout << '\n';
  }
}

/// Its features of all points, count x outputs, and the time of one of them.
void print_features(FeatureMap& map, const MatrixXd& points) {
  map.begin(points);
  MatrixXd features(map.outputs(), points.cols());
  const double took = microseconds([&] {
    for (Index p = 0; p < points.cols(); ++p)
      map.apply(points.col(p).data(), features.col(p).data());
  });
  print(took / static_cast<double>(points.cols()), features.transpose());
}

int run(const std::vector<std::string>& arguments) {
  const Given given = read(arguments.at(0));
  const std::string& what = arguments.at(1);
  const auto number = [&](std::size_t i) { return std::atoi(arguments.at(i).c_str()); };
  const auto dimension = static_cast<int>(given.points.rows());
  const Kernel kernel{KernelKind::kGaussian, median_bandwidth(given.points)};
  if (what == "nystrom") {
    NystromMap map(dimension, KernelKind::kGaussian, number(2), number(3));
    map.begin(given.points);
    std::cout << std::setprecision(17) << map.kernel().bandwidth << ' ';
    print_features(map, given.points);
  } else if (what == "random") {
    RandomMap map(dimension, number(2), kSeed);
    print_features(map, given.points);
  } else if (what == "gram") {
    MatrixXd gram;
    const double took = microseconds([&] { gram = kernel_matrix(kernel, given.points); });
    std::cout << std::setprecision(17) << kernel.bandwidth << ' ';
    print(took, gram);
  } else if (what == "exact") {
    const VectorXd constant = VectorXd::Ones(given.points.cols());
    KernelFit fit;
    const double took = microseconds(
        [&] { fit = fit_kernel(kernel_matrix(kernel, given.points), constant, given.response); });
    std::cout << fit.ridge << ' ';
    print(took, fit.fitted);
  } else {
    throw std::invalid_argument("no such thing: " + what);
  }
  return 0;
}

}  // namespace
}  // namespace mpm

int main(int argc, char** argv) {
  try {
    return mpm::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "bench_kernel: " << error.what() << '\n';
    return 2;
  }
}
