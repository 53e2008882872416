#include "config/cli/number_value.hpp"

#include <charconv>
#include <string>

#include "core/text/number_text.hpp"

namespace mpm::cli {

CLI::Validator number_value(double least, double most) {
  std::string range = "from " + number_text(least);
  range += most < std::numeric_limits<double>::max() ? " to " + number_text(most) : " on";
  return {[least, most, range](std::string& text) -> std::string {
            double number = 0.0;
            const char* const end = text.data() + text.size();
            const auto [rest, status] = std::from_chars(text.data(), end, number);
            const bool is_one = status == std::errc() && rest == end;
            return is_one && number >= least && number <= most
                       ? std::string()
                       : "'" + text + "' is no number " + range;
          },
          "NUMBER"};
}

}  // namespace mpm::cli
