#include "core/identify/fit/simulator.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "core/identify/fit/calibration.hpp"
#include "core/identify/fit/channel_edit.hpp"
#include "core/identify/fit/convolution.hpp"
#include "core/identify/fit/initial_state.hpp"
#include "core/model/disturbance.hpp"
#include "core/model/fir_channel.hpp"
#include "core/model/linear_model.hpp"
#include "core/model/static_blocks.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Memory that what is remembered may take, in bytes.
constexpr std::size_t kRemembered = std::size_t{1} << 27;

/// In the key of a disturbance, where that of a channel says how its first run begins (0 or 1).
constexpr double kDisturbance = -1.0;

/// What the output of a channel or a disturbance depends on, as bytes.
class Key {
 public:
  void add(double value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    text_.append(bytes, sizeof value);
  }
  void add(const std::vector<double>& values) {
    add(static_cast<double>(values.size()));
    for (const double value : values) add(value);
  }
  void add(const TransferFunction& v) {
    add(v.gain), add(v.time_constants_s), add(v.lead_s), add(v.dead_time_s), add(v.integrating);
  }
  void add(const DiscreteFilter& v) { add(v.numerator), add(v.denominator), add(v.delay_samples); }
  void add(const StepResponse& v) { add(v.values); }
  void add(const TankChain& v) {
    add(v.time_constants_s), add(v.empty_input), add(v.empty_output), add(v.overflow);
    add(v.spill), add(v.dead_time_s);
  }
  void add(const Polynomial& v) { add(v.coefficients); }
  void add(const Saturation& v) { add(v.low), add(v.high); }
  void add(const Deadband& v) { add(v.width); }
  void add(const Stiction& v) { add(v.band), add(v.jump), add(v.slips_once); }
  void add(const Stuck& v) { add(v.value), add(v.onset_s); }
  void add(const InputOffset& v) { add(v.size), add(v.onset_s); }
  void add(const TwoSided& v) { add(v.above), add(v.below), add(v.at); }
  void add(const Product& v) { add(v.of), add(v.per_unit), add(v.linear); }
  void add(const RestoringForce& v) { add(v.quadratic), add(v.cubic); }
  void add(const SquareRootOutflow& v) { add(v.empty_output); }
  void add(const CoulombFriction& v) { add(v.force), add(v.speed); }
  void add(const DisturbanceTerm& v) {
    add(static_cast<double>(v.shape)), add(v.onset_s), add(v.size), add(v.until_s);
    add(v.time_constant_s), add(v.decay_s), add(v.period_s), add(v.square);
  }
  template <class... Types>
  void add(const std::variant<Types...>& value) {
    add(static_cast<double>(value.index()));
    std::visit([this](const auto& held) { add(held); }, value);
  }
  template <class Type>
  void add(const std::optional<Type>& value) {
    add(value ? 1.0 : 0.0);
    if (value) add(*value);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

double first_finite(const Eigen::Ref<const VectorXd>& values, double otherwise) {
  for (const double value : values)
    if (std::isfinite(value)) return value;
  return otherwise;
}

const StateTerm* state_term(const ModelSpec& model, const ChannelSpec& channel) {
  for (const StateTerm& term : model.state_terms)
    if (term.cv == channel.cv && term.input == channel.input) return &term;
  return nullptr;
}

}  // namespace

Simulator::Simulator(const Recording& recording)
    : recording_(&recording), runs_(runs_of(recording)) {}

VectorXd Simulator::simulate(const ModelSpec& model, const ChannelSpec& spec,
                             const Starts& at_origin) const {
  ModelSpec one = alone(spec, model.sample_time_s);
  one.input_origin = VectorXd::Constant(1, model.input_origin(spec.input));
  one.output_origin = VectorXd::Constant(1, model.output_origin(spec.cv));
  if (const StateTerm* term = state_term(model, spec)) one.state_terms = {{0, 0, term->block}};

  const auto inputs = recording_->inputs.cols();
  const auto given_input = [&](int i) -> Eigen::Ref<const VectorXd> {
    if (i >= inputs) return recording_->aux.col(i - inputs);
    return recording_->inputs.col(i);
  };
  const Eigen::Ref<const VectorXd> all = given_input(spec.input);
  const double origin = model.input_origin(spec.input);
  const auto other_deviations = [&](const InputElement& element, const Run& run) {
    VectorXd deviations = VectorXd::Zero(run.count);
    if (element.other() < 0) return deviations;
    const Eigen::Ref<const VectorXd> moves_of_all = given_input(element.other());
    const Eigen::Ref<const VectorXd> moves = moves_of_all.segment(run.first, run.count);
    const double rest = model.input_origin(element.other());
    double last = first_finite(moves, rest);
    for (Index k = 0; k < run.count; ++k) {
      if (std::isfinite(moves(k))) last = moves(k);
      deviations(k) = last - rest;
    }
    return deviations;
  };
  // The blocks by hand, so that the linear part sees a plain input.
  InputElement own(model.input_blocks[static_cast<std::size_t>(spec.input)], origin);
  InputElement channels(spec.input_block, origin);
  const double sample_time_s = model.sample_time_s;
  const double start_s = recording_->start_s + kSameMoment * sample_time_s;
  LinearModel simulator(one);
  const auto* response = std::get_if<StepResponse>(&spec.dynamics);
  const bool plain_response = response != nullptr && one.state_terms.empty();
  const VectorXd impulse =
      plain_response ? VectorXd(make_fir_channel(0, 0, *response).channel.weights.reverse())
                     : VectorXd();
  VectorXd input(1), output(all.size());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const Run& run = runs_[r];
    const auto given = all.segment(run.first, run.count);
    const VectorXd own_other = other_deviations(own, run), other = other_deviations(channels, run);
    const double own_other_first = at_origin[r] ? 0.0 : own_other(0);
    const double other_first = at_origin[r] ? 0.0 : other(0);
    const auto time_s = [&](Index k) {
      return start_s + static_cast<double>(run.first + k) * sample_time_s;
    };
    VectorXd moved(run.count);
    const double first = at_origin[r] ? origin : first_finite(given, origin);
    own.reset(first);
    const double first_moved = origin + own.apply(first, time_s(-1), own_other_first);
    channels.reset(first_moved);
    const double rest = origin + channels.apply(first_moved, time_s(-1), other_first);
    double last = first_finite(given, origin);
    for (Index k = 0; k < run.count; ++k) {
      if (std::isfinite(given(k))) last = given(k);
      const double acting = origin + own.apply(last, time_s(k), own_other(k));
      moved(k) = origin + channels.apply(acting, time_s(k), other(k));
    }
    if (plain_response) {  // as long as the data, often
      output.segment(run.first, run.count) =
          convolved(impulse, moved.array() - origin, rest - origin);
      continue;
    }
    input(0) = rest;
    simulator.reset_steady(input);
    for (Index k = 0; k < run.count; ++k) {
      output(run.first + k) = simulator.output()(0) - one.output_origin(0);
      input(0) = moved(k);
      simulator.advance(input);
    }
  }
  return output;
}

