#include "tests/boiler/samples.hpp"

#include <cmath>
#include <memory>

#include "config/load_unit.hpp"
#include "core/model/linear_model.hpp"
#include "daemon/bag/open_recording.hpp"
#include "tests/boiler/workshop.hpp"

namespace mpm::boiler {
namespace {

using report::Series;

void take(const SignalBlock& block, std::vector<Series>& series) {
  series.resize(static_cast<std::size_t>(block.values.size()));
  for (std::size_t i = 0; i < series.size(); ++i)
    series[i].push_back(block.values(static_cast<Eigen::Index>(i)));
}

}  // namespace

config::UnitConfig unit_of(const std::string& file) {
  config::LoadResult loaded = config::load_unit(file, config::ModelNeed::kMayBeMissing);
  if (loaded.ok()) return std::move(loaded.config);
  throw StoryError(config::format(loaded.findings.front()));
}

Samples samples_of(const std::string& recording, const config::UnitConfig& unit) {
  const std::unique_ptr<files::FrameSource> source = bag::open_recording(recording, unit);
  Samples samples;
  for (Frame frame(unit.counts()); source->next(frame);) {
    take(frame[SignalKind::kMv], samples.mvs);
    take(frame[SignalKind::kCv], samples.cvs);
    take(frame[SignalKind::kSetpoint], samples.setpoints);
  }
  return samples;
}

std::vector<Series> free_run(const config::UnitConfig& unit, const Samples& measured) {
  LinearModel model(unit.model);
  std::vector<Series> cvs(measured.cvs.size());
  Eigen::VectorXd inputs(model.input_count());
  for (std::size_t k = 0; k < measured.cvs.front().size(); ++k) {
    for (Eigen::Index i = 0; i < inputs.size(); ++i)
      inputs(i) = measured.mvs[static_cast<std::size_t>(i)][k];
    if (k == 0) model.reset_steady(inputs);
    for (std::size_t j = 0; j < cvs.size(); ++j)
      cvs[j].push_back(model.output()(static_cast<Eigen::Index>(j)));
    model.advance(inputs);
  }
  for (std::size_t j = 0; j < cvs.size(); ++j) {
    const double level = mean_of(measured.cvs[j]) - mean_of(cvs[j]);
    for (double& value : cvs[j]) value += level;
  }
  return cvs;
}

double mean_of(const Series& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double spread_of(const Series& values) {
  const double mean = mean_of(values);
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

double rms_difference(const Series& a, const Series& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace mpm::boiler
