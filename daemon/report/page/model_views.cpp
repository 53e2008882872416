#include "daemon/report/page/model_views.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/model/linear_model.hpp"
#include "core/model/static_blocks.hpp"
#include "daemon/report/diagnosis/names_of.hpp"
#include "daemon/report/page/series.hpp"

namespace mpm::report {
namespace {

constexpr int kPoints = 300;          // of a step response
constexpr int kLongestStep = 20'000;  // samples
constexpr int kCurvePoints = 61;
constexpr int kLongestSettling = 3'000;  // samples, per point of a curve

struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// Where a signal mostly is: between its 1 % and 99 % quantiles.
Range usual_range(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::vector<double> known;
  for (const double value : values)
    if (std::isfinite(value)) known.push_back(value);
  if (known.empty()) return {};
  const auto quantile = [&known](double share) {
    const auto place =
        known.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(known.size() - 1));
    std::nth_element(known.begin(), place, known.end());
    return *place;
  };
  return {quantile(0.01), quantile(0.99)};
}

std::string with_unit(const SignalName& name) { return axis_text(name.tag, name.unit); }

/// Input `input` of the extended model, in the data.
Range input_range(const DiagnosisRun& run, int input) {
  const auto own = static_cast<int>(run.recording.inputs.cols());
  if (input < own) return usual_range(run.recording.inputs.col(input));
  const int aux = run.diagnosis.new_inputs.at(static_cast<std::size_t>(input - own));
  return usual_range(run.recording.aux.col(aux));
}

Eigen::VectorXd origin(const ModelSpec& spec) {
  if (spec.input_origin.size() == spec.input_count) return spec.input_origin;
  return Eigen::VectorXd::Zero(spec.input_count);
}

/// CVs after a step, minus what they do without it, so that disturbances cancel.
std::vector<double> step_response(const ModelSpec& spec, int cv, int input, double size,
                                  int samples) {
  std::vector<double> response(static_cast<std::size_t>(samples), 0.0);
  if (input >= spec.input_count) return response;
  LinearModel moved(spec), still(spec);
  const Eigen::VectorXd rest = origin(spec);
  Eigen::VectorXd step = rest;
  step(input) += size;
  for (double& value : response) {
    value = (moved.output()(cv) - still.output()(cv)) / size;
    moved.advance(step);
    still.advance(rest);
  }
  return response;
}

double at(const std::vector<double>& values, double index) {
  if (index <= 0.0) return values.front();
  const auto below = static_cast<std::size_t>(index);
  if (below + 1 >= values.size()) return values.back();
  const double share = index - static_cast<double>(below);
  return (1.0 - share) * values[below] + share * values[below + 1];
}

/// The response with another gain, time constant and dead time. `dead`: the model's own dead time,
/// all in samples.
std::vector<double> changed(const std::vector<double>& response, double gain, double slower,
                            double later, double dead) {
  std::vector<double> result;
  for (std::size_t i = 0; i < response.size(); ++i) {
    const double after_dead_time = static_cast<double>(i) - dead - later;
    result.push_back(after_dead_time <= 0.0
                         ? 0.0
                         : gain * at(response, dead + after_dead_time / std::max(slower, 0.01)));
  }
  return result;
}

double dead_samples(const std::vector<double>& response) {
  const auto moves =
      std::find_if(response.begin(), response.end(), [](double value) { return value != 0.0; });
  const auto count = static_cast<double>(moves - response.begin());
  return moves == response.end() ? 0.0 : std::max(0.0, count - 1.0);
}

/// Factors of the new value at the ends of its interval; none where that is not known.
std::vector<double> factors(const OldAndNew& number) {
  if (!std::isfinite(number.low) || number.new_value == 0.0) return {1.0};
  return {number.low / number.new_value, 1.0, number.high / number.new_value};
}

/// The hull of `after` and of each corner of the intervals.
void add_band(const ChannelNumbers& channel, double sample_time_s, StepView& view) {
  const OldAndNew& late = channel.dead_time;
  const bool one_lag = channel.time_constants.size() == 1;
  const std::vector<double> slowness =
      one_lag ? factors(channel.time_constants.front()) : std::vector<double>{1.0};
  std::vector<double> shifts = {0.0};
  if (std::isfinite(late.low))
    shifts = {(late.low - late.new_value) / sample_time_s, 0.0,
              (late.high - late.new_value) / sample_time_s};
  const std::vector<double> gains = factors(channel.gain);
  if (gains.size() * slowness.size() * shifts.size() == 1) return;
  const double dead = dead_samples(view.after);
  view.low = view.high = view.after;
  for (const double gain : gains)
    for (const double slower : slowness)
      for (const double later : shifts) {
        const std::vector<double> corner = changed(view.after, gain, slower, later, dead);
        for (std::size_t i = 0; i < corner.size(); ++i) {
          view.low[i] = std::min(view.low[i], corner[i]);
          view.high[i] = std::max(view.high[i], corner[i]);
        }
      }
}

void keep_every(std::vector<double>& values, int every) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); i += static_cast<std::size_t>(every))
    values[kept++] = values[i];
  values.resize(kept);
}

