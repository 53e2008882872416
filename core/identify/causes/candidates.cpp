#include "core/identify/causes/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/identify/causes/square_waves.hpp"
#include "core/identify/causes/step_moments.hpp"
#include "core/identify/fit/channel_edit.hpp"

namespace mpm {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Moments looked at for a change inside the data.
constexpr int kOnsets = 15;
/// Moments of a step that are looked at more closely.
constexpr std::size_t kStepMoments = 8;
/// A change can be told only if so much of the data lies on either side.
constexpr double kOnsetMargin = 0.1;

Coordinate gain_ratio() { return {"gain_ratio", 1.0, 1.0, 0.25, 0.01, 0.02, 20.0}; }
Coordinate log_time_constant_ratio(double start) {
  return {"log_time_constant_ratio", start, 0.0, 0.35, 0.01, -2.5, 2.5};
}
Coordinate dead_time_samples(double start, double removable) {
  return {"dead_time_samples", start, 0.0, 3.0, 0.25, -removable, 60.0};
}

struct Spread {
  double low = 0.0, high = 0.0, sd = 0.0, median = 0.0;  ///< 1 and 99 % quantiles
  std::vector<double> sorted;
  [[nodiscard]] double quantile(double p) const {
    return sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1))];
  }
};

std::optional<Spread> spread_of(const Eigen::Ref<const VectorXd>& values) {
  Spread spread;
  for (const double value : values)
    if (std::isfinite(value)) spread.sorted.push_back(value);
  if (spread.sorted.size() < 20) return std::nullopt;
  std::sort(spread.sorted.begin(), spread.sorted.end());
  spread.low = spread.quantile(0.01);
  spread.high = spread.quantile(0.99);
  spread.median = spread.quantile(0.5);
  double mean = 0.0, square = 0.0;
  for (const double value : spread.sorted) mean += value;
  mean /= static_cast<double>(spread.sorted.size());
  for (const double value : spread.sorted) square += (value - mean) * (value - mean);
  spread.sd = std::sqrt(square / static_cast<double>(spread.sorted.size()));
  if (!(spread.high > spread.low)) return std::nullopt;
  return spread;
}

class Collector {
 public:
  Collector(const Problem& problem, const std::vector<Effect>& accepted)
      : problem_(problem), accepted_(accepted) {}

  std::vector<Effect> collect() {
    channels();
    scales();
    blocks();
    outputs();
    new_inputs();
    states();
    return std::move(found_);
  }

 private:
  [[nodiscard]] const ModelSpec& model() const { return problem_.model(); }
  [[nodiscard]] double sample_time() const { return problem_.surroundings().sample_time_s; }

  /// A kind of subject that was accepted already is not looked for again in the same place.
  [[nodiscard]] bool taken(const Subject& subject) const {
    return std::any_of(accepted_.begin(), accepted_.end(), [&](const Effect& effect) {
      const Subject& a = effect.subject;
      if (a.cause == subject.cause && a.cv == subject.cv && a.input == subject.input &&
          a.aux == subject.aux && subject.cause != Cause::kOutputDisturbance)
        return true;
      // What has found the linear part along with its block leaves none for another.
      if ((a.cause == Cause::kStiction || a.cause == Cause::kStateNonlinearity) &&
          effect.find("gain_ratio") && a.cv == subject.cv && a.input == subject.input)
        return true;
      // One block per place.
      const auto is_block = [](Cause cause) {
        return cause == Cause::kInputNonlinearity || cause == Cause::kStiction;
      };
      return is_block(a.cause) && is_block(subject.cause) && a.input == subject.input;
    });
  }

  void add(const Subject& subject, std::vector<Coordinate> coordinates, std::size_t members,
           Index onset = 0, double extra_cost = 0.0) {
    if (taken(subject)) return;
    found_.push_back({subject, std::move(coordinates), onset, cost_of(members) + extra_cost});
  }

  [[nodiscard]] std::vector<int> cvs_of(int input) const {
    std::vector<int> cvs;
    for (const ChannelSpec& channel : model().channels)
      if (channel.input == input) cvs.push_back(channel.cv);
    return cvs;
  }

