// What a scheme adds to `Discretisation` where a free end with extension ties functions to others.
#pragma once

#include <vector>

#include <hompm/plan/state.hpp>

namespace hompm::detail {

class TiedFunctions {
 public:
  virtual ~TiedFunctions() = default;
  /// Moves the force on a function that others carry along to those, Cᵀ f: it has none out of balance of its
  /// own, and what acts on it does not vanish at rest.
  virtual void untie(State& state, std::vector<double>& forces) const = 0;
};

}  // namespace hompm::detail
