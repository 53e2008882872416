#include "tests/hidden/element.hpp"

#include <algorithm>
#include <cmath>

namespace mpm::hidden {

double RunningElement::next(double command) {
  ++k_;
  if (const auto* bent = std::get_if<Bent>(&element_))
    return command + bent->quadratic * command * command +
           bent->cubic * command * command * command;
  if (const auto* limited = std::get_if<Limited>(&element_))
    return std::min(std::max(command, limited->low), limited->high);
  if (const auto* play = std::get_if<Play>(&element_)) {
    if (command - position_ > play->width / 2) position_ = command - play->width / 2;
    if (position_ - command > play->width / 2) position_ = command + play->width / 2;
    return position_;
  }
  if (const auto* standing = std::get_if<Standing>(&element_))
    return k_ >= standing->from ? standing->value : command;
  if (const auto* shifted = std::get_if<Shifted>(&element_))
    return command + (k_ >= shifted->from ? shifted->size : 0.0);
  if (const auto* valve = std::get_if<Sticking>(&element_)) return next(*valve, command);
  return command;
}

double RunningElement::next(const Sticking& valve, double command) {
  const double step = command - last_command_;
  last_command_ = command;
  if (moving_ != 0 && !(step * moving_ > 0.0)) moving_ = 0;
  const double away = command - position_;
  if (moving_ == 0 && std::abs(away) > (valve.band + valve.jump) / 2) moving_ = away > 0.0 ? 1 : -1;
  if (moving_ != 0) position_ = command - moving_ * (valve.band - valve.jump) / 2;
  if (valve.slips_once) moving_ = 0;
  return position_;
}

}  // namespace mpm::hidden
