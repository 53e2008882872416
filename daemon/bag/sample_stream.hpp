#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/mcap/read/file_sequence.hpp"
#include "idl/cdr.hpp"
#include "idl/sample_view.hpp"

namespace mpm::bag {

/// "mpm/mv" ... and, in files only, "mpm/aux".
[[nodiscard]] const char* topic_of(SignalKind kind);
/// Nothing for topics that hold no samples.
[[nodiscard]] std::optional<SignalKind> kind_of(std::string_view topic);

/// The samples and layouts among the messages of a recording.
class SampleStream {
 public:
  enum class Event { kEnd, kSample, kLayout };

  /// Of files and folders, in the order of log times. Throws config::InputError where one is no
  /// whole MCAP file.
  explicit SampleStream(const std::vector<std::string>& paths) : messages_(paths) {}

  /// Throws config::InputError where the file is damaged, or where a topic of ours holds something
  /// else than it should.
  [[nodiscard]] Event next();
  /// What came last; valid until `next`. Of a layout all texts are there.
  [[nodiscard]] const idl::SampleView& sample() const { return sample_; }
  [[nodiscard]] const mpm_Layout& layout() const { return *layout_; }
  [[nodiscard]] std::int64_t log_time_ns() const { return message_.log_time_ns; }
  [[nodiscard]] const mcap::Message& message() const { return message_; }
  /// Of the span of its log times, 0..1.
  [[nodiscard]] double share_read() const;
  /// Messages passed over so far, by topic.
  [[nodiscard]] const std::map<std::string, std::uint64_t>& others() const { return others_; }

 private:
  [[noreturn]] void refuse(const char* type) const;

  mcap::FileSequence messages_;
  mcap::Message message_;
  idl::CdrDecoder<mpm_Sample> samples_;
  idl::CdrDecoder<mpm_Layout> layouts_;
  idl::SampleView sample_;
  const mpm_Layout* layout_ = nullptr;
  std::map<std::string, std::uint64_t> others_;
};

}  // namespace mpm::bag