  void channels() {
    const std::size_t members = model().channels.size();
    for (const ChannelSpec& channel : model().channels) {
      const double removable = removable_dead_time_s(channel, sample_time()) / sample_time();
      const bool tank = std::holds_alternative<TankChain>(channel.dynamics);
      const Subject where{Cause::kGain, channel.cv, channel.input, -1, ""};
      const auto with = [&](Cause cause) {
        Subject subject = where;
        subject.cause = cause;
        return subject;
      };
      if (!tank) add(with(Cause::kGain), {gain_ratio()}, members);
      std::vector<double> delays = {0.3, 2.0, 5.0, 10.0};
      for (const double back : {-2.0, -5.0})
        if (removable >= -back) delays.push_back(back);
      for (const double start : {-0.3, 0.0, 0.4}) {
        add(with(Cause::kTimeConstant), {log_time_constant_ratio(start)}, members);
        if (!tank)
          add(with(Cause::kDynamics), {gain_ratio(), log_time_constant_ratio(start)}, members);
      }
      for (const double start : delays) {
        const Coordinate delay = dead_time_samples(start, removable);
        add(with(Cause::kDeadTime), {delay}, members);
        add(with(Cause::kDynamics), {log_time_constant_ratio(0.0), delay}, members);
        if (tank) continue;
        add(with(Cause::kDynamics), {gain_ratio(), delay}, members);
        add(with(Cause::kDynamics), {gain_ratio(), log_time_constant_ratio(0.0), delay}, members);
      }
      const Index samples = problem_.samples();
      for (int i = 0; i < kOnsets; ++i) {
        const double share =
            kOnsetMargin + (1.0 - 2.0 * kOnsetMargin) * (i + 0.5) / static_cast<double>(kOnsets);
        const auto onset = static_cast<Index>(share * static_cast<double>(samples));
        const double cost = cost_of(static_cast<std::size_t>(8 * kOnsets));
        if (!tank) add(with(Cause::kGain), {gain_ratio()}, members, onset, cost);
        add(with(Cause::kTimeConstant), {log_time_constant_ratio(0.2)}, members, onset, cost);
        for (const double start : {2.0, 5.0})
          add(with(Cause::kDeadTime), {dead_time_samples(start, removable)}, members, onset, cost);
        if (removable >= 2.0)
          add(with(Cause::kDeadTime), {dead_time_samples(-2.0, removable)}, members, onset, cost);
      }
    }
  }

  void scales() {
    const int inputs = problem_.surroundings().model_inputs;
    for (int input = 0; input < inputs; ++input)
      if (cvs_of(input).size() > 1)
        add({Cause::kInputScale, -1, input, -1, ""}, {gain_ratio()},
            static_cast<std::size_t>(inputs));
    for (int cv = 0; cv < model().cv_count; ++cv) {
      const auto channels =
          std::count_if(model().channels.begin(), model().channels.end(),
                        [cv](const ChannelSpec& channel) { return channel.cv == cv; });
      if (channels > 1)
        add({Cause::kOutputScale, cv, -1, -1, ""}, {gain_ratio()},
            static_cast<std::size_t>(model().cv_count));
    }
  }

  void blocks() {
    const int inputs = problem_.surroundings().model_inputs;
    const std::size_t members = static_cast<std::size_t>(inputs) + model().channels.size();
    for (int input = 0; input < inputs; ++input) {
      if (model().input_blocks[static_cast<std::size_t>(input)]) continue;
      const std::optional<Spread> spread = spread_of(problem_.recording().inputs.col(input));
      if (!spread) continue;
      const std::vector<int> cvs = cvs_of(input);
      if (cvs.empty()) continue;
      std::vector<int> places = {cvs.size() > 1 ? -1 : cvs[0]};
      if (cvs.size() > 1) places.insert(places.end(), cvs.begin(), cvs.end());
      for (const int cv : places) {
        const auto blocked = [&](const ChannelSpec& c) {
          return c.input == input && (cv < 0 || c.cv == cv) &&
                 (c.input_block || std::holds_alternative<TankChain>(c.dynamics));
        };
        if (std::any_of(model().channels.begin(), model().channels.end(), blocked)) continue;
        curves(cv, input, *spread, members);
        // A valve is one: it sticks for all CVs alike.
        if (cv < 0 || cvs.size() == 1) frictions(cv, input, *spread, members);
      }
    }
  }

