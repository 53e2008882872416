#include "daemon/report/page/channel_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "core/identify/fit/quantity.hpp"
#include "core/model/linear_model.hpp"
#include "daemon/report/diagnosis/extended_unit.hpp"
#include "daemon/report/page/wording.hpp"

namespace mpm::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNoticeable = 0.05;  ///< of a gain or a time constant

struct Numbers {
  double gain = OldAndNew::kUnknown;
  double curve = 1.0;  ///< of the gain: slope of what bends the input
  std::vector<double> time_constants;
  double lead = OldAndNew::kUnknown;
  double dead_time = OldAndNew::kUnknown;
  bool integrating = false;
};

template <class Block>
const Block* find_block(const std::vector<std::optional<Block>>& blocks, int index) {
  const auto i = static_cast<std::size_t>(index);
  return i < blocks.size() && blocks[i] ? &*blocks[i] : nullptr;
}

/// At so much from the origin.
double slope(const InputBlock* block, double at, double origin) {
  if (const auto* sides = block == nullptr ? nullptr : std::get_if<TwoSided>(block))
    return at < (std::isfinite(sides->at) ? sides->at - origin : 0.0) ? sides->below : sides->above;
  const auto* polynomial = block == nullptr ? nullptr : std::get_if<Polynomial>(block);
  if (polynomial == nullptr || polynomial->coefficients.empty()) return 1.0;
  double sum = 0.0, power = 1.0;
  for (std::size_t i = 0; i < polynomial->coefficients.size(); ++i, power *= at)
    sum += static_cast<double>(i + 1) * polynomial->coefficients[i] * power;
  return sum;
}

double slope(const OutputBlock* block) {
  const auto* scale = block == nullptr ? nullptr : std::get_if<Scale>(block);
  return scale == nullptr ? 1.0 : scale->factor;
}

void add_times(const TransferFunction& dynamics, double, Numbers& numbers) {
  numbers.time_constants = dynamics.time_constants_s;
  numbers.lead = dynamics.lead_s;
  numbers.dead_time = dynamics.dead_time_s;
}
void add_times(const TankChain& dynamics, double, Numbers& numbers) {
  numbers.time_constants = dynamics.time_constants_s;
  numbers.dead_time = dynamics.dead_time_s;
}
void add_times(const DiscreteFilter& dynamics, double sample_time_s, Numbers& numbers) {
  numbers.dead_time = dynamics.delay_samples * sample_time_s;
}
void add_times(const StepResponse&, double, Numbers&) {}

/// A model as the table needs it.
class Source {
 public:
  /// `operated`: the inputs at which gains are read, from their origin; none: there.
  explicit Source(const ModelSpec& spec, std::vector<double> operated = {})
      : spec_(spec), operated_(std::move(operated)) {
    if (spec.channels.empty() && !spec.state_space) return;
    const LinearModel model(spec);
    gain_ = model.steady_gain();
    integrating_ = model.integrating();
  }

  [[nodiscard]] std::optional<Numbers> operator()(int cv, int input) const {
    if (cv >= gain_.rows() || input >= gain_.cols()) return std::nullopt;
    const auto channel =
        std::find_if(spec_.channels.begin(), spec_.channels.end(),
                     [&](const ChannelSpec& each) { return each.cv == cv && each.input == input; });
    if (channel == spec_.channels.end() && (!spec_.state_space || gain_(cv, input) == 0.0))
      return std::nullopt;
    Numbers numbers;
    numbers.integrating = integrating_(cv, input);
    const auto at = static_cast<std::size_t>(input);
    const double operated = at < operated_.size() ? operated_[at] : 0.0;
    const double origin = spec_.input_origin.size() != 0 ? spec_.input_origin(input) : 0.0;
    numbers.curve = slope(find_block(spec_.input_blocks, input), operated, origin);
    if (channel != spec_.channels.end() && channel->input_block)
      numbers.curve *= slope(&*channel->input_block, operated, origin);
    numbers.gain = gain_(cv, input) * numbers.curve * slope(find_block(spec_.output_blocks, cv));
    if (numbers.integrating) numbers.gain /= spec_.sample_time_s;
    if (channel != spec_.channels.end()) {
      std::visit([&](const auto& each) { add_times(each, spec_.sample_time_s, numbers); },
                 channel->dynamics);
    }
    return numbers;
  }

 private:
  const ModelSpec& spec_;
  std::vector<double> operated_;
  Eigen::MatrixXd gain_;
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> integrating_;
};

