#include "daemon/bag/info_text.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <limits>

#include "core/signal/saturated.hpp"
#include "core/text/number_text.hpp"
#include "core/text/printable.hpp"
#include "daemon/bag/sample_stream.hpp"
#include "daemon/files/times/time_text.hpp"

namespace mpm::bag {
namespace {

using Json = nlohmann::ordered_json;

// Divided, not multiplied by 1e-9, which is no double: 249.5 s stay 249.5.
double seconds(std::int64_t ns) { return static_cast<double>(ns) / 1e9; }

Json span_json(const TimeTally& times) {
  Json json;
  json["count"] = times.count;
  if (times.count == 0) return json;
  json["start"] = files::utc_text(times.first_ns);
  json["end"] = files::utc_text(times.last_ns);
  json["duration_s"] = seconds(saturated_difference(times.last_ns, times.first_ns));
  json["rate_hz"] = times.rate_hz();
  return json;
}

Json gaps_json(const TimeTally& times) {
  Json json;
  json["count"] = times.gaps;
  json["missing"] = times.missing;
  if (times.gaps == 0) return json;
  json["longest_s"] = seconds(times.longest_gap_ns);
  json["longest_at"] = files::utc_text(times.longest_gap_at_ns);
  return json;
}

Json order_json(const TimeTally& times) {
  Json json;
  json["count"] = times.out_of_order;
  if (times.out_of_order == 0) return json;
  json["farthest_back_s"] = seconds(times.farthest_back_ns);
  json["farthest_back_at"] = files::utc_text(times.farthest_back_at_ns);
  return json;
}

Json signals_json(const std::vector<SignalTally>& signals) {
  Json json = Json::array();
  for (const SignalTally& signal : signals)
    json.push_back({{"tag", signal.tag},
                    {"good", signal.good},
                    {"uncertain", signal.uncertain},
                    {"bad", signal.bad},
                    {"missing", signal.missing}});
  return json;
}

void add_mcap(const FileInfo& info, Json& json) {
  json["files"] = info.files;
  json["library"] = info.library;
  json["profile"] = info.profile;
  json["index"] = info.index_problem.empty() ? "intact" : info.index_problem;
  json["chunks"] = {{"count", info.chunks},
                    {"compression", info.compressions},
                    {"packed_bytes", info.packed_bytes},
                    {"unpacked_bytes", info.unpacked_bytes}};
  json["topics"] = Json::array();
  for (const auto& [name, topic] : info.topics)
    json["topics"].push_back({{"topic", name},
                              {"type", topic.type},
                              {"schema_encoding", topic.schema_encoding},
                              {"message_encoding", topic.message_encoding},
                              {"bytes", topic.bytes},
                              {"messages", span_json(topic.times)}});
  json["units"] = Json::array();
  for (const auto& [name, unit] : info.units) {
    Json unit_json = {{"unit", name}, {"sample_time_s", unit.sample_time_s}};
    unit_json["samples"] = Json::array();
    for (const auto& [kind, samples] : unit.samples)
      unit_json["samples"].push_back({{"topic", topic_of(kind)},
                                      {"times", span_json(samples.times)},
                                      {"gaps", gaps_json(samples.times)},
                                      {"signals", signals_json(samples.signals)}});
    json["units"].push_back(std::move(unit_json));
  }
}

/// printf into a string.
__attribute__((format(printf, 1, 2))) std::string line(const char* format, ...) {
  std::array<char, 512> text{};
  va_list arguments;
  va_start(arguments, format);
  const int size = std::vsnprintf(text.data(), text.size(), format, arguments);
  va_end(arguments);
  return {text.data(), std::min(text.size() - 1, static_cast<std::size_t>(std::max(size, 0)))};
}

/// Of a difference of times that came from outside and may be anything (`saturated_difference`).
std::string length_text(std::int64_t ns) {
  const bool more = ns == std::numeric_limits<std::int64_t>::max();
  return (more ? "more than " : std::string()) + duration_text(seconds(ns));
}

std::string span_text(const TimeTally& times) {
  if (times.count == 0) return "nothing";
  return files::utc_text(times.first_ns) + " to " + files::utc_text(times.last_ns) + " (" +
         length_text(saturated_difference(times.last_ns, times.first_ns)) + ")";
}

std::string gaps_text(const TimeTally& times) {
  if (times.gaps == 0) return "no gaps";
  return counted(times.gaps, "gap") + ", " + std::to_string(times.missing) +
         " missing, the longest " + length_text(times.longest_gap_ns) + " at " +
         files::utc_text(times.longest_gap_at_ns);
}

std::string order_text(const TimeTally& times) {
  if (times.out_of_order == 0) return {};
  return "; " + counted(times.out_of_order, "row") +
         " not later than the one before, the farthest back by " +
         length_text(times.farthest_back_ns) + " after " +
         files::utc_text(times.farthest_back_at_ns);
}

std::string signal_text(const SignalTally& signal) {
  const auto all =
      static_cast<double>(signal.good + signal.uncertain + signal.bad + signal.missing);
  const auto share = [&](std::uint64_t count, const char* what) {
    return count == 0 ? std::string()
                      : line(", %.4g %% %s", 100.0 * static_cast<double>(count) / all, what);
  };
  std::string text =
      line("%.4g %% good", all == 0.0 ? 0.0 : 100.0 * static_cast<double>(signal.good) / all);
  text += share(signal.uncertain, "uncertain");
  text += share(signal.bad, "bad");
  text += share(signal.missing, "missing");
  return line("    %-20s ", printable(signal.tag).c_str()) + text + '\n';
}

std::string mcap_text(const FileInfo& info) {
  std::string text;
  std::string packing;
  for (const std::string& name : info.compressions)
    packing += (packing.empty() ? "" : ", ") +
               (name.empty() ? std::string("not packed") : printable(name));
  text += "  chunks: " + std::to_string(info.chunks);
  if (info.chunks > 0)
    text += " (" + packing + "), " + bytes_text(info.unpacked_bytes) + " in " +
            bytes_text(info.packed_bytes);
  text += "\n  index: " + (info.index_problem.empty() ? "intact" : info.index_problem) + "\n";
  text += "  topics:\n";
  for (const auto& [name, topic] : info.topics)
    text += line("    %-24s %10llu messages  %8.4g Hz  ", printable(name).c_str(),
                 static_cast<unsigned long long>(topic.times.count), topic.times.rate_hz()) +
            printable(topic.type) + " (" + printable(topic.message_encoding) +
            (topic.schema_encoding.empty() ? "" : ", " + printable(topic.schema_encoding)) + ")\n";
  for (const auto& [name, unit] : info.units) {
    text += "  unit " + printable(name);
    if (unit.sample_time_s > 0.0) text += line(", every %.6g s", unit.sample_time_s);
    text += "\n";
    for (const auto& [kind, samples] : unit.samples) {
      text += std::string("   ") + topic_of(kind) + ": " + counted(samples.times.count, "sample") +
              ", " + gaps_text(samples.times) + "\n";
      for (const SignalTally& signal : samples.signals) text += signal_text(signal);
    }
  }
  return text;
}

std::string csv_text(const FileInfo& info) {
  std::string text = "  layout: " + info.layout + ", cells by " +
                     (info.delimiter == '\t' ? std::string("tab") : std::string(1, info.delimiter));
  if (info.step_s > 0.0) text += line("; rows every %.6g s", info.step_s);
  text += "; " + gaps_text(info.times) + order_text(info.times) + "\n  signals:\n";
  for (const SignalTally& signal : info.signals) text += signal_text(signal);
  return text;
}

}  // namespace

std::string duration_text(double s) {
  if (s < 120.0) return line("%.3g s", s);
  if (s < 7200.0) return line("%.1f min", s / 60.0);
  if (s < 172800.0) return line("%.1f h", s / 3600.0);
  return line("%.1f days", s / 86400.0);
}

std::string bytes_text(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value < 1e4) return line("%.0f bytes", value);
  if (value < 1e7) return line("%.1f kB", value * 1e-3);
  if (value < 1e10) return line("%.1f MB", value * 1e-6);
  return line("%.1f GB", value * 1e-9);
}