  void curves(int cv, int input, const Spread& spread, std::size_t members) {
    const double origin = model().input_origin(input);
    const double reach = std::max(std::abs(spread.high - origin), std::abs(spread.low - origin));
    const Coordinate linear{"linear", 1.0, 1.0, 0.25, 0.01, -20.0, 20.0};
    const double q = 0.3 / reach, c = 0.3 / (reach * reach);
    const Coordinate quadratic{"quadratic", 0.0, 0.0, q, 0.05 * q, -1e9, 1e9};
    const Coordinate cubic{"cubic", 0.0, 0.0, c, 0.05 * c, -1e9, 1e9};
    const Subject polynomial{Cause::kInputNonlinearity, cv, input, -1, "polynomial"};
    add(polynomial, {linear, quadratic}, members);
    add(polynomial, {linear, quadratic, cubic}, members);

    const Subject saturation{Cause::kInputNonlinearity, cv, input, -1, "saturation"};
    const double range = spread.high - spread.low;
    const auto level = [&](const char* name, double start) {
      return Coordinate{name, start, spread.median, 0.5 * range, 0.01 * range, -1e9, 1e9};
    };
    for (const double p : {0.03, 0.08, 0.15, 0.25}) {
      Coordinate high = level("high", spread.quantile(1.0 - p));
      Coordinate low = level("low", spread.quantile(p));
      high.low = spread.quantile(0.3), low.high = spread.quantile(0.7);
      add(saturation, {high}, members);
      add(saturation, {low}, members);
      add(saturation, {low, high}, members);
    }
    const Subject deadband{Cause::kInputNonlinearity, cv, input, -1, "deadband"};
    for (const double share : {0.02, 0.05, 0.1, 0.2})
      add(deadband,
          {{"width", share * range, 0.0, 0.15 * range, 0.03 * share * range, 1e-4 * range, range}},
          members);
  }

  void frictions(int cv, int input, const Spread& spread, std::size_t members) {
    const Subject stiction{Cause::kStiction, cv < 0 ? -1 : cv, input, -1, ""};
    const double range = spread.high - spread.low;
    const auto widths = [&](double band, double jump) -> std::vector<Coordinate> {
      return {{"band", band, 0.0, 0.15 * range, 0.05 * band, 1e-4 * range, 1.5 * range},
              {"jump", jump * band, 0.0, 0.15 * range, -0.05 * band, 0.0, 1.5 * range}};
    };
    const auto add_valve = [&](std::vector<Coordinate> coordinates, bool slips_once) {
      add(stiction, std::move(coordinates), 2 * members);
      if (!found_.empty()) found_.back().slips_once = slips_once;
    };
    for (const double share : {0.02, 0.04, 0.08, 0.15, 0.25})
      for (const double jump : {0.3, 0.65, 1.0})
        for (const bool slips_once : {false, true})
          add_valve(widths(share * range, jump), slips_once);
    // A valve that sticks over most of its range hides what the channel is: a model fitted to such
    // data has taken the sticking for dead time. Then both are to be found together.
    if (cvs_of(input).size() > 1) return;
    for (const ChannelSpec& channel : model().channels) {
      if (channel.input != input) continue;
      const double removable = removable_dead_time_s(channel, sample_time()) / sample_time();
      for (const double share : {0.1, 0.2, 0.35, 0.5, 0.7})
        for (const double jump : {0.1, 0.4, 0.8})
          for (const double delay : {0.0, -0.6 * removable}) {
            std::vector<Coordinate> coordinates = widths(share * range, jump);
            coordinates[0].prior_sd = coordinates[1].prior_sd = 0.5 * range;
            coordinates.push_back({"gain_ratio", 1.0, 1.0, 1.0, 0.01, 0.02, 20.0});
            coordinates.push_back(log_time_constant_ratio(0.0));
            coordinates.push_back(dead_time_samples(delay, removable));
            add_valve(std::move(coordinates), false);
          }
    }
  }

