#include "daemon/bus/watch/printable_output.hpp"

#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "core/text/printable.hpp"

namespace mpm::bus {
namespace {

constexpr std::size_t kLongestSentence = 1000;  // of a diagnosis

/// Visits the fields of a record; whatever is no text is fine.
class TextCleaner {
 public:
  void operator()(const FieldKey&, auto&& member) const { clean(member); }

 private:
  static void clean(std::string& text) { text = printable(text, kLongestSentence); }
  static void clean(std::optional<std::string>& text) {
    if (text) clean(*text);
  }
  static void clean(std::vector<CauseParameter>& parameters) {
    for (CauseParameter& parameter : parameters) clean(parameter.name);
  }
  template <HasFields Part>
  static void clean(Part& part) {
    Part::fields(TextCleaner(), part);
  }
  template <HasFields Part>
  static void clean(std::vector<Part>& parts) {
    for (Part& part : parts) clean(part);
  }
  template <class... Member>
  static void clean(const std::tuple<Member&...>& members) {
    std::apply([](auto&... member) { (clean(member), ...); }, members);
  }
  static void clean(const auto&) {}
};

template <class Record>
void clean(Record& record) {
  Record::fields(TextCleaner(), record);
}
void clean(idl::LayoutRecord& layout) {
  layout.unit = printable(layout.unit);
  layout.kind = printable(layout.kind);
  for (std::string& tag : layout.tags) tag = printable(tag);
}
void clean(idl::MonitorGone& gone) { gone.unit = printable(gone.unit); }

}  // namespace

idl::Output printable_output(idl::Output output) {
  std::visit([](auto& record) { clean(record); }, output);
  return output;
}

}  // namespace mpm::bus
