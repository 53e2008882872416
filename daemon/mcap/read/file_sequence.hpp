#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/mcap/read/ordered_reader.hpp"

namespace mpm::mcap {

/// True for what is read as MCAP: a folder, a file that begins so, or one that is named so.
[[nodiscard]] bool is_recording(const std::string& path);
/// The same of several. Throws config::InputError where only some are: CSV files come alone.
[[nodiscard]] bool is_recording(const std::vector<std::string>& paths);

/// `path` itself, or, if it is a folder, its *.mcap files by name.
[[nodiscard]] std::vector<std::string> recording_files(const std::string& path);
/// The same for several.
[[nodiscard]] std::vector<std::string> recording_files(const std::vector<std::string>& paths);

/// What to call them in a message: "a.mcap and 2 more".
[[nodiscard]] std::string name_of(const std::vector<std::string>& paths);

/// The messages of one or more files, which a recorder split or several made, as one recording in
/// the order of their log times; those of the same time in the order of the files. Files that
/// follow each other are open one at a time.
class FileSequence {
 public:
  struct File {
    std::string path;
    std::int64_t start_ns = 0, end_ns = 0;
    bool end_known =
        true;  ///< not where messages lie outside of chunks: heads tell no time of those
    std::set<std::string> topics;
  };

  /// `paths`: files and folders. Throws config::InputError where one is no recording, or is torn.
  explicit FileSequence(const std::vector<std::string>& paths);

  /// False at the end. Throws config::InputError where a file is damaged. The message is valid
  /// until the next call.
  [[nodiscard]] bool next(Message& message);
  void rewind();

  /// By their start; without those that hold no message.
  [[nodiscard]] const std::vector<File>& files() const { return files_; }
  /// Of the files, that of the last message.
  [[nodiscard]] const std::string& file() const { return files_[last_file_].path; }

 private:
  struct Open {
    std::size_t file = 0;
    std::unique_ptr<MessageSource> messages;
    Message head;
  };

  void look_at(const std::string& path);
  void open_files_up_to_head();

  std::vector<File> files_;
  std::size_t next_file_ = 0;
  std::vector<Open> open_;            // by file
  std::optional<std::size_t> given_;  // of open_: the one whose head was given out
  std::size_t last_file_ = 0;
};

}  // namespace mpm::mcap
