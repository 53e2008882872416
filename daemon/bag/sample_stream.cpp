#include "daemon/bag/sample_stream.hpp"

#include "config/finding.hpp"
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

}  // namespace mpm::bag
