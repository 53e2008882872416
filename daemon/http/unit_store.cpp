#include "daemon/http/unit_store.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace mpm::http {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
// Of a residual's mean and variance, samples: a band follows the noise, not each swing.
constexpr std::int64_t kBandMemory = 2000;
constexpr std::chrono::seconds kRatePeriod{2};

void add(ResidualBand& band, double residual) {
  band.samples = std::min(band.samples + 1, kBandMemory);
  const double weight = 1.0 / static_cast<double>(band.samples);
  const double off = residual - band.mean;
  band.mean += weight * off;
  const double variance = (1.0 - weight) * (band.deviation * band.deviation + weight * off * off);
  band.deviation = std::sqrt(variance);
}

}  // namespace

double model_accuracy(const history::Digest& digest) {
  double sum = 0.0;
  int counted = 0;
  for (const history::CvDigest& cv : digest.cvs) {
    if (cv.pairs == 0 || !history::known(cv.prediction_rms) || !(cv.movement_rms > 0.0)) continue;
    sum += std::clamp(1.0 - cv.prediction_rms / cv.movement_rms, 0.0, 1.0);
    ++counted;
  }
  return counted > 0 ? sum / counted : kUnknown;
}

double determined_share(const history::Digest& digest) {
  if (digest.channels.empty()) return kUnknown;
  const auto determined = std::count_if(
      digest.channels.begin(), digest.channels.end(), [](const history::ChannelDigest& channel) {
        return channel.verdict != to_string(Verdict::kUndetermined);
      });
  return static_cast<double>(determined) / static_cast<double>(digest.channels.size());
}

UnitStore::UnitStore(const config::UnitConfig& unit, RecentEvents& events)
    : config_(unit),
      columns_{unit.counts().cv, unit.counts().inputs()},
      events_(events),
      history_(columns_.width() + columns_.cvs, unit.sample_time_s, kSettling),
      kpi_(kKpiColumns, history::DigestMaker(unit).head(0).digest_s),
      row_(static_cast<std::size_t>(columns_.width() + columns_.cvs)),
      bands_(static_cast<std::size_t>(columns_.cvs)),
      snapshot_(std::make_shared<const UnitSnapshot>()) {}

void UnitStore::recall(const history::Digest& digest) {
  const MutexLock lock(mutex_);
  take_digest(digest);
}

bool UnitStore::absorb(Delivery& delivery, Clock::time_point now) {
  const MutexLock lock(mutex_);
  for (const auto& [alarm, text] : delivery.alarms) events_.add(alarm, text);
  take_rows(delivery);
  for (const history::Digest& digest : delivery.digests) take_digest(digest);
  measure_rate(delivery.rows.size(), now);
  dropped_ += delivery.dropped;
  if (delivery.diagnosis && !delivery.diagnosis->only_wrote) diagnosis_ = delivery.diagnosis;
  if (delivery.view == nullptr) return false;
  delivery.view->id = snapshot_->id + 1;
  snapshot_ = std::move(delivery.view);
  return true;
}

void UnitStore::take_rows(const Delivery& delivery) {
  const auto width = static_cast<std::size_t>(columns_.width());
  const std::size_t reading_width =
      static_cast<std::size_t>(kReadingWidth) * static_cast<std::size_t>(columns_.cvs);
  std::size_t next = 0;  // judgement
  for (std::size_t r = 0; r < delivery.rows.size(); ++r) {
    const Delivery::Row& row = delivery.rows[r];
    const auto values = delivery.values.begin() + static_cast<std::ptrdiff_t>(r * width);
    std::copy(values, values + columns_.width(), row_.begin());
    for (int j = 0; j < columns_.cvs; ++j)  // until the monitor has judged it
      row_[static_cast<std::size_t>(residual(j))] =
          row_[static_cast<std::size_t>(columns_.measured(j))] -
          row_[static_cast<std::size_t>(columns_.prediction(j))];
    history_.push(row.time_ns, row_);
    intervals_.push_back(row.interval);
    if (intervals_.size() > kSettling) intervals_.pop_front();
    for (; next < row.judged; ++next)
      take_reading(delivery.judged[next],
                   std::span(delivery.readings).subspan(next * reading_width, reading_width));
  }
}

void UnitStore::take_reading(std::int64_t interval, std::span<const float> readings) {
  const auto row = std::find(intervals_.rbegin(), intervals_.rend(), interval);
  const auto rows_ago = static_cast<std::size_t>(row - intervals_.rbegin());
  for (int j = 0; j < columns_.cvs; ++j) {
    const auto first = static_cast<std::size_t>(kReadingWidth * j);
    const float prediction = readings[first], off = readings[first + 1];
    if (row != intervals_.rend()) {
      if (std::isnan(history_.value(rows_ago, columns_.prediction(j))))
        history_.amend(rows_ago, columns_.prediction(j), prediction);
      history_.amend(rows_ago, residual(j), off);
    }
    if (readings[first + 2] > 0.0F && std::isfinite(off))
      add(bands_[static_cast<std::size_t>(j)], static_cast<double>(off));
  }
}

void UnitStore::take_digest(const history::Digest& digest) {
  const std::array row{static_cast<float>(model_accuracy(digest)),
                       static_cast<float>(determined_share(digest))};
  kpi_.push(digest.until_ns, row);
}

void UnitStore::measure_rate(std::size_t rows, Clock::time_point now) {
  rate_rows_ += rows;
  if (!rate_since_) {
    rate_since_ = now;
    rate_rows_ = 0;
    return;
  }
  const std::chrono::duration<double> since = now - *rate_since_;
  if (since < kRatePeriod) return;
  rate_ = static_cast<double>(rate_rows_) / since.count();
  rate_since_ = now;
  rate_rows_ = 0;
}

std::shared_ptr<const UnitSnapshot> UnitStore::snapshot() const {
  const MutexLock lock(mutex_);
  return snapshot_;
}

double UnitStore::latest(int column) const {
  const MutexLock lock(mutex_);
  return static_cast<double>(history_.value(0, column));
}

std::optional<std::pair<std::int64_t, std::int64_t>> UnitStore::extent() const {
  const MutexLock lock(mutex_);
  if (history_.empty()) return std::nullopt;
  return std::pair(history_.first_ns(), history_.last_ns());
}

Drawing UnitStore::draw(std::int64_t from_ns, std::int64_t until_ns, int points,
                        const std::vector<int>& columns) const {
  const MutexLock lock(mutex_);
  return history_.draw(from_ns, until_ns, points, columns);
}

Drawing UnitStore::draw_kpi(int points) const {
  constexpr std::array kAll{static_cast<int>(KpiColumn::kAccuracy),
                            static_cast<int>(KpiColumn::kDetermined)};
  const MutexLock lock(mutex_);
  if (kpi_.empty()) return {{}, 0.0, std::vector<std::vector<Reach>>(kAll.size())};
  return kpi_.draw(kpi_.first_ns(), kpi_.last_ns(), points, kAll);
}

ResidualBand UnitStore::band(int cv) const {
  const MutexLock lock(mutex_);
  return bands_[static_cast<std::size_t>(cv)];
}

std::optional<live::DiagnosisOutcome> UnitStore::diagnosis() const {
  const MutexLock lock(mutex_);
  return diagnosis_;
}

double UnitStore::samples_per_second() const {
  const MutexLock lock(mutex_);
  return rate_;
}

std::uint64_t UnitStore::dropped() const {
  const MutexLock lock(mutex_);
  return dropped_;
}

std::size_t UnitStore::bytes() const {
  const MutexLock lock(mutex_);
  return history_.bytes() + kpi_.bytes();
}

}  // namespace mpm::http
