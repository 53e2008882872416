#include "daemon/http/command_json.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/alarm/calibration.hpp"
#include "core/text/printable.hpp"

namespace mpm::http {
namespace {

constexpr std::array<std::string_view, 8> kKeys = {"unit",       "mv",   "cv",   "command",
                                                   "duration_s", "once", "user", "comment"};

/// Reads members of an object and remembers the first thing that is wrong.
class Reader {
 public:
  explicit Reader(const nlohmann::json& json) : json_(json) {}

  std::string text(const char* key, std::size_t longest) {
    const auto found = json_.find(key);
    if (found == json_.end() || found->is_null()) return {};
    if (!found->is_string()) return fail(std::string(key) + " is to be a text");
    auto value = found->get<std::string>();
    if (value.size() > longest)
      return fail(std::string(key) + " is longer than " + std::to_string(longest) + " bytes");
    // It goes into logs, journals and onto the bus.
    return printable(value, longest);
  }
  double number(const char* key, double most) {
    const auto found = json_.find(key);
    if (found == json_.end() || found->is_null()) return 0.0;
    if (!found->is_number()) return fail_number(std::string(key) + " is to be a number");
    const auto value = found->get<double>();
    if (!(value >= 0.0 && value <= most))
      return fail_number(std::string(key) + " is to be between 0 and " +
                         std::to_string(static_cast<long>(most)));
    return value;
  }
  bool flag(const char* key) {
    const auto found = json_.find(key);
    if (found == json_.end() || found->is_null()) return false;
    if (!found->is_boolean()) {
      fail(std::string(key) + " is to be true or false");
      return false;
    }
    return found->get<bool>();
  }
  [[nodiscard]] const std::string& problem() const { return problem_; }

  std::string fail(std::string problem) {
    if (problem_.empty()) problem_ = std::move(problem);
    return {};
  }

 private:
  double fail_number(std::string problem) {
    fail(std::move(problem));
    return 0.0;
  }

  const nlohmann::json& json_;
  std::string problem_;
};

}  // namespace

std::variant<AlarmCommand, std::string> parse_command(const std::string& body) {
  const nlohmann::json json = nlohmann::json::parse(body, nullptr, false);
  if (!json.is_object()) return "the body is to be a JSON object";
  for (const auto& [key, value] : json.items())
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end())
      return "unknown key: " + printable(key);
  Reader reader(json);
  AlarmCommand command;
  command.unit = reader.text("unit", kLongestName);
  command.mv = reader.text("mv", kLongestName);
  command.cv = reader.text("cv", kLongestName);
  command.duration_s = reader.number("duration_s", calibration::kMostShelf);
  command.once = reader.flag("once");
  command.user = reader.text("user", kLongestUser);
  command.comment = reader.text("comment", kLongestComment);
  const std::string word = reader.text("command", kLongestName);
  if (const auto action = from_string<AlarmAction>(word))
    command.action = *action;
  else
    reader.fail("unknown command: '" + word + "'");
  if (command.unit.empty()) reader.fail("unit is missing");
  if (command.user.empty()) reader.fail("user is missing: who does this is to be known later");
  if (command.mv.empty() != command.cv.empty())
    reader.fail("mv and cv go together; without both the alarm of the unit is meant");
  if (!reader.problem().empty()) return reader.problem();
  return command;
}

}  // namespace mpm::http
