#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/mcap/ordered_reader.hpp"
#include "daemon/record/lifecycle.hpp"
#include "daemon/replay/replay_source.hpp"

namespace mpm::daemon {

/// `path` itself, or, if it is a folder, its *.mcap files.
[[nodiscard]] std::vector<std::string> recording_files(const std::string& path);

/// Recordings as one: the samples of all files in the order of their log times.
class McapSource : public ReplaySource {
 public:
  /// `topics`: those to replay. Throws config::InputError where a file is no recording, is torn or
  /// holds none of them.
  McapSource(const std::vector<std::string>& files, const std::set<std::string>& topics);

  [[nodiscard]] bool next(ReplaySample& sample) override;
  void rewind() override;

  /// Those of the chosen topics that the files hold.
  [[nodiscard]] const std::set<std::string>& topics() const { return found_; }
  /// From the first to the last log time of the files, whatever the topic, in ns; 0 where that is
  /// not known without reading them.
  [[nodiscard]] std::int64_t length_ns() const { return end_known_ ? end_ns_ - begin_ns_ : 0; }
  /// Of the files, that of the last sample.
  [[nodiscard]] const std::string& file() const;

 private:
  struct File {
    std::string path;
    std::int64_t start_ns = 0;
  };
  struct Open {
    std::size_t file = 0;
    std::unique_ptr<mcap::MessageSource> messages;
    mcap::Message head;
  };

  void look_at(const std::string& path);
  void open_files_up_to_head();
  [[nodiscard]] bool advance(Open& open) const;
  [[nodiscard]] bool wanted(const mcap::Message& message) const;
  [[nodiscard]] bool fill(const mcap::Message& message, ReplaySample& sample);

  std::set<std::string> topics_, found_;
  std::vector<File> files_;  // by their start
  std::int64_t begin_ns_ = 0, end_ns_ = 0;
  bool end_known_ = true;
  std::size_t next_file_ = 0;
  std::vector<Open> open_;            // by file
  std::optional<std::size_t> given_;  // of open_: the one whose head was given out
  std::size_t last_file_ = 0;
  Lifecycle lifecycle_;
};

}  // namespace mpm::daemon
