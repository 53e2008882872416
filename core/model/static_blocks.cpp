#include "core/model/static_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/archive/archive.hpp"

namespace mpm {
namespace {

void check_saturation(const Saturation& limits) {
  if (!(limits.low <= limits.high)) throw std::invalid_argument("saturation needs low <= high");
}

double polynomial_value(const Polynomial& polynomial, double deviation) {
  const std::vector<double>& c = polynomial.coefficients;
  return std::accumulate(c.rbegin(), c.rend(), 0.0, [deviation](double value, double coefficient) {
    return (value + coefficient) * deviation;
  });
}

double two_sided_value(const TwoSided& sides, double input, double origin) {
  const double at = std::isfinite(sides.at) ? sides.at : origin;
  const auto acting = [&](double value) {
    return (value < at ? sides.below : sides.above) * (value - at);
  };
  return acting(input) - acting(origin);
}

int sign_of(double value) { return (value > 0.0) - (value < 0.0); }

}  // namespace

int other_input(const std::optional<InputBlock>& block) {
  const auto* product = block ? std::get_if<Product>(&*block) : nullptr;
  return product == nullptr ? -1 : product->of;
}

InputElement::InputElement(std::optional<InputBlock> block, double origin)
    : block_(std::move(block)), origin_(origin) {
  if (!block_) return;
  if (const auto* limits = std::get_if<Saturation>(&*block_)) check_saturation(*limits);
  if (const auto* play = std::get_if<Deadband>(&*block_); play && !(play->width >= 0.0))
    throw std::invalid_argument("deadband width must not be negative");
  if (const auto* valve = std::get_if<Stiction>(&*block_);
      valve && !(valve->band >= 0.0 && valve->jump >= 0.0))
    throw std::invalid_argument("stiction band and jump must not be negative");
  if (const auto* stuck = std::get_if<Stuck>(&*block_); stuck && !std::isfinite(stuck->value))
    throw std::invalid_argument("stuck needs a finite value");
  if (const auto* offset = std::get_if<InputOffset>(&*block_);
      offset && !std::isfinite(offset->size))
    throw std::invalid_argument("offset needs a finite size");
  if (const auto* sides = std::get_if<TwoSided>(&*block_);
      sides && !(std::isfinite(sides->above) && std::isfinite(sides->below)))
    throw std::invalid_argument("two_sided needs finite ratios");
  if (const auto* product = std::get_if<Product>(&*block_);
      product && !(std::isfinite(product->per_unit) && std::isfinite(product->linear)))
    throw std::invalid_argument("product needs finite numbers");
  reset(origin);
}

void InputElement::reset(double input) {
  position_ = input;
  last_input_ = input;
  direction_ = 0;
}

void InputElement::archive(Archive& a) {
  // not archived: block_, origin_ (construction)
  a(position_, last_input_);
  a.within(direction_, -1, 1);
}

double InputElement::apply(double input, double time_s, double other_deviation) {
  if (!block_) return input - origin_;
  if (const auto* polynomial = std::get_if<Polynomial>(&*block_))
    return polynomial_value(*polynomial, input - origin_);
  if (const auto* limits = std::get_if<Saturation>(&*block_))
    return std::clamp(input, limits->low, limits->high) - origin_;
  if (const auto* play = std::get_if<Deadband>(&*block_)) {
    position_ = std::clamp(position_, input - 0.5 * play->width, input + 0.5 * play->width);
    return position_ - origin_;
  }
  if (const auto* stuck = std::get_if<Stuck>(&*block_))
    return (time_s >= stuck->onset_s ? stuck->value : input) - origin_;
  if (const auto* offset = std::get_if<InputOffset>(&*block_))
    return input + (time_s >= offset->onset_s ? offset->size : 0.0) - origin_;
  if (const auto* sides = std::get_if<TwoSided>(&*block_))
    return two_sided_value(*sides, input, origin_);
  if (const auto* product = std::get_if<Product>(&*block_))
    return (product->linear + product->per_unit * other_deviation) * (input - origin_);
  return apply_stiction(std::get<Stiction>(*block_), input) - origin_;
}

double InputElement::apply_stiction(const Stiction& valve, double input) {
  const double static_friction = 0.5 * (valve.band + valve.jump);
  const double moving_friction = 0.5 * (valve.band - valve.jump);
  if (direction_ != 0 && sign_of(input - last_input_) != direction_) direction_ = 0;
  if (direction_ == 0 && std::abs(input - position_) > static_friction)
    direction_ = sign_of(input - position_);
  if (direction_ != 0) position_ = input - direction_ * moving_friction;
  if (valve.slips_once) direction_ = 0;
  last_input_ = input;
  return position_;
}

double apply_output_block(const std::optional<OutputBlock>& block, double origin,
                          double deviation) {
  if (!block) return origin + deviation;
  if (const auto* limits = std::get_if<Saturation>(&*block))
    return std::clamp(origin + deviation, limits->low, limits->high);
  if (const auto* offset = std::get_if<Offset>(&*block)) return origin + deviation + offset->bias;
  return origin + std::get<Scale>(*block).factor * deviation;
}

void check_output_block(const OutputBlock& block) {
  if (const auto* limits = std::get_if<Saturation>(&block)) check_saturation(*limits);
}

}  // namespace mpm
