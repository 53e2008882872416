#include "daemon/bag/record/recorder.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "core/signal/saturated.hpp"
#include "core/text/printable.hpp"
#include "daemon/host/memory.hpp"
#include "idl/topic_catalog.hpp"
#include "idl/topics.hpp"

namespace mpm::bag {
namespace {

constexpr std::chrono::milliseconds kTick{200};
constexpr std::size_t kLayoutKeys = 2;
/// Bytes of a sample that count as large, and so many of them between two looks around as much: the
/// C library would keep that memory. Given back at the next looks, when the disk has it.
constexpr std::size_t kLarge = 100'000, kMuch = 8'000'000;
constexpr int kTrims = 3;

RecordedTopic description_of(const idl::KnownTopic& topic, const std::string& type_name) {
  return {topic.name, type_name, std::string(idl::idl_text()),
          topic.name == std::string_view(idl::kLayoutTopic) ? kLayoutKeys : 0, topic.input};
}

}  // namespace

Recorder::Recorder(const idl::Participant& participant, const RecorderOptions& options)
    : participant_(participant),
      discovery_(participant),
      unit_(options.unit),
      chosen_({options.unit}),
      queue_(options.queue_bytes),
      recording_(options.recording, clock_.now_ns()) {
  for (const idl::KnownTopic& topic : idl::known_topics())
    if (options.topics.empty()) add_known(topic);
  for (const std::string& name : options.topics) {
    if (const idl::KnownTopic* topic = idl::find_known_topic(name))
      add_known(*topic);
    else
      not_found_.insert(name);
  }
  writer_ = std::thread([this] { write_all(); });
}

Recorder::~Recorder() {
  queue_.close();
  if (writer_.joinable()) writer_.join();
}

void Recorder::add_known(const idl::KnownTopic& topic) {
  idl::RawReader reader(participant_, topic, unit_.empty() ? nullptr : &chosen_);
  const RecordedTopic description = description_of(topic, reader.type_name());
  add_reader(std::move(reader), description);
}

void Recorder::add_reader(idl::RawReader reader, const RecordedTopic& description) {
  readers_.push_back(std::move(reader));
  wait_set_.attach(readers_.back().readable());
  const MutexLock lock(mutex_);
  recording_.add_topic(description);
}

void Recorder::look_around() {
  look_for_topics();
  const std::uint64_t refused_before = refused_;
  look_for_refused();
  if (refused_ > refused_before || large_bytes_ > kMuch) trims_ = kTrims;
  large_bytes_ = 0;
  if (trims_ == 0) return;
  --trims_;
  host::give_memory_back();
}

void Recorder::look_for_refused() {
  for (idl::RawReader& reader : readers_) {
    const idl::KeyLimit::Refused refused = reader.refused();
    refused_ += refused.samples;
    if (refused.samples == 0 || !refused_on_.insert(reader.topic()).second) continue;
    news_.push_back("not recorded: samples of " + reader.topic() + " such as those of '" +
                    refused.unit + "', for a name is longer than " + std::to_string(kLongestName) +
                    " bytes, or there are more units or channels than any plant has");
  }
}

void Recorder::look_for_topics() {
  for (auto name = not_found_.begin(); name != not_found_.end();) {
    const idl::DiscoveredType type = discovery_.type_of(*name);
    if (!type) {
      ++name;
      continue;
    }
    idl::RawReader reader(participant_, *name, type);
    const RecordedTopic description{*name, reader.type_name(), "", 0, false};
    add_reader(std::move(reader), description);
    name = not_found_.erase(name);
  }
}

void Recorder::poll(std::chrono::milliseconds longest) {
  if (wait_set_.wait(longest)) take();
}

int Recorder::take() {
  int count = 0;
  const std::int64_t now_ns = clock_.now_ns();
  // What sources are stamped with: somebody may have set the clock since the recording began.
  const std::int64_t machine_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                      std::chrono::system_clock::now().time_since_epoch())
                                      .count();
  for (std::size_t topic = 0; topic < readers_.size(); ++topic) {
    const bool ours = idl::find_known_topic(readers_[topic].topic()) != nullptr;
    count += readers_[topic].take([&](idl::RawSample& sample) {
      if (ours) {
        const std::string unit = idl::unit_of(sample.cdr);
        if (unit.empty() || (!unit_.empty() && unit != unit_)) return;  // "": a writer's greeting
      }
      if (sample.cdr.size() > kLarge) large_bytes_ += sample.cdr.size();
      const std::int64_t age_ns = saturated_difference(machine_ns, sample.source_time_ns);
      batch_.push_back({topic, now_ns, std::move(sample), age_ns});
    });
  }
  if (!batch_.empty()) queue_.push(batch_);
  return count;
}

void Recorder::write_all() {
  std::vector<RecordedSample> samples;
  std::size_t written = 0;  // of `samples`
  try {
    while (true) {
      const bool save = save_asked_.exchange(false);  // before what was taken by then is popped
      if (!queue_.pop(samples, kTick)) break;
      const MutexLock lock(mutex_);
      for (written = 0; written < samples.size(); ++written) recording_.write(samples[written]);
      recording_.tick(clock_.now_ns());
      if (save) recording_.save(clock_.now_ns());
    }
    const MutexLock lock(mutex_);
    recording_.finish();
  } catch (const std::exception& error) {
    const MutexLock lock(mutex_);
    problem_ = error.what();
    recording_.give_up();
    unwritten_ = samples.size() - std::min(written, samples.size());
  }
  while (queue_.pop(samples, kTick)) {  // after a problem: what was taken has no place any more
    const MutexLock lock(mutex_);
    unwritten_ += samples.size();
  }
}

void Recorder::finish() {
  while (take() > 0) {
  }
  look_for_refused();
  queue_.close();
  if (writer_.joinable()) writer_.join();
}

std::vector<std::string> Recorder::take_news() {
  std::vector<std::string> news = std::exchange(news_, {});
  const MutexLock lock(mutex_);
  for (std::string& line : recording_.take_news()) news.push_back(std::move(line));
  return news;
}

RecorderState Recorder::state() const {
  RecorderState state;
  for (const idl::RawReader& reader : readers_) state.lost += reader.lost();
  state.refused = refused_;
  state.dropped = queue_.dropped();
  const MutexLock lock(mutex_);
  state.totals = recording_.totals();
  state.path = recording_.path();
  state.problem = problem_;
  if (!problem_.empty()) {
    state.totals.samples -= recording_.unsaved();
    state.dropped += recording_.unsaved() + unwritten_;
  }
  return state;
}

}  // namespace mpm::bag
