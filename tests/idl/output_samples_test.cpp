#include "idl/output_samples.hpp"

#include <catch2/catch.hpp>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "idl/cdr.hpp"
#include "tests/idl/fixed_records.hpp"

namespace mpm::idl {
namespace {

char* text(const char* literal) { return const_cast<char*>(literal); }

template <class Sample>
std::vector<std::byte> bytes_of(const Sample& sample) {
  CdrEncoder<Sample> encoder;
  const std::span<const std::byte> bytes = encoder.encode(sample);
  return {bytes.begin(), bytes.end()};
}

/// `record` is written as `sample`, and what is read from that is written as `sample` again.
template <class Record>
void check_both_ways(const Record& record, const SampleOf<Record>& sample) {
  const std::vector<std::byte> expected = bytes_of(sample);
  SampleMaker maker;
  CHECK(bytes_of(maker.sample_of(record)) == expected);
  CHECK(bytes_of(maker.sample_of(record_of<Record>(sample))) == expected);
}

// What follows fills samples by their IDL, member by member.

mpm_ChannelStatus mismatching_sample(std::vector<double>& correlations) {
  correlations = {0.01, -0.02, 0.3, 0.0};
  mpm_ChannelStatus sample{};
  sample.unit = text("shell");
  sample.mv = text("FIC-101.SP");
  sample.cv = text("TI-7 °C");
  sample.interval = 4711;
  sample.source_time_ns = 1'714'564'800'250'000'000;
  sample.verdict = text("mismatch");
  sample.reason = text("");
  sample.p_value = 1.25e-12;
  sample.statistic = 9.1;
  sample.threshold = 3.3;
  sample.partial_correlation = -0.41;
  sample.lag = 9;
  sample.excited = true;
  sample.effect_size = 1.2;
  sample.smallest_error = 0.08;
  sample.effective_samples = 3999.5;
  sample.alarm_active = true;
  sample.first_lag = -2;
  sample.partial_correlations = {4, 4, correlations.data(), false};
  sample.p_value_material = 0.03125;
  sample.material = true;
  sample.model_gain = -4.05;
  sample.effect_low = 0.7;
  sample.effect_high = 1.7;
  sample.usual = true;
  sample.time_constant_ratio = 1.5;
  sample.time_constant_low = 1.1;
  sample.time_constant_high = 2.25;
  sample.dead_time_error = -60.0;
  sample.dead_time_low = -90.5;
  sample.dead_time_high = -29.5;
  sample.gain_variation = 0.375;
  sample.nonlinear.tested = true;
  sample.nonlinear.verdict = text("nonlinear");
  sample.nonlinear.kind = text("input_curve");
  sample.nonlinear.p_value = 2.5e-9;
  sample.nonlinear.statistic = 4.5;
  sample.nonlinear.share = 0.0625;
  sample.nonlinear.material = true;
  sample.nonlinear.smallest_variation = 0.125;
  return sample;
}

// Without `state` or `to`.
template <class Sample>
Sample alarm_sample() {
  Sample sample{};
  sample.unit = text("shell");
  sample.mv = text("FIC-101.SP");
  sample.cv = text("y1");
  sample.interval = 812;
  sample.source_time_ns = 812'000'000'001;
  sample.p_value = 3e-9;
  sample.statistic = 11.5;
  sample.threshold = 3.5;
  sample.partial_correlation = 0.625;
  sample.lag = 4;
  sample.effect_size = -0.75;
  sample.cause = text("");
  sample.cause_text = text("");
  return sample;
}

template <class Sample>
Sample diagnosed_sample(std::vector<mpm_CauseParameter>& parameters) {
  parameters = {{text("gain_ratio"), 0.75, 0.72, 0.78},
                {text("dead_time_error"), 60.0, 30.0, 90.5}};
  auto sample = alarm_sample<Sample>();
  sample.cause = text("dynamics");
  sample.cause_text = text("y1 answers FIC-101.SP late.");
  sample.cause_confidence = 0.98;
  sample.cause_parameters = {2, 2, parameters.data(), false};
  return sample;
}

TEST_CASE("a channel's verdict goes to its sample and back") {
  std::vector<double> correlations;
  mpm_ChannelStatus sample = mismatching_sample(correlations);
  ChannelRecord record = test::mismatching_channel();
  check_both_ways(record, sample);
  for (int i = 0; i < 4; ++i) {  // no flag stands in for another
    record.excited = sample.excited = i == 0;
    record.material = sample.material = i == 1;
    record.usual = sample.usual = i == 2;
    sample.alarm_active = i == 3;
    record.alarm = i == 3 ? AlarmState::kActive : AlarmState::kCleared;
    check_both_ways(record, sample);
  }
}

TEST_CASE("the words of a verdict and its reason go to DDS and back") {
  std::vector<double> correlations;
  mpm_ChannelStatus sample = mismatching_sample(correlations);
  ChannelRecord record = test::mismatching_channel();
  for (const auto& [verdict, word] :
       {std::pair{Verdict::kMatch, "match"}, {Verdict::kUndetermined, "undetermined"}}) {
    record.verdict = verdict;
    sample.verdict = text(word);
    check_both_ways(record, sample);
  }
  for (const auto& [reason, word] : {std::pair{Reason::kWarmingUp, "warming_up"},
                                     {Reason::kNotExcited, "not_excited"},
                                     {Reason::kCollinear, "collinear"},
                                     {Reason::kConfounded, "confounded"},
                                     {Reason::kBadData, "bad_data"},
                                     {Reason::kControllerOff, "controller_off"},
                                     {Reason::kConstrained, "constrained"},
                                     {Reason::kIsolating, "isolating"},
                                     {Reason::kWeakExcitation, "weak_excitation"},
                                     {Reason::kOperatingPoint, "operating_point"},
                                     {Reason::kCoarse, "coarse"}}) {
    record.reason = reason;
    sample.reason = text(word);
    check_both_ways(record, sample);
    CHECK(record_of<ChannelRecord>(sample).reason == reason);
  }
  record.reason = Reason::kCollinear;
  record.confounder = "TIC with 7";
  sample.reason = text("collinear with TIC with 7");
  check_both_ways(record, sample);
  CHECK(record_of<ChannelRecord>(sample).confounder == "TIC with 7");
}

void fill_normal(mpm_Alarm& sample) {
  sample.alarm_state = text("normal");
  sample.acknowledged = true;
  sample.shelving_state = text("unshelved");
  sample.client_user_id = text("");
  sample.comment = text("");
  sample.notification_class = text("alert");
  sample.priority = text("low");
  sample.message = text("");
}

TEST_CASE("an alarm's change, its state and its cause go to DDS and back") {
  std::vector<mpm_CauseParameter> parameters;
  for (const auto& [to, word] :
       {std::pair{AlarmChange::kActive, "active"}, {AlarmChange::kCleared, "cleared"}}) {
    auto event = alarm_sample<mpm_AlarmEvent>();
    event.to = text(word);
    check_both_ways(test::alarm(to), event);
    auto state = alarm_sample<mpm_Alarm>();
    state.state = text(word);
    fill_normal(state);
    check_both_ways(AlarmStateRecord(test::alarm(to)), state);
  }
  auto event = diagnosed_sample<mpm_AlarmEvent>(parameters);
  event.to = text("diagnosed");
  check_both_ways(test::diagnosed_alarm(), event);
  auto state = diagnosed_sample<mpm_Alarm>(parameters);
  state.state = text("active");  // still
  fill_normal(state);
  check_both_ways(AlarmStateRecord(test::diagnosed_alarm()), state);
}

template <class Sample>
void fill_shelved(Sample& sample) {
  sample.alarm_state = text("shelved");
  sample.acknowledged = false;
  sample.shelving_state = text("one_shot_shelved");
  sample.unshelve_time_ns = 7001;
  sample.suppressed = true;
  sample.suppressed_by_design = true;
  sample.out_of_service = true;
  sample.retain = true;
  sample.active_time_ns = 7002;
  sample.ack_time_ns = 7003;
  sample.client_user_id = text("ann");
  sample.comment = text("work order 4711");
  sample.notification_class = text("alarm");
  sample.priority = text("high");
  sample.severity = 833;
  sample.message = text("gain +41 %");
}

TEST_CASE("what a control room knows of an alarm goes both ways") {
  auto sample = alarm_sample<mpm_Alarm>();
  sample.state = text("active");
  fill_shelved(sample);
  AlarmStateRecord record(test::alarm(AlarmChange::kActive));
  record.view = test::shelved_view();
  check_both_ways(record, sample);
}

TEST_CASE("the alarm of a controller goes both ways") {
  mpm_ControllerAlarm sample{};
  sample.unit = text("shell");
  sample.interval = 5;
  sample.source_time_ns = 5'000'000'000;
  sample.state = text("active");
  fill_shelved(sample);
  sample.channels = 3;
  sample.consequence = text("the column floods");
  sample.action = text("shed u1");
  sample.time_to_respond_s = 600.0;
  sample.guidance = text("see the shift book");
  sample.display_url = text("http://plant/hmi");
  sample.runbook = text("RB-7");
  check_both_ways(test::controller_alarm(), sample);
}

TEST_CASE("a command and its answer go both ways") {
  mpm_Command sample{};
  sample.unit = text("shell");
  sample.mv = text("u1");
  sample.cv = text("y1");
  sample.action = text("shelve");
  sample.duration_s = 28800;
  sample.once = true;
  sample.user = text("ann");
  sample.host = text("panel");
  sample.comment = text("3:abc,");
  sample.id = text("4711");
  sample.time_ns = 1234567;
  sample.proof = text("0a1b");
  check_both_ways(test::command(), sample);

  mpm_CommandReply answer{};
  answer.unit = text("shell");
  answer.id = text("4711");
  answer.accepted = true;
  answer.text = text("shelved for 8 h");
  answer.time_ns = 99;
  CommandReplyRecord reply;
  reply.unit = "shell";
  reply.id = "4711";
  reply.accepted = true;
  reply.text = "shelved for 8 h";
  reply.time_ns = 99;
  check_both_ways(reply, answer);
}

TEST_CASE("the health goes to its sample and back") {
  mpm_Health sample{};
  sample.unit = text("shell");
  sample.state = text("maintenance_required");
  sample.detail = text("2 alarms");
  sample.interval = 99;
  sample.source_time_ns = 99'000'000'000;
  sample.frames = 101;
  sample.used = 102;
  sample.missing = 103;
  sample.incomplete = 104;
  sample.late = 105;
  sample.repeated = 106;
  sample.out_of_order = 107;
  sample.bad_values = 108;
  sample.wrong_length = 109;
  sample.unknown_unit = 110;
  sample.restarts = 111;
  sample.undetermined = 112;
  sample.matching = 113;
  sample.mismatching = 114;
  sample.active_alarms = 115;
  sample.silenced_alarms = 117;
  sample.beyond = 116;
  check_both_ways(test::health(), sample);
}

TEST_CASE("control performance goes to its sample and back, with all that is in it") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<mpm_HorizonError> horizons = {{1, 0.1, 0.2}, {90, 0.3, 0.7}};
  std::vector<mpm_CvPerformance> cvs(2);
  cvs[0].cv = text("y1");
  cvs[0].unit = text("degC");
  cvs[0].setpoint = text("sp1");
  cvs[0].samples = 598;
  cvs[0].control_error = {-0.125, 0.25, 0.5156};
  cvs[0].outside_limits = 0.0625;
  cvs[0].prediction = {2, 2, horizons.data(), false};
  cvs[1].cv = text("y2");
  cvs[1].unit = cvs[1].setpoint = text("");
  cvs[1].control_error = {unknown, unknown, unknown};
  cvs[1].outside_limits = unknown;
  std::vector<mpm_MvPerformance> mvs(2);
  mvs[0].mv = text("u1");
  mvs[0].unit = text("%");
  mvs[0].samples = 597;
  mvs[0].at_low = 0.01;
  mvs[0].at_high = 0.02;
  mvs[0].at_limits = 0.03;
  mvs[0].travel = 0.75;
  mvs[0].standing = 0.5;
  mvs[1].mv = text("u2");
  mvs[1].unit = text("");
  mvs[1].at_low = mvs[1].at_high = mvs[1].at_limits = mvs[1].travel = mvs[1].standing = unknown;
  mpm_Performance sample{};
  sample.unit = text("shell");
  sample.interval = 600;
  sample.source_time_ns = 601'000'000'000;
  sample.window_samples = 28800;
  sample.samples = 599;
  sample.service_factor = 0.9375;
  sample.cvs = {2, 2, cvs.data(), false};
  sample.mvs = {2, 2, mvs.data(), false};
  check_both_ways(test::performance(), sample);
  CHECK_FALSE(record_of<PerformanceRecord>(sample).cvs[1].setpoint);
}

/// Whatever a member may be made from.
struct Anything {
  template <class T>
  operator T() const;  // NOLINT: implicit, and never defined
};

template <class Sample, std::size_t... I>
consteval bool has_members(std::index_sequence<I...>) {
  return requires { Sample{(static_cast<void>(I), Anything())...}; };
}

template <class Sample, std::size_t Count = 1>
consteval std::size_t members_of() {
  if constexpr (has_members<Sample>(std::make_index_sequence<Count + 1>()))
    return members_of<Sample, Count + 1>();
  else
    return Count;
}

struct CountMembers {
  std::size_t& count;