ChannelNumbers compared(int cv, int input, const std::optional<Numbers>& before,
                        const std::optional<Numbers>& after) {
  ChannelNumbers result;
  result.cv = cv;
  result.input = input;
  const std::size_t lags = std::max(before ? before->time_constants.size() : 0,
                                    after ? after->time_constants.size() : 0);
  result.time_constants.resize(lags);
  if (before) {
    result.integrating = before->integrating;
    result.gain.old_value = before->gain;
    result.lead.old_value = before->lead;
    result.dead_time.old_value = before->dead_time;
    for (std::size_t i = 0; i < before->time_constants.size(); ++i)
      result.time_constants[i].old_value = before->time_constants[i];
  }
  if (after) {
    result.integrating = after->integrating;
    result.gain.new_value = after->gain;
    result.lead.new_value = after->lead;
    result.dead_time.new_value = after->dead_time;
    for (std::size_t i = 0; i < after->time_constants.size(); ++i)
      result.time_constants[i].new_value = after->time_constants[i];
  }
  return result;
}

/// Where what the extended model has lies outside, the interval is that of another explanation.
void set_interval(OldAndNew& number, double low, double high) {
  if (low > high) std::swap(low, high);
  const double margin = 1e-9 * (std::abs(low) + std::abs(high));
  if (number.new_value < low - margin || number.new_value > high + margin) return;
  number.low = low;
  number.high = high;
}

/// Ratios and differences to the given model; a gain's beside what a curve makes of it, `curve`.
void set_intervals(const Parameter* gain, const Parameter* time_constant,
                   const Parameter* dead_time, double curve, ChannelNumbers& channel) {
  const double old_gain = curve * channel.gain.old_value;
  if (gain != nullptr) set_interval(channel.gain, old_gain * gain->low, old_gain * gain->high);
  if (time_constant != nullptr)
    for (OldAndNew& lag : channel.time_constants)
      set_interval(lag, lag.old_value * time_constant->low, lag.old_value * time_constant->high);
  if (dead_time != nullptr) {
    OldAndNew& late = channel.dead_time;
    set_interval(late, std::max(0.0, late.old_value + dead_time->low),
                 late.old_value + dead_time->high);
  }
}

const Parameter* by_name(const Finding& finding, const char* name) {
  for (const Parameter& each : finding.parameters)
    if (each.name() == name) return &each;
  return nullptr;
}

void set_interval(OldAndNew& number, const Parameter* parameter) {
  if (parameter != nullptr) set_interval(number, parameter->low, parameter->high);
}

/// A finding knows better than the channel fitted by itself.
void set_intervals(const Finding& finding, double curve, ChannelNumbers& channel) {
  set_intervals(finding.find(kGainRatio), finding.find(kTimeConstantRatio),
                finding.find(kDeadTimeError), curve, channel);
  if (std::isfinite(channel.gain.old_value)) return;
  set_interval(channel.gain, by_name(finding, "gain"));
  if (channel.time_constants.size() == 1)
    set_interval(channel.time_constants.front(), by_name(finding, "time_constant"));
  if (const Parameter* late = by_name(finding, "dead_time"))
    set_interval(channel.dead_time, std::max(0.0, late->low), late->high);
}

/// The extended model's input that the finding is about; -1: it names none.
int input_of(const DiagnosisRun& run, const Place& place) {
  if (place.aux < 0) return place.input;
  const std::vector<int>& taken = run.diagnosis.new_inputs;
  const auto at = std::find(taken.begin(), taken.end(), place.aux);
  return at == taken.end() ? -2 : run.unit.counts().inputs() + static_cast<int>(at - taken.begin());
}

std::string unit_of(const ChannelNumbers& channel, const config::UnitConfig& unit) {
  const auto input = static_cast<std::size_t>(channel.input);
  const std::string& per =
      input < unit.mv.size() ? unit.mv[input].unit : unit.dv.at(input - unit.mv.size()).unit;
  const std::string& cv = unit.cv.at(static_cast<std::size_t>(channel.cv)).unit;
  std::string text = cv.empty() ? "" : cv + (per.empty() ? "" : " per " + per);
  if (channel.integrating) text += text.empty() ? "per s" : " and s";
  return text;
}