template <class Make>
Simulator::Given Simulator::remembered(const std::string& key, const Make& make) {
  {
    const MutexLock lock(mutex_);
    const auto found = remembered_.find(key);
    if (found != remembered_.end()) return found->second;
  }
  // Two threads may do the same, which gives the same.
  const auto made = std::make_shared<const VectorXd>(make());
  const std::size_t size = key.size() + sizeof(double) * static_cast<std::size_t>(made->size());
  const MutexLock lock(mutex_);
  if (bytes_ + size > kRemembered) remembered_.clear(), bytes_ = 0;
  const auto [place, fresh] = remembered_.emplace(key, made);
  if (fresh) bytes_ += size;
  return place->second;
}

Simulator::Given Simulator::channel(const ModelSpec& model, const ChannelSpec& spec,
                                    const Starts& at_origin) {
  Key key;
  for (const bool start : at_origin) key.add(start ? 1.0 : 0.0);
  key.add(static_cast<double>(spec.input));
  key.add(model.input_origin(spec.input));
  key.add(model.output_origin(spec.cv));
  key.add(spec.dynamics);
  key.add(spec.input_block);
  key.add(model.input_blocks[static_cast<std::size_t>(spec.input)]);
  for (const std::optional<InputBlock>* block :
       {&spec.input_block, &model.input_blocks[static_cast<std::size_t>(spec.input)]})
    if (const int other = other_input(*block); other >= 0) key.add(model.input_origin(other));
  const StateTerm* term = state_term(model, spec);
  key.add(term ? 1.0 : 0.0);
  if (term) key.add(term->block);
  return remembered(key.text(), [&]() -> VectorXd {
    try {
      return simulate(model, spec, at_origin);
    } catch (const std::invalid_argument&) {  // a fit tried what is no model
      return VectorXd::Constant(recording_->samples(), std::numeric_limits<double>::quiet_NaN());
    }
  });
}

