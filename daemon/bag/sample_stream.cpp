#include "daemon/bag/sample_stream.hpp"

#include <algorithm>

#include "config/finding.hpp"
#include "core/signal/saturated.hpp"
#include "core/text/printable.hpp"
#include "idl/layout_sample.hpp"

namespace mpm::bag {
namespace {

constexpr const char* kAuxTopic = "mpm/aux";

}  // namespace

const char* topic_of(SignalKind kind) {
  return kind == SignalKind::kAux ? kAuxTopic : idl::sample_topic(kind);
}

std::optional<SignalKind> kind_of(std::string_view topic) {
  if (topic == kAuxTopic) return SignalKind::kAux;
  for (const SignalKind kind : idl::kTopicKinds)
    if (topic == idl::sample_topic(kind)) return kind;
  return std::nullopt;
}

void SampleStream::refuse(const char* type) const {
  throw config::InputError({messages_.file(), 0, 0, config::Severity::kError, "",
                            "message " + std::to_string(message_.sequence) + " on " +
                                printable(message_.channel->topic) + " (" +
                                printable(message_.channel->message_encoding) + ") is no " + type +
                                " in CDR"});
}

SampleStream::Event SampleStream::next() {
  while (messages_.next(message_)) {
    const mcap::Channel& channel = *message_.channel;
    const bool cdr = channel.message_encoding == "cdr";
    if (const std::optional<SignalKind> kind = kind_of(channel.topic)) {
      const mpm_Sample* sample = cdr ? samples_.decode(message_.data) : nullptr;
      if (sample == nullptr) refuse("mpm::Sample");
      sample_ = idl::view_of(*kind, *sample);
      return Event::kSample;
    }
    if (channel.topic == idl::kLayoutTopic) {
      layout_ = cdr ? layouts_.decode(message_.data) : nullptr;
      if (layout_ == nullptr || !idl::complete(*layout_)) refuse("mpm::Layout");
      return Event::kLayout;
    }
    ++others_[channel.topic];
  }
  return Event::kEnd;
}

double SampleStream::share_read() const {
  const std::vector<mcap::FileSequence::File>& files = messages_.files();
  if (files.empty() || message_.log_time_ns < files.front().start_ns) return 0.0;
  std::int64_t end_ns = files.front().end_ns;
  for (const mcap::FileSequence::File& file : files) end_ns = std::max(end_ns, file.end_ns);
  const auto since_start = [&](std::int64_t time_ns) {
    return static_cast<double>(saturated_difference(time_ns, files.front().start_ns));
  };
  return end_ns <= files.front().start_ns
             ? 1.0
             : std::min(1.0, since_start(message_.log_time_ns) / since_start(end_ns));
}

}  // namespace mpm::bag