// --- static curves ---

std::vector<double> spaced(Range range) {
  std::vector<double> x;
  x.reserve(kCurvePoints);
  for (int i = 0; i < kCurvePoints; ++i)
    x.push_back(range.low + (range.high - range.low) * i / (kCurvePoints - 1));
  return x;
}

Range widened(Range range) {
  const double margin = 0.1 * (range.high - range.low);
  return {range.low - margin, range.high + margin};
}

bool remembers(const std::optional<InputBlock>& block) {
  return block &&
         (std::holds_alternative<Deadband>(*block) || std::holds_alternative<Stiction>(*block));
}

/// After whatever begins at some time.
constexpr double kAfterAll = std::numeric_limits<double>::infinity();

/// What the linear part sees, in input units, while the input goes along `x`.
std::vector<double> sweep(const std::optional<InputBlock>& block, double origin,
                          const std::vector<double>& x) {
  InputElement element(block, origin);
  element.reset(x.front());
  std::vector<double> y;
  for (int round = 0; round < 2; ++round) {  // the first one only settles the block
    y.clear();
    for (const double value : x) y.push_back(origin + element.apply(value, kAfterAll));
  }
  return y;
}

void add_input_curve(const DiagnosisRun& run, int cv, int input, const std::string& title,
                     const std::optional<InputBlock>& before,
                     const std::optional<InputBlock>& after, std::vector<CurveView>& curves) {
  CurveView curve;
  curve.cv = cv;
  curve.input = input;
  curve.x = spaced(widened(input_range(run, input)));
  if (curve.x.front() == curve.x.back()) return;
  if (remembers(before) || remembers(after)) {
    const std::vector<double> up = curve.x;
    curve.x.insert(curve.x.end(), up.rbegin(), up.rend());
  }
  const double at_rest = origin(run.diagnosis.extended)(input);
  curve.before = sweep(before, at_rest, curve.x);
  curve.after = sweep(after, at_rest, curve.x);
  if (curve.before == curve.after) return;
  const SignalNames names = names_of(run);
  curve.title = title;
  curve.x_label = with_unit(names.input(input));
  curve.y_label = with_unit({"acts like", names.input(input).unit});
  curves.push_back(std::move(curve));
}

void add_output_curve(const DiagnosisRun& run, int cv, std::vector<CurveView>& curves) {
  const auto block = [cv](const ModelSpec& spec) {
    const auto i = static_cast<std::size_t>(cv);
    return i < spec.output_blocks.size() ? spec.output_blocks[i] : std::nullopt;
  };
  const ModelSpec& extended = run.diagnosis.extended;
  const double at_rest = extended.output_origin.size() > cv ? extended.output_origin(cv) : 0.0;
  CurveView curve;
  curve.cv = cv;
  curve.x = spaced(widened(usual_range(run.recording.cvs.col(cv))));
  for (const double x : curve.x) {
    curve.before.push_back(apply_output_block(block(run.unit.model), at_rest, x - at_rest));
    curve.after.push_back(apply_output_block(block(extended), at_rest, x - at_rest));
  }
  if (curve.before == curve.after || curve.x.front() == curve.x.back()) return;
  const SignalName name = names_of(run).cv(cv);
  curve.title = "what " + name.tag + " reads";
  curve.x_label = with_unit({name.tag + " without it", name.unit});
  curve.y_label = with_unit(name);
  curves.push_back(std::move(curve));
}

bool nonlinear_state(const ModelSpec& spec, int cv, int input) {
  const auto here = [&](const auto& each) { return each.cv == cv && each.input == input; };
  return std::any_of(spec.state_terms.begin(), spec.state_terms.end(), here) ||
         std::any_of(spec.channels.begin(), spec.channels.end(), [&](const ChannelSpec& channel) {
           return here(channel) && std::holds_alternative<TankChain>(channel.dynamics);
         });
}

/// The CV at rest for each held value of the input. From each one to the next, so that it settles
/// soon.
std::vector<double> steady_curve(const ModelSpec& spec, int cv, int input,
                                 const std::vector<double>& x) {
  ModelSpec undisturbed = spec;
  undisturbed.disturbances.clear();
  LinearModel model(undisturbed);
  const int settling = std::min(kLongestSettling, 2 * model.settling_samples());
  Eigen::VectorXd held = origin(spec);
  std::vector<double> y;
  for (const double value : x) {
    held(input) = value;
    for (int i = 0; i < settling; ++i) model.advance(held);
    y.push_back(model.output()(cv));
  }
  return y;
}

