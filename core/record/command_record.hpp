#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/record/field_key.hpp"

namespace mpm {

/// A person's command as it was sent; topic mpm/command. Nothing in it has been checked.
struct CommandRecord {
  std::string unit, mv, cv;
  std::string action;  ///< a word of AlarmAction
  std::int32_t duration_s = 0;
  bool once = false;
  std::string user, host, comment;
  std::string id;
  std::int64_t time_ns = 0;  ///< UTC, when it was given
  std::string proof;         ///< host::CommandToken

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("record", std::string_view("command"));
    visit("unit", record.unit, sample.unit...);
    visit("mv", record.mv, sample.mv...);
    visit("cv", record.cv, sample.cv...);
    visit("action", record.action, sample.action...);
    visit("duration_s", record.duration_s, sample.duration_s...);
    visit("once", record.once, sample.once...);
    visit("user", record.user, sample.user...);
    visit("host", record.host, sample.host...);
    visit("comment", record.comment, sample.comment...);
    visit("id", record.id, sample.id...);
    visit("time_ns", record.time_ns, sample.time_ns...);
    visit({"proof", false}, record.proof, sample.proof...);
  }
};

/// What the proof of a command is made of: its fields in the order of the topic, but the proof,
/// each as a netstring, numbers in decimals, `once` as 0 or 1.
[[nodiscard]] std::string signed_text(const CommandRecord& command);

/// What became of it; topic mpm/command_reply.
struct CommandReplyRecord {
  std::string unit;
  std::string id;  ///< of the command
  bool accepted = false;
  std::string text;
  std::int64_t time_ns = 0;

  /// See FieldKey.
  template <class Visit, class Record, class... Sample>
  static void fields(Visit&& visit, Record& record, Sample&... sample) {
    visit("record", std::string_view("command_reply"));
    visit("unit", record.unit, sample.unit...);
    visit("id", record.id, sample.id...);
    visit("accepted", record.accepted, sample.accepted...);
    visit("text", record.text, sample.text...);
    visit("time_ns", record.time_ns, sample.time_ns...);
  }
};

}  // namespace mpm
