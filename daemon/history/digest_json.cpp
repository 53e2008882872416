#include "daemon/history/digest_json.hpp"

#include "daemon/report/record_json.hpp"

namespace mpm::history {
namespace {

class Maker {
 public:
  using Json = nlohmann::ordered_json;

  explicit Maker(Json& json) : json_(json) {}

  template <class Member>
  void operator()(const FieldKey& key, const Member& member) const {
    if (key.shown) json_[key.name] = member;
  }
  template <class Entry>
  void operator()(const FieldKey& key, const std::vector<Entry>& entries) const {
    Json& list = json_[key.name] = Json::array();
    for (const Entry& entry : entries) {
      Json made = Json::object();
      Entry::fields(Maker(made), entry);
      list.push_back(std::move(made));
    }
  }

 private:
  Json& json_;
};

class Taker {
 public:
  explicit Taker(const nlohmann::json& json) : json_(json) {}

  template <class Member>
  void operator()(const FieldKey& key, Member& member) const {
    if (key.shown || json_.contains(key.name)) json_.at(key.name).get_to(member);
  }
  template <class Entry>
  void operator()(const FieldKey& key, std::vector<Entry>& entries) const {
    for (const nlohmann::json& json : json_.at(key.name))
      Entry::fields(Taker(json), entries.emplace_back());
  }

 private:
  const nlohmann::json& json_;
};

}  // namespace

std::string line_of(const UnitHead& head) {
  Maker::Json json{{"record", "journal"}};
  UnitHead::fields(Maker(json), head);
  return report::json_text(json);
}

std::string line_of(const std::string& unit, const Digest& digest) {
  Maker::Json json{{"record", "digest"}, {"unit", unit}};
  Digest::fields(Maker(json), digest);
  return report::json_text(json);
}

UnitHead head_of(const nlohmann::json& line) {
  UnitHead head;
  UnitHead::fields(Taker(line), head);
  return head;
}

Digest digest_of(const nlohmann::json& line) {
  Digest digest;
  Digest::fields(Taker(line), digest);
  return digest;
}

}  // namespace mpm::history
