#include "core/record/reason_text.hpp"

namespace mpm {
namespace {

constexpr std::string_view kWith = " with ";

}  // namespace

std::string reason_text(Reason reason, std::string_view confounder) {
  std::string text(to_string(reason));
  if (!confounder.empty()) text.append(kWith).append(confounder);
  return text;
}

std::pair<Reason, std::string> parse_reason(std::string_view text) {
  const std::size_t with = text.find(kWith);
  const std::string_view word = text.substr(0, with);
  const std::string_view tag =
      with == std::string_view::npos ? std::string_view() : text.substr(with + kWith.size());
  return {from_string<Reason>(word).value_or(Reason::kNone), std::string(tag)};
}

}  // namespace mpm
