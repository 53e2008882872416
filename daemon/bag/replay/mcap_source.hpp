#pragma once

#include <set>
#include <string>
#include <vector>

#include "daemon/bag/lifecycle.hpp"
#include "daemon/bag/replay/replay_source.hpp"
#include "daemon/mcap/file_sequence.hpp"

namespace mpm::bag {

/// Recordings as one: the samples of all files in the order of their log times.
class McapSource : public ReplaySource {
 public:
  /// `topics`: those to replay. Throws config::InputError where a file is no recording, is torn or
  /// holds none of them.
  McapSource(const std::vector<std::string>& files, const std::set<std::string>& topics);

  [[nodiscard]] bool next(ReplaySample& sample) override;
  void rewind() override { messages_.rewind(); }

  /// Those of the chosen topics that the files hold.
  [[nodiscard]] const std::set<std::string>& topics() const { return found_; }
  /// From the first to the last log time of the files, whatever the topic, in ns; 0 where that is
  /// not known without reading them.
  [[nodiscard]] std::int64_t length_ns() const { return end_known_ ? end_ns_ - begin_ns_ : 0; }
  /// Of the files, that of the last sample.
  [[nodiscard]] const std::string& file() const { return messages_.file(); }

 private:
  [[nodiscard]] bool wanted(const mcap::Message& message) const;
  void fill(const mcap::Message& message, ReplaySample& sample);

  std::set<std::string> topics_, found_;
  mcap::FileSequence messages_;
  std::int64_t begin_ns_ = 0, end_ns_ = 0;
  bool end_known_ = true;
  Lifecycle lifecycle_;
};

}  // namespace mpm::bag
