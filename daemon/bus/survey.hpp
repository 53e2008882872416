#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "idl/discovery.hpp"
#include "idl/raw_reader.hpp"
#include "idl/wait_set.hpp"

namespace mpm::bus {

/// A topic as seen on the bus.
struct TopicRow {
  std::string name;
  std::string type;
  int writers = 0;
  int readers = 0;
  std::set<std::string> units;  ///< whose samples were seen
};

/// Looks who is on the bus and listens to whose samples go by.
class Survey {
 public:
  explicit Survey(const idl::Participant& participant);

  /// Called with the topic's name and each of its samples.
  using OnSample = std::function<void(const std::string&, const idl::RawSample&)>;

  /// Waits for samples, at most `longest`, and notes their units. `on_sample` may be empty.
  void listen(std::chrono::milliseconds longest, const OnSample& on_sample = {});
  /// Every topic that somebody else reads or writes, by name.
  [[nodiscard]] std::vector<TopicRow> rows() const;
  [[nodiscard]] std::vector<idl::Endpoint> endpoints() const { return discovery_.endpoints(); }

 private:
  idl::Discovery discovery_;
  std::vector<idl::RawReader> readers_;  // of the topics that we know
  idl::WaitSet wait_set_;
  std::map<std::string, std::set<std::string>> units_;  // by topic
};

[[nodiscard]] nlohmann::ordered_json to_json(const TopicRow& row);
/// One line per topic below a heading.
[[nodiscard]] std::string to_text(const std::vector<TopicRow>& rows);

}  // namespace mpm::bus