/// The unit file has a pair as its sampled form, which has neither time nor dead time.
void set_pair(const ChannelAnswer& answer, ChannelNumbers& channel) {
  channel.time_constants.resize(1);
  channel.time_constants.front().new_value = answer.pair->time;
  channel.dead_time.new_value = answer.dynamics->dead_time_s;
  channel.damping.emplace();
  channel.damping->new_value = answer.pair->damping;
  if (answer.damping) set_interval(*channel.damping, answer.damping->low, answer.damping->high);
}

/// RFC 4180.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char letter : text) quoted += letter == '"' ? "\"\"" : std::string(1, letter);
  return quoted + '"';
}

std::string csv_number(double value) {
  if (!std::isfinite(value)) return {};
  std::ostringstream out;
  out.precision(6);
  out << value;
  return out.str();
}

struct Row {
  std::string name, unit;
  const OldAndNew& number;
};

std::string csv_of(const std::vector<ChannelNumbers>& channels, const config::UnitConfig& unit) {
  std::string text = "cv,input,number,unit,old,new,low,high\n";
  for (const ChannelNumbers& channel : channels) {
    std::vector<Row> rows = {{"gain", unit_of(channel, unit), channel.gain}};
    for (const OldAndNew& each : channel.time_constants)
      rows.push_back({"time constant", "s", each});
    if (channel.damping) rows.push_back({"damping", "", *channel.damping});
    if (channel.has_lead()) rows.push_back({"lead", "s", channel.lead});
    rows.push_back({"dead time", "s", channel.dead_time});
    for (const auto& [name, of, number] : rows) {
      if (!std::isfinite(number.old_value) && !std::isfinite(number.new_value)) continue;
      text += csv_text(unit.cv.at(static_cast<std::size_t>(channel.cv)).tag) + ',' +
              csv_text(unit.input_tag(channel.input)) + ',' + name + ',' + csv_text(of);
      for (const double value : {number.old_value, number.new_value, number.low, number.high})
        text += ',' + csv_number(value);
      text += '\n';
    }
  }
  return text;
}

/// Whether the new number is another than the old one by more than `most`.
bool differ(const OldAndNew& number, double most) {
  if (std::isnan(number.old_value) && std::isnan(number.new_value)) return false;
  return !(std::abs(number.new_value - number.old_value) <= most);
}

bool differ_by_share(const OldAndNew& number) {
  return differ(number, kNoticeable * std::abs(number.old_value));
}

Json cell(const std::string& before, const std::string& after, const std::string& range,
          const std::string& unit, bool changed) {
  const auto known = [](const std::string& text) { return text.empty() ? "\u2013" : text; };
  return {{"old", known(before)},
          {"new", known(after)},
          {"interval", range},
          {"unit", unit},
          {"changed", changed}};
}

Json gain_json(const OldAndNew& number, const std::string& unit) {
  const bool estimated = std::isfinite(number.low);
  return cell(
      rounded(number.old_value),
      estimated ? rounded(number.new_value, number.low, number.high) : rounded(number.new_value),
      interval(number.new_value, number.low, number.high), unit, differ_by_share(number));
}

Json times_json(const std::vector<OldAndNew>& numbers, bool changed) {
  std::string before, after, range;
  const auto add = [](std::string& list, const std::string& text) {
    list += (list.empty() || text.empty() ? "" : ", ") + text;
  };
  for (const OldAndNew& each : numbers) {
    if (std::isfinite(each.old_value)) add(before, duration(each.old_value));
    if (std::isfinite(each.new_value)) add(after, duration(each.new_value, each.low, each.high));
    add(range, duration_interval(each.new_value, each.low, each.high));
  }
  return cell(before, after, range, "", changed);
}

/// "15.8 s, damping 0.8", "12 s, lead 4 s"
Json lags_json(const ChannelNumbers& channel, bool changed) {
  Json json = times_json(channel.time_constants, changed);
  if (channel.damping)
    json["new"] =
        json["new"].get<std::string>() + ", damping " + rounded(channel.damping->new_value);
  const auto add_lead = [&](const char* key, double lead) {
    if (channel.has_lead() && std::isfinite(lead))
      json[key] = json[key].get<std::string>() + ", lead " + duration(lead);
  };
  add_lead("old", channel.lead.old_value);
  add_lead("new", channel.lead.new_value);
  return json;
}

double median(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::vector<double> known;
  for (const double value : values)
    if (std::isfinite(value)) known.push_back(value);
  if (known.empty()) return OldAndNew::kUnknown;
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
  std::nth_element(known.begin(), middle, known.end());
  return *middle;
}

