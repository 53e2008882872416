#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

namespace mpm::live {

/// Bytes that stand for all that a unit's samples have made of it, as it was when a file of its
/// `SampleLog` began, beside that file on disk: whoever takes them back has only that file and the
/// later ones to take again. Written by a thread of its own, whole or not at all; the last two
/// stay.
class StateFiles {
 public:
  /// `belongs`: to which program and which unit; bytes that belong elsewhere are never used.
  StateFiles(std::string folder, std::string belongs);
  StateFiles(const StateFiles&) = delete;  // the thread reads it
  StateFiles& operator=(const StateFiles&) = delete;

  /// The files of the log, of those that there are (`files`, ascending), of whose beginning a state
  /// is kept, newest first. States of other files go, and what a killed process was writing. To be
  /// called before anything is kept.
  [[nodiscard]] std::vector<std::uint64_t> find(const std::vector<std::uint64_t>& files);
  /// Why a state is not used that is whole.
  static constexpr const char* kBelongsElsewhere = "it is of another program or unit file";
  /// Nothing where it is damaged, cannot be read, or does not belong here, and `why`.
  [[nodiscard]] std::optional<std::vector<std::byte>> read(std::uint64_t file,
                                                           std::string& why) const;
  [[nodiscard]] std::string path(std::uint64_t file) const;
  /// Has what `fill` appends written, beside the file that it names; nothing where it names none.
  /// Where the one before is still being written, that must do. Returns whether it will be.
  bool keep(const std::function<std::optional<std::uint64_t>(std::vector<std::byte>&)>& fill);
  /// So many bytes are to be expected: takes the memory for them now.
  void expect(std::size_t bytes);
  /// Looks whether what was to be kept is written, or could not be; true where nothing is at hand.
  bool poll();
  /// Of those on disk, as `find` and `poll` have seen, the first; 0: none. What is behind it in the
  /// log may be wanted, where the last one is damaged.
  [[nodiscard]] std::uint64_t oldest() const { return oldest_; }
  /// Why the last one could not be written; empty: it could, as far as `poll` has seen.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  struct Written {
    std::uint64_t oldest = 0;
    std::string problem;
    std::vector<std::byte> bytes;  // back, for their memory
  };

  std::string folder_, belongs_;
  std::future<Written> writing_;  // is waited for at the end
  std::vector<std::byte> bytes_;
  std::uint64_t oldest_ = 0;
  std::string problem_;
};

}  // namespace mpm::live