  void outputs() {
    for (int cv = 0; cv < model().cv_count; ++cv) {
      if (model().output_blocks[static_cast<std::size_t>(cv)]) continue;
      const std::optional<Spread> spread = spread_of(problem_.recording().cvs.col(cv));
      if (!spread) continue;
      const Subject clipping{Cause::kOutputNonlinearity, cv, -1, -1, "saturation"};
      const double range = spread->sorted.back() - spread->sorted.front();
      const auto level = [&](const char* name, double start) {
        return Coordinate{name, start, spread->median, 0.5 * range, 0.003 * range, -1e9, 1e9};
      };
      // A clipped sensor would have shown its plateau: what is left is an overflow upstream of it.
      const auto members = static_cast<std::size_t>(40 * model().cv_count);
      for (const double p : {0.002, 0.05, 0.12}) {
        add(clipping, {level("high", spread->quantile(1.0 - p))}, members);
        add(clipping, {level("low", spread->quantile(p))}, members);
      }
    }
  }

  void new_inputs() {
    const int inputs = problem_.surroundings().model_inputs;
    const auto aux = static_cast<int>(problem_.recording().aux.cols());
    std::vector<Subject> subjects;
    for (int cv = 0; cv < model().cv_count; ++cv) {
      for (int input = 0; input < inputs; ++input) {
        const std::vector<int> cvs = cvs_of(input);
        if (std::find(cvs.begin(), cvs.end(), cv) == cvs.end())
          subjects.push_back({Cause::kUnmodelledInput, cv, input, -1, ""});
      }
      for (int a = 0; a < aux; ++a) subjects.push_back({Cause::kUnmodelledInput, cv, -1, a, ""});
    }
    for (const Subject& subject : subjects) {
      const Eigen::Ref<const VectorXd> signal =
          subject.aux >= 0 ? problem_.recording().aux.col(subject.aux)
                           : problem_.recording().inputs.col(subject.input);
      const std::optional<Spread> from = spread_of(signal);
      const std::optional<Spread> to = spread_of(problem_.recording().cvs.col(subject.cv));
      if (!from || !to) continue;
      double slowest = 10.0 * sample_time();
      for (const ChannelSpec& channel : model().channels)
        if (channel.cv == subject.cv)
          slowest = std::max(slowest, slowest_time_constant_s(channel, sample_time()));
      const double gain = 0.5 * to->sd / std::max(1e-12, from->sd);
      for (const double share : {0.05, 0.2, 0.6, 1.5, 4.0}) {
        for (const double delay : {0.0, 0.2}) {
          const double time_constant = std::max(0.5 * sample_time(), share * slowest);
          const double samples = delay * slowest / sample_time();
          add(subject,
              {{"gain", 0.0, 0.0, gain, 0.01 * gain, -1e9, 1e9},
               {"log_time_constant", std::log(time_constant), std::log(slowest / 2.0), 1.2, 0.02,
                std::log(0.2 * sample_time()), std::log(30.0 * slowest)},
               {"dead_time_samples", samples, 0.0, 0.3 * slowest / sample_time() + 3.0, 0.25, 0.0,
                5.0 * slowest / sample_time()}},
              subjects.size());
        }
      }
    }
  }

