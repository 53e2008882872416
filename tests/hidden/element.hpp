#pragma once

#include <variant>

namespace mpm::hidden {

/// What stands in front of a hidden plant's linear part: written anew, so that an error in the
/// model's blocks cannot hide itself. Acts on the deviation from the operating point.
struct Bent {
  double quadratic = 0.0, cubic = 0.0;  ///< u + quadratic u^2 + cubic u^3
};
struct Limited {
  double low = 0.0, high = 0.0;
};
struct Play {
  double width = 0.0;
};
/// Stays until the command is more than (band + jump) / 2 away, then goes to (band - jump) / 2 from
/// it. `slips_once`: sticks again at once (He, Wang, Pottmann and Qin 2007); otherwise follows as
/// long as the command keeps its direction (Choudhury, Thornhill and Shah 2005).
struct Sticking {
  double band = 0.0, jump = 0.0;
  bool slips_once = false;
};
/// Stands at a value from sample `from` on, whatever is commanded.
struct Standing {
  double value = 0.0;
  int from = 0;
};
/// Is open by so much more than its command from sample `from` on.
struct Shifted {
  double size = 0.0;
  int from = 0;
};
using Element = std::variant<std::monostate, Bent, Limited, Play, Sticking, Standing, Shifted>;

/// An element with its memory, at rest at 0 before sample 0.
class RunningElement {
 public:
  RunningElement(Element element = {})
      : element_(element) {}  // NOLINT: one is as good as the other
  [[nodiscard]] double next(double command);

 private:
  [[nodiscard]] double next(const Sticking& valve, double command);

  Element element_;
  double position_ = 0.0, last_command_ = 0.0;
  int moving_ = 0;  ///< direction; 0 = stuck
  int k_ = -1;      ///< sample of the last command
};

}  // namespace mpm::hidden
