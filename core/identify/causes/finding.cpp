#include "core/identify/causes/finding.hpp"

namespace mpm {

std::string Parameter::name() const {
  return number > 0 ? quantity->name + ("_" + std::to_string(number)) : quantity->name;
}

const Parameter* Finding::find(const Quantity& quantity) const {
  for (const Parameter& parameter : parameters)
    if (parameter.quantity == &quantity) return &parameter;
  return nullptr;
}

}  // namespace mpm