/// Medians of the recorded inputs, from the model's origin.
std::vector<double> operated(const DiagnosisRun& run, const ModelSpec& model) {
  std::vector<double> from_origin;
  for (Eigen::Index i = 0; i < run.recording.inputs.cols() && i < model.input_count; ++i) {
    const double origin = i < model.input_origin.size() ? model.input_origin(i) : 0.0;
    const double usual = median(run.recording.inputs.col(i));
    from_origin.push_back(std::isfinite(usual) ? usual - origin : 0.0);
  }
  return from_origin;
}

}  // namespace

bool ChannelNumbers::has_lead() const {
  const auto is = [](double value) { return std::isfinite(value) && value != 0.0; };
  return is(lead.old_value) || is(lead.new_value);
}

bool ChannelNumbers::changed(double sample_time_s) const {
  return differ_by_share(gain) || differ(dead_time, sample_time_s) ||
         std::any_of(time_constants.begin(), time_constants.end(), differ_by_share);
}

std::vector<ChannelNumbers> channel_numbers(const DiagnosisRun& run) {
  const Diagnosis& diagnosis = run.diagnosis;
  const Source before(run.unit.model, operated(run, run.unit.model)),
      after(diagnosis.extended, operated(run, diagnosis.extended));
  std::vector<ChannelNumbers> channels;
  for (int cv = 0; cv < diagnosis.extended.cv_count; ++cv)
    for (int input = 0; input < diagnosis.extended.input_count; ++input) {
      const std::optional<Numbers> old_numbers = before(cv, input), numbers = after(cv, input);
      if (!old_numbers && !numbers) continue;
      ChannelNumbers channel = compared(cv, input, old_numbers, numbers);
      const double curve = old_numbers && numbers ? numbers->curve / old_numbers->curve : 1.0;
      for (const ChannelEstimate& estimate : diagnosis.channels)
        if (estimate.cv == cv && estimate.input == input)
          set_intervals(&estimate.gain_ratio, &estimate.time_constant_ratio,
                        &estimate.dead_time_error, curve, channel);
      for (const Finding& finding : diagnosis.findings) {
        const int about = input_of(run, finding.subject.place), its_cv = finding.subject.place.cv;
        if (finding.repaired && (about == input || about == -1) && (its_cv == cv || its_cv < 0))
          set_intervals(finding, curve, channel);
      }
      channels.push_back(std::move(channel));
    }
  return channels;
}

std::vector<ChannelNumbers> channel_numbers(const IdentificationRun& run) {
  const Source before(run.unit.model), after(run.identification.model);
  std::vector<ChannelNumbers> channels;
  for (const ChannelAnswer& answer : run.identification.channels) {
    if (answer.left_out != LeftOut::kIdentified) continue;
    ChannelNumbers channel = compared(answer.cv, answer.input, before(answer.cv, answer.input),
                                      after(answer.cv, answer.input));
    if (answer.pair) set_pair(answer, channel);
    set_interval(channel.gain, answer.gain.low, answer.gain.high);
    set_interval(channel.dead_time, answer.dead_time_s.low, answer.dead_time_s.high);
    for (std::size_t i = 0; i < answer.time_constants.size() && i < channel.time_constants.size();
         ++i)
      set_interval(channel.time_constants[i], answer.time_constants[i].low,
                   answer.time_constants[i].high);
    channels.push_back(std::move(channel));
  }
  return channels;
}

nlohmann::ordered_json numbers_json(const std::vector<ChannelNumbers>& channels,
                                    const config::UnitConfig& unit) {
  Json json;
  json["rows"] = Json::array();
  for (const ChannelNumbers& channel : channels) {
    const bool late = differ(channel.dead_time, unit.sample_time_s);
    const bool lags =
        std::any_of(channel.time_constants.begin(), channel.time_constants.end(), differ_by_share);
    json["rows"].push_back({{"cv", unit.cv.at(static_cast<std::size_t>(channel.cv)).tag},
                            {"input", unit.input_tag(channel.input)},
                            {"changed", channel.changed(unit.sample_time_s)},
                            {"gain", gain_json(channel.gain, unit_of(channel, unit))},
                            {"time_constant", lags_json(channel, lags)},
                            {"dead_time", times_json({channel.dead_time}, late)}});
  }
  json["csv"] = csv_of(channels, unit);
  return json;
}

}  // namespace mpm::report
