#pragma once

#include <string_view>
#include <vector>

namespace mpm::fuzz {

/// What reads bytes that others may have written. `exercise` returns, whatever they are: bad input
/// ends in the errors that it is to end in, which are kept inside; anything else comes out.
struct Target {
  const char* name;  ///< also of its folder in tests/fuzz/corpus
  void (*exercise)(std::string_view bytes);
};

void unit_file(std::string_view bytes);  ///< YAML of a unit, and of a scenario of it
void csv(std::string_view bytes);        ///< a data file, and a table of step responses
void mcap(std::string_view bytes);       ///< a recording
void cdr(std::string_view bytes);        ///< a byte that chooses the topic, then a sample's payload
void json_lines(std::string_view bytes);  ///< lines of `mpm publish`, of a journal, a command
void http(std::string_view bytes);        ///< all that a client sends over one connection
void sample_log(std::string_view bytes);  ///< a file of the samples kept for a restart
void state_file(std::string_view bytes);  ///< a file that keeps a state
/// Places and what is written there, of twelve bytes each, in the state of a unit; then the unit
/// goes on.
void state(std::string_view bytes);

[[nodiscard]] inline const std::vector<Target>& targets() {
  static const std::vector<Target> all = {{"unit_file", unit_file},
                                          {"csv", csv},
                                          {"mcap", mcap},
                                          {"cdr", cdr},
                                          {"json_lines", json_lines},
                                          {"http", http},
                                          {"sample_log", sample_log},
                                          {"state_file", state_file},
                                          {"state", state}};
  return all;
}

}  // namespace mpm::fuzz