Json to_json(const FileInfo& info) {
  Json json;
  json["file"] = info.path;
  json["format"] = info.is_mcap ? "mcap" : "csv";
  json["bytes"] = info.bytes;
  json["whole"] = info.problem.empty();
  if (!info.problem.empty()) json["problem"] = info.problem;
  json[info.is_mcap ? "messages" : "rows"] = span_json(info.times);
  if (info.is_mcap) {
    add_mcap(info, json);
    return json;
  }
  json["layout"] = info.layout;
  json["delimiter"] = std::string(1, info.delimiter);
  json["step_s"] = info.step_s;
  json["gaps"] = gaps_json(info.times);
  json["out_of_order"] = order_json(info.times);
  json["signals"] = signals_json(info.signals);
  json["notices"] = info.notices;
  return json;
}

std::string to_text(const FileInfo& info) {
  std::string text =
      info.path + ": " + (info.is_mcap ? "MCAP" : "CSV") + ", " + bytes_text(info.bytes);
  if (info.files.size() > 1) text += ", " + std::to_string(info.files.size()) + " files";
  if (!info.library.empty()) text += ", written by " + printable(info.library);
  text += "\n  " + counted(info.times.count, info.is_mcap ? "message" : "row") + ", " +
          span_text(info.times) + "\n";
  if (!info.problem.empty()) text += "  NOT WHOLE: " + info.problem + "\n";
  return text + (info.is_mcap ? mcap_text(info) : csv_text(info));
}

}  // namespace mpm::bag
