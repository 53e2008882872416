#include "daemon/report/channel_text.hpp"

#include <algorithm>
#include <cmath>

#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"

namespace mpm::report {
namespace {

constexpr const char* kSizeOpen = "size not known yet";
constexpr const char* kGainOpen = "gain not known";

// What an interval that is said to be `ok` may reach: of the gain, of the time constants either
// way, samples of dead time.
constexpr double kOkPercent = 25.0, kOkTimeRatio = 1.5, kOkDeadTimeSamples = 2.0;
// p-value of "does not matter" that is doubtful.
constexpr double kLikely = 0.05;
// What doubles leave of a whole percentage.
constexpr double kRounding = 1e-9;

std::string signed_text(double value, int digits = 2) {
  return (value > 0.0 ? "+" : "") + number_text(value, digits);
}

struct Interval {
  double low, high;
  [[nodiscard]] bool holds(double value) const { return low <= value && value <= high; }
  [[nodiscard]] bool within(double least, double most) const {
    return low >= least && high <= most;
  }
  [[nodiscard]] std::string text() const { return interval_text(low, high, 2); }
};

// "0.0404 t/h per %"; empty where the units are not known.
std::string with_units(const std::string& effect, const ChannelFile& file) {
  if (file.mv_unit.empty() || file.cv_unit.empty()) return "";
  return effect + " " + printable(file.cv_unit) + (file.integrating_gain != 0.0 ? "/s" : "") +
         " per " + printable(file.mv_unit);
}

/// In the units of the unit file, whose gain of an integrating channel is per s.
double effect_of(const ChannelRecord& channel, const ChannelFile& file) {
  return file.integrating_gain != 0.0 && channel.model_gain != 0.0
             ? channel.effect_size * file.integrating_gain / channel.model_gain
             : channel.effect_size;
}

Interval gain_percent(const ChannelRecord& channel) {
  const double a = channel.percent_of_gain(channel.effect_low);
  const double b = channel.percent_of_gain(channel.effect_high);
  return {std::min(a, b), std::max(a, b)};
}

double percent_of_ratio(double ratio) { return 100.0 * (ratio - 1.0); }

/// What is said of one quantity.
struct Part {
  const char* name;
  std::string numbers;  // or that it is not known
  bool ok = false;      // what `ok` says of it is enough, where another one is off