void add_steady_curve(const DiagnosisRun& run, int cv, int input, std::vector<CurveView>& curves) {
  const ModelSpec& extended = run.diagnosis.extended;
  if (!nonlinear_state(extended, cv, input) && !nonlinear_state(run.unit.model, cv, input)) return;
  if (input >= run.unit.model.input_count || LinearModel(extended).integrating()(cv, input)) return;
  CurveView curve;
  curve.cv = cv;
  curve.input = input;
  curve.x = spaced(input_range(run, input));
  if (curve.x.front() == curve.x.back()) return;
  curve.before = steady_curve(run.unit.model, cv, input, curve.x);
  curve.after = steady_curve(extended, cv, input, curve.x);
  const SignalNames names = names_of(run);
  curve.title = names.cv(cv).tag + " at rest";
  curve.x_label = with_unit(names.input(input));
  curve.y_label = with_unit(names.cv(cv));
  curves.push_back(std::move(curve));
}

template <class Block>
std::optional<Block> block_of(const std::vector<std::optional<Block>>& blocks, int index) {
  const auto i = static_cast<std::size_t>(index);
  return i < blocks.size() ? blocks[i] : std::nullopt;
}

const ChannelSpec* channel_of(const ModelSpec& spec, int cv, int input) {
  for (const ChannelSpec& channel : spec.channels)
    if (channel.cv == cv && channel.input == input) return &channel;
  return nullptr;
}

}  // namespace

StepView step_view(const DiagnosisRun& run, const ChannelNumbers& channel) {
  const ModelSpec& model = run.unit.model;
  const ModelSpec& extended = run.diagnosis.extended;
  const int settling = std::max(LinearModel(model).settling_samples(0.01, kLongestStep),
                                LinearModel(extended).settling_samples(0.01, kLongestStep));
  const int samples = std::min(kLongestStep, settling + settling / 5 + 5);
  const int every = (samples + kPoints - 1) / kPoints;
  StepView view;
  view.cv = channel.cv;
  view.input = channel.input;
  const Range range = input_range(run, channel.input);
  if (range.high > range.low) view.size = (range.high - range.low) / 2.0;
  view.spacing_s = model.sample_time_s * every;
  view.before = step_response(model, channel.cv, channel.input, view.size, samples);
  view.after = step_response(extended, channel.cv, channel.input, view.size, samples);
  add_band(channel, model.sample_time_s, view);
  for (auto* values : {&view.before, &view.after, &view.low, &view.high})
    keep_every(*values, every);
  return view;
}

std::vector<double> seen_of_command(const ModelSpec& spec, int cv, int input,
                                    const std::vector<double>& command) {
  std::optional<InputBlock> block = block_of(spec.input_blocks, input);
  const ChannelSpec* channel = cv < 0 ? nullptr : channel_of(spec, cv, input);
  if (channel != nullptr && channel->input_block) block = channel->input_block;
  const double at_rest = origin(spec)(input);
  InputElement element(block, at_rest);
  std::vector<double> seen;
  double last = at_rest;
  for (const double value : command) {
    if (std::isfinite(value)) last = value;
    if (seen.empty()) element.reset(last);
    seen.push_back(at_rest + element.apply(last, kAfterAll));
  }
  return seen;
}

std::vector<CurveView> curve_views(const DiagnosisRun& run) {
  const ModelSpec& model = run.unit.model;
  const ModelSpec& extended = run.diagnosis.extended;
  const SignalNames names = names_of(run);
  std::vector<CurveView> curves;
  for (int input = 0; input < extended.input_count; ++input)
    add_input_curve(run, -1, input, "what " + names.input(input).tag + " does",
                    block_of(model.input_blocks, input), block_of(extended.input_blocks, input),
                    curves);
  for (const ChannelSpec& channel : extended.channels) {
    const ChannelSpec* own = channel_of(model, channel.cv, channel.input);
    const std::optional<InputBlock> before = own == nullptr ? std::nullopt : own->input_block;
    if (before || channel.input_block)
      add_input_curve(
          run, channel.cv, channel.input,
          "what " + names.input(channel.input).tag + " does to " + names.cv(channel.cv).tag, before,
          channel.input_block, curves);
  }
  for (int cv = 0; cv < extended.cv_count; ++cv) {
    add_output_curve(run, cv, curves);
    for (int input = 0; input < extended.input_count; ++input)
      add_steady_curve(run, cv, input, curves);
  }
  return curves;
}

}  // namespace mpm::report
