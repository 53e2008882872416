#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// Plots as the page's script draws them (page.js says what it knows). Unknown values are NaN.
namespace mpm::report {

using Json = nlohmann::ordered_json;
using Series = std::vector<double>;

/// What a line is, which decides its colour.
enum class Role { kMeasured, kBefore, kAfter };

/// Values without the digits that cannot be seen: beyond a two-thousandth of their range.
[[nodiscard]] Json visible_digits(const Series& values);
/// The same to three significant digits each, for scales that are logarithmic.
[[nodiscard]] Json significant_digits(const Series& values);

/// Values over an even grid, of each `every` of them the mean; 1 = all.
[[nodiscard]] Series means_of(const Series& values, std::size_t every);
/// The smallest and the largest of each `every`.
struct Envelope {
  Series low, high;
};
[[nodiscard]] Envelope envelope_of(const Series& values, std::size_t every);
/// The `every` that keeps `samples` values within `points`.
[[nodiscard]] std::size_t thinning(std::size_t samples, std::size_t points);

/// `count` moments from `start_s` on, `step_s` apart.
struct Stretch {
  double start_s = 0.0;
  double step_s = 1.0;
  std::size_t count = 0;
};

/// One plot in the making.
class Plot {
 public:
  explicit Plot(const std::string& title);

  /// Says in small letters what the title cannot.
  Plot& note(const std::string& text);
  /// Moments on the clock of the data. A line has a value for each moment of each stretch, and an
  /// unknown one between two stretches.
  Plot& over_time(const std::vector<Stretch>& stretches);
  /// The same, but as time since something: no date.
  Plot& over_span(const std::string& label, const std::vector<Stretch>& stretches);
  /// Any x; where it goes back, lines are drawn as paths.
  Plot& over(const std::string& label, const Series& x);
  Plot& logarithmic();
  Plot& y(const std::string& label);

  Plot& line(const std::string& name, Role role, const Series& values);
  /// Dashed, points instead of a line.
  Plot& dashed(const std::string& name, Role role, const Series& values);
  Plot& points(const std::string& name, Role role, const Series& values);
  Plot& band(Role role, const Series& low, const Series& high);
  /// A path of its own over x that goes back.
  Plot& path(const std::string& name, Role role, const Series& x, const Series& values);

  Plot& mark(double x, const std::string& label);
  /// From here on no fit has seen the data.
  Plot& unseen_from(double x);
  /// Plots of one group share their x.
  Plot& group(const std::string& name);
  Plot& low();  ///< half as high as others

  [[nodiscard]] const Json& json() const { return json_; }

 private:
  Json& add(const std::string& name, Role role, const Series& values);

  Json json_;
  bool log_ = false;
};

}  // namespace mpm::report
