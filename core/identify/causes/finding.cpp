#include "core/identify/causes/finding.hpp"

namespace mpm {

std::string Parameter::name() const {
  return number > 0 ? quantity->name + ("_" + std::to_string(number)) : quantity->name;
}

bool includes_nothing(const Parameter& parameter) {
  const double nothing = parameter.quantity->unit == Unit::kOfModel ? 1.0 : 0.0;
  return parameter.low <= nothing && nothing <= parameter.high;
}

const Parameter* Finding::find(const Quantity& quantity) const {
  for (const Parameter& parameter : parameters)
    if (parameter.quantity == &quantity) return &parameter;
  return nullptr;
}

}  // namespace mpm