  void states() {
    const std::size_t members = 3 * model().channels.size();
    for (const ChannelSpec& channel : model().channels) {
      const std::optional<Spread> u = spread_of(problem_.recording().inputs.col(
          std::min<Index>(channel.input, problem_.recording().inputs.cols() - 1)));
      const std::optional<Spread> y = spread_of(problem_.recording().cvs.col(channel.cv));
      if (channel.input >= problem_.surroundings().model_inputs || !u || !y) continue;
      const auto* transfer = std::get_if<TransferFunction>(&channel.dynamics);
      const bool integrating = transfer && transfer->integrating;
      if (integrating || std::holds_alternative<TankChain>(channel.dynamics)) continue;
      const double reach = std::max(std::abs(y->high - model().output_origin(channel.cv)),
                                    std::abs(y->low - model().output_origin(channel.cv)));
      const double force = u->high - u->low;
      const double q = 0.2 * force / (reach * reach), c = 0.2 * force / (reach * reach * reach);
      std::vector<Coordinate> spring = {gain_ratio(),
                                        log_time_constant_ratio(0.0),
                                        {"quadratic", 0.0, 0.0, q, 0.02 * q, -1e12, 1e12},
                                        {"cubic", 0.0, 0.0, c, 0.02 * c, -1e12, 1e12}};
      // A linear fit to a stiffening spring has got its damping wrong too.
      if (rings(channel)) spring.push_back({"log_damping_ratio", 0.0, 0.0, 0.35, 0.01, -2.0, 2.0});
      add({Cause::kStateNonlinearity, channel.cv, channel.input, -1, "cubic_stiffness"},
          std::move(spring), members);
      if (transfer && transfer->lead_s == 0.0 && transfer->gain > 0.0)
        tanks(channel, *transfer, *u, *y, members);
    }
  }

  /// Levels must stay positive, and the gain of tanks is 2 Y / U: one empty level gives the other.
  void tanks(const ChannelSpec& channel, const TransferFunction& transfer, const Spread& u,
             const Spread& y, std::size_t members) {
    const double u0 = model().input_origin(channel.input), y0 = model().output_origin(channel.cv);
    const double span_u = u.sorted.back() - u.sorted.front();
    const double lowest_y = y.sorted.front();
    for (const double share : {0.1, 0.5}) {
      const double empty_output = lowest_y - share * (y.sorted.back() - lowest_y);
      const double empty_input = u0 - 2.0 * (y0 - empty_output) / transfer.gain;
      if (!(u0 - empty_input > 0.0) || !(y0 - empty_output > 0.0)) continue;
      for (const bool overflow : {false, true}) {
        std::vector<Coordinate> coordinates = {
            {"empty_input", empty_input, u0 - span_u, span_u, 0.01 * span_u, -1e9,
             u0 - 0.02 * span_u},
            {"empty_output", empty_output, empty_output, y.high - y.low, 0.01 * (y.high - y.low),
             -1e9, lowest_y - 1e-3 * (y.high - y.low)}};
        const std::size_t count = transfer.time_constants_s.size();
        for (std::size_t n = 1; n <= count; ++n)
          coordinates.push_back(
              {"log_time_constant_ratio_" + std::to_string(n), 0.0, 0.0, 0.5, 0.01, -2.0, 2.0});
        if (overflow) {
          for (std::size_t n = 1; n <= count; ++n)
            coordinates.push_back(
                {"overflow_" + std::to_string(n), 1.8, 2.0, 1.0, 0.01, 1.01, 20.0});
          if (count > 1) coordinates.push_back({"spill", 0.3, 0.5, 0.3, 0.02, 0.0, 1.0});
        }
        add({Cause::kStateNonlinearity, channel.cv, channel.input, -1, "square_root_outflow"},
            coordinates, members);
      }
    }
  }

  const Problem& problem_;
  const std::vector<Effect>& accepted_;
  std::vector<Effect> found_;
};

}  // namespace

std::vector<Effect> candidates(const Problem& problem, const std::vector<Effect>& accepted) {
  return Collector(problem, accepted).collect();
}