  void operator()(const FieldKey&, const auto&) const {}
  void operator()(const FieldKey&, const auto&, const auto&) const { ++count; }
  template <class... Member>
  void operator()(const FieldKey&, const auto&, const std::tuple<Member...>&) const {
    count += sizeof...(Member);
  }
};

template <class One, class Sample>
void check_rows() {
  const Sample sample{};
  const One record{};
  std::size_t rows = 0;
  One::fields(CountMembers{rows}, record, sample);
  CHECK(rows == members_of<Sample>());
}

template <class... Record>
void check_rows(const std::tuple<Record...>*) {
  (check_rows<Record, SampleOf<Record>>(), ...);
}

TEST_CASE("every member of every output sample has its row") {
  CHECK(members_of<mpm_CauseParameter>() == 4);
  check_rows(static_cast<const OutputRecords*>(nullptr));
  check_rows<ControlError, mpm_ControlError>();
  check_rows<HorizonError, mpm_HorizonError>();
  check_rows<CvPerformance, mpm_CvPerformance>();
  check_rows<MvPerformance, mpm_MvPerformance>();
}

TEST_CASE("what another make leaves out or words in its own way says nothing") {
  const auto empty = record_of<ChannelRecord>(mpm_ChannelStatus{});
  CHECK(empty.unit.empty());
  CHECK(empty.verdict == Verdict::kUndetermined);
  CHECK(empty.reason == Reason::kNone);
  CHECK(empty.partial_correlations.empty());
  CHECK_FALSE(record_of<AlarmRecord>(mpm_AlarmEvent{}).named.cause);
  mpm_ChannelStatus status{};
  status.verdict = text("good");
  status.reason = text("tired");
  CHECK(record_of<ChannelRecord>(status).verdict == Verdict::kUndetermined);
  CHECK(record_of<ChannelRecord>(status).reason == Reason::kNone);
  mpm_Alarm alarm{};
  alarm.state = text("shelved");
  CHECK(record_of<AlarmStateRecord>(alarm).to == AlarmChange::kCleared);
}

}  // namespace
}  // namespace mpm::idl
