#pragma once

#include <array>
#include <string>

#include "core/alarm/alarm_settings.hpp"
#include "core/model/model_spec.hpp"
#include "core/monitor/settings.hpp"

/// Settings that are one of a few, and what the files call each.
namespace mpm::config {

template <class Kind>
struct Choice {
  const char* name;
  Kind kind;
};

[[nodiscard]] constexpr auto choices(CorrelationKind /*which*/) {
  return std::array{Choice<CorrelationKind>{"lagged_partial", CorrelationKind::kLaggedPartial},
                    Choice<CorrelationKind>{"partial", CorrelationKind::kPartial},
                    Choice<CorrelationKind>{"conventional", CorrelationKind::kConventional},
                    Choice<CorrelationKind>{"alternative", CorrelationKind::kAlternative},
                    Choice<CorrelationKind>{"spearman", CorrelationKind::kSpearman},
                    Choice<CorrelationKind>{"rank_partial", CorrelationKind::kRankPartial}};
}
[[nodiscard]] constexpr auto choices(ThresholdKind /*which*/) {
  return std::array{Choice<ThresholdKind>{"f_test", ThresholdKind::kFTest},
                    Choice<ThresholdKind>{"mean_line", ThresholdKind::kMeanLine}};
}
[[nodiscard]] constexpr auto choices(NonlinearTest /*which*/) {
  return std::array{Choice<NonlinearTest>{"off", NonlinearTest::kOff},
                    Choice<NonlinearTest>{"polynomial", NonlinearTest::kPolynomial},
                    Choice<NonlinearTest>{"kernel", NonlinearTest::kKernel},
                    Choice<NonlinearTest>{"random_features", NonlinearTest::kRandomFeatures}};
}
[[nodiscard]] constexpr auto choices(DisturbanceShape /*which*/) {
  return std::array{Choice<DisturbanceShape>{"step", DisturbanceShape::kStep},
                    Choice<DisturbanceShape>{"drift", DisturbanceShape::kDrift},
                    Choice<DisturbanceShape>{"periodic", DisturbanceShape::kPeriodic}};
}
[[nodiscard]] constexpr auto choices(NotificationClass /*which*/) {
  return std::array{Choice<NotificationClass>{"event", NotificationClass::kEvent},
                    Choice<NotificationClass>{"alert", NotificationClass::kAlert},
                    Choice<NotificationClass>{"alarm", NotificationClass::kAlarm}};
}
[[nodiscard]] constexpr auto choices(AlarmPriority /*which*/) {
  return std::array{Choice<AlarmPriority>{"low", AlarmPriority::kLow},
                    Choice<AlarmPriority>{"medium", AlarmPriority::kMedium},
                    Choice<AlarmPriority>{"high", AlarmPriority::kHigh}};
}

template <class Kind>
[[nodiscard]] std::string name_of(Kind kind) {
  for (const Choice<Kind>& choice : choices(kind))
    if (choice.kind == kind) return choice.name;
  return {};
}

}  // namespace mpm::config