std::vector<Effect> disturbance_candidates(const Problem& problem, const CvFit& without) {
  const Index samples = problem.samples();
  const double sample_time = problem.surroundings().sample_time_s;
  const double sd =
      std::max(1e-30, std::sqrt(without.residual.squaredNorm() / static_cast<double>(samples)));
  const auto cvs = static_cast<std::size_t>(problem.model().cv_count);
  std::vector<Effect> found;
  const Subject subject{Cause::kOutputDisturbance, without.cv, -1, -1, "step"};
  double slowest = 10.0 * sample_time;
  for (const ChannelSpec& channel : problem.model().channels)
    if (channel.cv == without.cv)
      slowest = std::max(slowest, slowest_time_constant_s(channel, sample_time));

  const double moments = cost_of(static_cast<std::size_t>(samples) / 4);
  const Coordinate size{"size", 0.0, 0.0, 3.0 * sd, 0.05 * sd, -1e12, 1e12};
  const CvData& data = problem.data(without.cv);
  for (const Index onset : step_moments(data, without, 0.0, kStepMoments))
    found.push_back({subject, {size}, onset, cost_of(cvs) + moments});
  for (const double share : {0.2, 0.7}) {
    const Coordinate lag{"time_constant", share * slowest,    share * slowest, 0.5 * slowest,
                         0.01 * slowest,  0.01 * sample_time, 20.0 * slowest};
    for (const Index onset :
         step_moments(data, without, share * slowest / sample_time, kStepMoments))
      found.push_back({subject, {size, lag}, onset, cost_of(cvs) + moments});
  }
  Subject drift = subject;
  drift.kind = "drift";
  for (int i = 0; i < 18; ++i) {
    const auto onset = static_cast<Index>(static_cast<double>(samples) * 0.05 * i);
    const double length = static_cast<double>(samples - onset) * sample_time;
    found.push_back({drift,
                     {{"rate", 0.0, 0.0, 3.0 * sd / length, 0.05 * sd / length, -1e12, 1e12}},
                     onset,
                     cost_of(cvs) + cost_of(i == 0 ? 1 : 18)});
  }
  // Periodogram of the innovations: peaks stand out of white noise.
  struct Peak {
    double power, frequency;
  };
  std::vector<Peak> peaks;
  const double total = without.innovations.squaredNorm();
  const auto most = static_cast<int>(std::min<Index>(samples / 5, 2000));
  for (int i = 3; i < most; ++i) {
    const double w = 2.0 * M_PI * i / static_cast<double>(samples);
    // Goertzel's recursion.
    const double c = 2.0 * std::cos(w);
    double s1 = 0.0, s2 = 0.0;
    for (const double value : without.innovations) {
      const double s0 = value + c * s1 - s2;
      s2 = s1, s1 = s0;
    }
    const double power = s1 * s1 + s2 * s2 - c * s1 * s2;
    peaks.push_back({2.0 * power / total, i / (static_cast<double>(samples) * sample_time)});
  }
  std::sort(peaks.begin(), peaks.end(),
            [](const Peak& a, const Peak& b) { return a.power > b.power; });
  Subject periodic = subject;
  periodic.kind = "periodic";
  const double resolution = 1.0 / (static_cast<double>(samples) * sample_time);
  for (std::size_t i = 0; i < std::min<std::size_t>(3, peaks.size()); ++i) {
    for (const double share : {0.0, 0.15, 0.3, 0.45, 0.6}) {
      Effect effect;
      effect.subject = periodic;
      effect.coordinates = {{"sine", 0.0, 0.0, 2.0 * sd, 0.05 * sd, -1e12, 1e12},
                            {"cosine", 0.0, 0.0, 2.0 * sd, 0.05 * sd, -1e12, 1e12},
                            {"frequency", peaks[i].frequency, peaks[i].frequency, resolution,
                             0.02 * resolution, 0.3 * resolution, 0.5 / sample_time}};
      effect.onset = static_cast<Index>(share * static_cast<double>(samples));
      effect.search_cost = cost_of(cvs) + cost_of(static_cast<std::size_t>(most)) +
                           (effect.onset > 0 ? cost_of(20) : 0.0);
      found.push_back(std::move(effect));
    }
  }
  const std::vector<Effect> squares = square_waves(problem, without);
  found.insert(found.end(), squares.begin(), squares.end());
  return found;
}

std::vector<Effect> other_onsets(const Effect& effect, Index reach, Index samples) {
  std::vector<Effect> found;
  for (const double share : {-1.0, -0.5, 0.5, 1.0}) {
    const Index onset =
        effect.onset + static_cast<Index>(std::lround(share * static_cast<double>(reach)));
    if (onset < 5 || onset + 5 >= samples || onset == effect.onset) continue;
    Effect other = effect;
    other.onset = onset;
    found.push_back(std::move(other));
  }
  return found;
}

}  // namespace mpm