  [[nodiscard]] std::string text(bool all_ok) const {
    return ok && !all_ok ? std::string(name) + " ok" : numbers;
  }
};

Part gain_part(const ChannelRecord& channel, const ChannelFile& file) {
  if (!file.modelled) {
    const std::string effect = number_text(channel.effect_size);
    const std::string in_units = with_units(effect, file);
    const bool for_a_while = Interval{channel.effect_low, channel.effect_high}.holds(0.0);
    return {"gain", std::string("answers") + (for_a_while ? " for a while" : "") +
                        ", where the model has nothing: gain " +
                        (in_units.empty() ? effect : in_units) + " (" +
                        interval_text(channel.effect_low, channel.effect_high) +
                        (for_a_while ? ", perhaps none)" : ")")};
  }
  if (!channel.gain_resolved()) return {"gain", kGainOpen};
  const Interval percent = gain_percent(channel);
  const std::string in_units = with_units(signed_text(effect_of(channel, file), 3), file);
  return {"gain",
          "gain " + signed_text(channel.percent_of_gain(channel.effect_size)) + " % (" +
              percent.text() + (in_units.empty() ? "" : "; " + in_units) + ")",
          percent.holds(0.0) && percent.within(-kOkPercent, kOkPercent)};
}

Part time_constant_part(const ChannelRecord& channel) {
  if (!channel.time_constant_resolved()) return {"time constant", "time constant not known"};
  const Interval ratio{channel.time_constant_low, channel.time_constant_high};
  return {"time constant",
          "time constant " + signed_text(percent_of_ratio(channel.time_constant_ratio)) + " % (" +
              Interval{percent_of_ratio(ratio.low), percent_of_ratio(ratio.high)}.text() + ")",
          ratio.holds(1.0) && ratio.within(1.0 / kOkTimeRatio, kOkTimeRatio)};
}

Part dead_time_part(const ChannelRecord& channel, const ChannelFile& file) {
  if (!channel.dead_time_resolved()) return {"dead time", "dead time not known"};
  const Interval seconds{channel.dead_time_low_s, channel.dead_time_high_s};
  const double most = kOkDeadTimeSamples * file.sample_time_s;
  return {"dead time",
          "dead time " + signed_text(channel.dead_time_error_s) + " s (" + seconds.text() + ")",
          seconds.holds(0.0) && seconds.within(-most, most)};
}

// Of what the test does not find to matter. It looks at the whole response, all else that may be
// off beside it, and wants to be surer than a 95 % interval is.
std::string not_material_text(const ChannelRecord& channel, const ChannelFile& file) {
  const double most = 100.0 * file.gain_limit;
  const Interval percent = gain_percent(channel);
  const bool beyond =
      file.modelled && channel.gain_resolved() && (percent.low > most || percent.high < -most);
  if (!beyond) return "; may be too small to matter";
  return channel.p_value_material < kLikely
             ? "; likely to matter, not beyond doubt"
             : "; not sure to matter: what is allowed of the whole response, with what else may be "
               "off, explains it too";
}

bool nobody_moves(const std::string& tag, const ChannelFile& file) {
  return std::find(file.disturbances.begin(), file.disturbances.end(), tag) !=
         file.disturbances.end();
}

std::string not_excited_text(const ChannelRecord& channel, const ChannelFile& file) {
  const std::string advice = nobody_moves(channel.mv, file)
                                 ? "wait until " + printable(channel.mv) + " moves"
                                 : "move " + printable(channel.mv);
  if (!file.modelled)
    return "moved too little to show whether " + printable(channel.cv) + " answers it; " + advice;
  if (channel.smallest_error <= 0.0 || channel.smallest_error > 1.0)
    return "moved too little to tell anything; " + advice;
  // Rounded up: what is asked for lies below it.
  const double smallest = 0.01 * std::ceil(100.0 * channel.smallest_error - kRounding);
  return "needs a gain error of " + percent_text(smallest) + " to show; " + advice;
}

std::string collinear_text(const ChannelRecord& channel, const ChannelFile& file) {
  const std::string mv = printable(channel.mv), other = printable(channel.confounder);
  std::string advice = "move one without the other";
  if (nobody_moves(channel.mv, file) && nobody_moves(channel.confounder, file))
    advice = "wait until one moves without the other";
  else if (nobody_moves(channel.mv, file))
    advice = "move " + other + " without it";
  else if (nobody_moves(channel.confounder, file))
    advice = "move " + mv + " without it";
  return "moved only together with " + other + "; " + advice;
}

}  // namespace

ChannelFile channel_file(const config::UnitConfig& unit, const std::string& mv,
                         const std::string& cv) {
  ChannelFile file;
  file.sample_time_s = unit.sample_time_s;
  const auto unit_of = [](const auto& signals, const std::string& tag) {
    for (const auto& signal : signals)
      if (signal.tag == tag) return signal.unit;
    return std::string();
  };
  file.mv_unit = unit_of(unit.mv, mv) + unit_of(unit.dv, mv);  // one of which is empty
  file.cv_unit = unit_of(unit.cv, cv);
  for (const config::InputSignal& disturbance : unit.dv)
    file.disturbances.push_back(disturbance.tag);
  file.gain_limit = unit.monitor.materiality.gain;
  for (const ChannelMateriality& channel : unit.monitor.channel_materiality)
    if (unit.input_tag(channel.input) == mv &&
        unit.cv[static_cast<std::size_t>(channel.cv)].tag == cv)
      file.gain_limit = channel.limits.gain;
  const auto& channels = unit.model.channels;
  file.modelled = unit.model.state_space.has_value() ||
                  std::any_of(channels.begin(), channels.end(), [&](const ChannelSpec& channel) {
                    return unit.input_tag(channel.input) == mv &&
                           unit.cv[static_cast<std::size_t>(channel.cv)].tag == cv;
                  });
  for (const ChannelSpec& channel : channels) {
    const auto* function = std::get_if<TransferFunction>(&channel.dynamics);
    if (function != nullptr && function->integrating && unit.input_tag(channel.input) == mv &&
        unit.cv[static_cast<std::size_t>(channel.cv)].tag == cv)
      file.integrating_gain = function->gain;
  }
  return file;
}

std::string mismatch_text(const ChannelRecord& channel, const ChannelFile& file) {
  if (channel.reason == Reason::kOperatingPoint)
    return "the gain varies by +-" + number_text(100.0 * channel.gain_variation) +
           " % over where the plant is operated, which a linear model cannot follow; no fault";
  const Part gain = gain_part(channel, file);
  std::string text = gain.text(false);
  if (file.modelled && channel.usual) {
    const Part time_constant = time_constant_part(channel);
    const Part dead_time = dead_time_part(channel, file);
    const bool all_ok = gain.ok && time_constant.ok && dead_time.ok;
    text = gain.text(all_ok) + ", ";
    if (file.integrating_gain == 0.0 || channel.time_constant_resolved())
      text += time_constant.text(all_ok) + ", ";
    text += dead_time.text(all_ok);
  } else if (file.modelled) {
    text += std::string(", and not of that alone: the dynamics or the dead time differ") +
            (channel.material ? " by much" : "");
  }
  if (channel.reason == Reason::kWeakExcitation)
    text += "; seen though " + printable(channel.mv) + " moved little";
  if (!channel.material) text += not_material_text(channel, file);
  return text;
}

std::string nonlinear_text(const ChannelRecord& channel) {
  if (channel.nonlinear.verdict != NonlinearVerdict::kNonlinear) return "";
  const std::string mv = printable(channel.mv), cv = printable(channel.cv);
  switch (channel.nonlinear.kind) {
    case NonlinearKind::kInputCurve:
      return "bends over the range of " + mv + ", as behind a valve that is bent or saturates";
    case NonlinearKind::kHysteresis:
      return "depends on where " + mv + " came from, as behind a valve that sticks or has play";
    case NonlinearKind::kChannelCurve:
      return "its gain depends on how far " + mv + " has moved " + cv;
    case NonlinearKind::kInteraction:
      return "its gain depends on another input";
    case NonlinearKind::kOutputCurve:
      return cv + " bends over its range, whatever moves it";
    case NonlinearKind::kNone:
      break;
  }
  return "answers as no linear channel does";
}

std::string undetermined_text(const ChannelRecord& channel, const ChannelFile& file) {
  switch (channel.reason) {
    case Reason::kWarmingUp:
      return "too few samples yet";
    case Reason::kNotExcited:
      return not_excited_text(channel, file);
    case Reason::kCollinear:
      return collinear_text(channel, file);
    case Reason::kConfounded:
      if (channel.confounder.empty())
        return "what is off in " + printable(channel.cv) +
               " goes with the inputs together, and is like no error of their channels: they may "
               "answer something that acts on " +
               printable(channel.cv) + " and is not logged; log it as aux";
      return "what is off in " + printable(channel.cv) + " follows " +
             printable(channel.confounder) +
             ", which is no input of the model, no less than it follows the inputs: something that "
             "moves with it may act on " +
             printable(channel.cv);
    case Reason::kBadData:
      return channel.confounder.empty()
                 ? printable(channel.cv) + " or " + printable(channel.mv) +
                       " is too often missing, bad, or the same for several samples; what is read "
                       "only now and then needs a unit of its own, with a sample_time as long"
                 : printable(channel.confounder) + " is missing or bad, and " +
                       printable(channel.cv) + " cannot be judged without it";
    case Reason::kCompressed:
      return channel.confounder.empty()
                 ? "a historian has compressed " + printable(channel.cv) +
                       "; turn that off for this tag, or let it send changes from a twentieth of "
                       "the noise on"
                 : printable(channel.confounder) +
                       " is held until it has left a deadband, as a historian's compression leaves "
                       "it: " +
                       printable(channel.cv) +
                       " cannot be simulated from that; turn it off for this tag, or log the "
                       "model's predictions too";
    case Reason::kCoarse:
      return printable(channel.cv) +
             " is read so coarsely that what is off may be its steps; log it with more digits";
    case Reason::kControllerOff:
      return "no manipulated variable moves: the controller is off or in manual";
    case Reason::kConstrained:
      return printable(channel.mv) + " rests at a limit; " +
             (nobody_moves(channel.mv, file) ? "wait until it leaves it"
                                             : "move it away from there");
    case Reason::kIsolating:
      return "something changed in " + printable(channel.cv) +
             "; too few samples since then to tell which channel";
    case Reason::kNone:
    case Reason::kWeakExcitation:
    case Reason::kOperatingPoint:
      break;
  }
  return "not known";
}

bool leaves_size_open(const std::string& text) { return text == kSizeOpen || text == kGainOpen; }

std::string error_text(const AlarmRecord& alarm, const ChannelRecord* channel) {
  if (channel == nullptr || channel->model_gain == 0.0)
    return alarm.effect_size == 0.0 ? kSizeOpen : "gain off by " + number_text(alarm.effect_size);
  if (!channel->gain_resolved() || gain_percent(*channel).holds(0.0)) {
    if (channel->time_constant_resolved() &&
        !Interval{channel->time_constant_low, channel->time_constant_high}.holds(1.0))
      return "time constant " + signed_text(percent_of_ratio(channel->time_constant_ratio)) + " %";
    if (channel->dead_time_resolved() &&
        !Interval{channel->dead_time_low_s, channel->dead_time_high_s}.holds(0.0))
      return "dead time " + signed_text(channel->dead_time_error_s) + " s";
  }
  if (!channel->gain_resolved()) return kGainOpen;
  return "gain " + signed_text(channel->percent_of_gain(alarm.effect_size)) + " %";
}

}  // namespace mpm::report
