#include "daemon/bus/survey.hpp"

#include <algorithm>
#include <cstdio>

#include "core/text/printable.hpp"
#include "idl/topic_catalog.hpp"

namespace mpm::bus {
namespace {

std::string joined(const std::set<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + printable(word);
  return text;
}

std::string line(const std::string& name, std::size_t name_width, const std::string& type,
                 std::size_t type_width, const std::string& writers, const std::string& readers,
                 const std::string& units) {
  const auto padded = [](const std::string& text, std::size_t width) {
    return text + std::string(width - std::min(width, text.size()), ' ') + "  ";
  };
  std::string row = padded(name, name_width) + padded(type, type_width) + padded(writers, 7) +
                    padded(readers, 7) + units;
  row.erase(row.find_last_not_of(' ') + 1);
  return row + "\n";
}

}  // namespace

Survey::Survey(const idl::Participant& participant) : discovery_(participant) {
  for (const idl::KnownTopic& topic : idl::known_topics())
    readers_.emplace_back(participant, topic);
  readers_.emplace_back(participant, idl::role_topic());
  for (const idl::RawReader& reader : readers_) wait_set_.attach(reader.readable());
}

void Survey::listen(std::chrono::milliseconds longest, const OnSample& on_sample) {
  if (!wait_set_.wait(longest)) return;
  for (idl::RawReader& reader : readers_) {
    reader.take([&](const idl::RawSample& sample) {
      const std::string unit = sample.valid ? idl::unit_of(sample.cdr) : "";
      if (!unit.empty()) units_[reader.topic()].insert(unit);
      if (on_sample) on_sample(reader.topic(), sample);
    });
  }
}

std::vector<TopicRow> Survey::rows() const {
  std::map<std::string, TopicRow> rows;
  for (const idl::Endpoint& endpoint : discovery_.endpoints()) {
    TopicRow& row = rows[endpoint.topic];
    row.name = endpoint.topic;
    row.type = endpoint.type;
    ++(endpoint.writer ? row.writers : row.readers);
    if (const auto units = units_.find(endpoint.topic); units != units_.end())
      row.units = units->second;
  }
  std::vector<TopicRow> list;
  list.reserve(rows.size());
  for (auto& [name, row] : rows) list.push_back(std::move(row));
  return list;
}

nlohmann::ordered_json to_json(const TopicRow& row) {
  return {{"topic", row.name},
          {"type", row.type},
          {"writers", row.writers},
          {"readers", row.readers},
          {"units", row.units}};
}

std::string to_text(const std::vector<TopicRow>& rows) {
  std::size_t name_width = 5, type_width = 4;
  for (const TopicRow& row : rows) {
    name_width = std::max(name_width, printable(row.name).size());
    type_width = std::max(type_width, printable(row.type).size());
  }
  std::string text = line("topic", name_width, "type", type_width, "writers", "readers", "units");
  for (const TopicRow& row : rows)
    text += line(printable(row.name), name_width, printable(row.type), type_width,
                 std::to_string(row.writers), std::to_string(row.readers), joined(row.units));
  return text;
}

}  // namespace mpm::bus