Simulator::Given Simulator::disturbance(const DisturbanceTerm& term, double sample_time_s) {
  Key key;
  key.add(kDisturbance);
  key.add(term);
  return remembered(key.text(), [&] {
    VectorXd output(recording_->samples());
    for (Index k = 0; k < output.size(); ++k)
      output(k) = disturbance_at(term, recording_->start_s + static_cast<double>(k) * sample_time_s,
                                 kSameMoment * sample_time_s);
    return output;
  });
}

VectorXd Simulator::sum_of_channels(const ModelSpec& model, int cv, const Starts& at_origin) {
  VectorXd sum = VectorXd::Zero(recording_->samples());
  for (const ChannelSpec& spec : model.channels)
    if (spec.cv == cv) sum += *channel(model, spec, at_origin);
  return sum;
}

const Simulator::Starts& Simulator::starts(const ModelSpec& model) {
  std::call_once(begun_, [&] { at_origin_ = first_starts(model); });
  return at_origin_;
}

Simulator::Starts Simulator::first_starts(const ModelSpec& model) {
  const Starts none(runs_.size(), false), all(runs_.size(), true);
  std::vector<double> votes(runs_.size(), 0.0);
  for (int cv = 0; cv < model.cv_count; ++cv) {
    const VectorXd shift = VectorXd::Constant(recording_->samples(), model.output_origin(cv));
    const VectorXd from_origin = shift + sum_of_channels(model, cv, all);
    const VectorXd from_inputs = shift + sum_of_channels(model, cv, none);
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const auto [first, count] = runs_[r];
      const auto measured = recording_->cvs.col(cv).segment(first, count);
      const double at_origin = first_error(from_origin.segment(first, count), measured);
      const double at_inputs = first_error(from_inputs.segment(first, count), measured);
      if (at_origin + at_inputs > 0.0)
        votes[r] += (at_inputs - at_origin) / (at_inputs + at_origin);
    }
  }
  Starts at_origin;
  for (const double vote : votes) at_origin.push_back(vote > 0.0);
  return at_origin;
}

VectorXd Simulator::cv(const ModelSpec& model, int cv) {
  const Index samples = recording_->samples();
  VectorXd sum = sum_of_channels(model, cv, starts(model));
  for (const DisturbanceTerm& term : model.disturbances)
    if (term.cv == cv) sum += *disturbance(term, model.sample_time_s);
  const double origin = model.output_origin(cv);
  const std::optional<OutputBlock>& block = model.output_blocks[static_cast<std::size_t>(cv)];
  for (Index k = 0; k < samples; ++k) sum(k) = apply_output_block(block, origin, sum(k));
  return sum;
}

ModelSpec with_aux_inputs(const ModelSpec& model, const Recording& recording) {
  ModelSpec result = model;
  const auto aux = static_cast<int>(recording.aux.cols());
  result.input_count += aux;
  result.input_blocks.resize(static_cast<std::size_t>(result.input_count));
  result.input_origin.conservativeResize(result.input_count);
  for (int a = 0; a < aux; ++a) {
    double sum = 0.0;
    Index count = 0;
    for (const double value : recording.aux.col(a))
      if (std::isfinite(value)) sum += value, ++count;
    result.input_origin(model.input_count + a) = count > 0 ? sum / static_cast<double>(count) : 0.0;
  }
  return result;
}

}  // namespace mpm
