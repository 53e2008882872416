#include "tests/soak/score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "daemon/history/alarm_store.hpp"

namespace mpm::soak {
namespace {

constexpr double kSecond = 1e9;

}  // namespace

AlarmScore score(const std::string& alarm_journal, const std::vector<WrongTime>& wrong_times,
                 double least_s, double grace_s) {
  AlarmScore result;
  std::vector<bool> told(wrong_times.size(), false);
  std::set<std::pair<std::string, std::string>> standing;
  std::size_t passed = 0;  // wrong times that have begun
  const auto begin_until = [&](std::int64_t time_ns) {
    for (; passed < wrong_times.size() && wrong_times[passed].from_ns <= time_ns; ++passed)
      told[passed] = standing.contains({wrong_times[passed].mv, wrong_times[passed].cv});
  };
  history::AlarmStore(alarm_journal, history::AlarmStore::Access::kRead)
      .each({}, [&](const history::AlarmEntry& entry) {
        if (entry.cv.empty()) return;
        begin_until(entry.source_time_ns);
        if (entry.what == "cleared") standing.erase({entry.mv, entry.cv});
        if (entry.what != "active") return;
        ++result.raised;
        standing.insert({entry.mv, entry.cv});
        const auto cause =
            std::find_if(wrong_times.rbegin(), wrong_times.rend(), [&](const WrongTime& wrong) {
              const bool open = wrong.until_ns == wrong.from_ns;
              return wrong.mv == entry.mv && wrong.cv == entry.cv &&
                     wrong.from_ns <= entry.source_time_ns &&
                     (open || static_cast<double>(entry.source_time_ns - wrong.until_ns) <=
                                  kSecond * grace_s);
            });
        if (cause == wrong_times.rend()) {
          result.wrong.push_back(entry.mv + " -> " + entry.cv + " at " +
                                 std::to_string(entry.source_time_ns / 1'000'000'000) + " s");
          return;
        }
        const auto index = static_cast<std::size_t>(wrong_times.rend() - cause) - 1;
        if (!told[index])
          result.longest_delay_s =
              std::max(result.longest_delay_s,
                       static_cast<double>(entry.source_time_ns - cause->from_ns) / kSecond);
        told[index] = true;
      });
  begin_until(std::numeric_limits<std::int64_t>::max());
  for (std::size_t i = 0; i < wrong_times.size(); ++i) {
    if (static_cast<double>(wrong_times[i].until_ns - wrong_times[i].from_ns) < kSecond * least_s)
      continue;
    ++result.wrong_times;
    result.missed += told[i] ? 0 : 1;
  }
  return result;
}

void Slope::add(int process, double age, double value) {
  if (points_.empty() || points_.back().process != process ||
      points_.back().count == points_in_mean_) {
    points_.push_back({process, age, value});
    return;
  }
  Point& last = points_.back();
  last.age += age;
  last.value += value;
  ++last.count;
}

// Within each process, so that its level does not count (Searle 1971, covariance analysis).
Slope::Estimate Slope::estimate() const {
  struct Mean {
    double age = 0.0, value = 0.0;
    int count = 0;
  };
  std::map<int, Mean> means;
  for (const Point& point : points_) {
    Mean& mean = means[point.process];
    mean.age += point.age / point.count;
    mean.value += point.value / point.count;
    ++mean.count;
  }
  double age2 = 0.0, both = 0.0, value2 = 0.0;
  for (const Point& point : points_) {
    const Mean& mean = means[point.process];
    const double age = point.age / point.count - mean.age / mean.count;
    const double value = point.value / point.count - mean.value / mean.count;
    age2 += age * age;
    both += age * value;
    value2 += value * value;
  }
  Estimate estimate{0.0, 0.0, points_.size()};
  const double freedom =
      static_cast<double>(points_.size()) - static_cast<double>(means.size()) - 1;
  if (age2 <= 0.0 || freedom < 1.0) return estimate;
  estimate.slope = both / age2;
  estimate.error = std::sqrt(std::max(0.0, value2 - both * both / age2) / freedom / age2);
  return estimate;
}

}  // namespace mpm::soak
