#include <algorithm>

#include <hompm/simulation/caution.hpp>
#include <hompm/simulation/critical_step.hpp>

namespace hompm {

std::string caution(const Scene& scene) {
  const auto bodies = bodies_of(scene);
  const bool divides_by_little = std::any_of(bodies.begin(), bodies.end(), [](const Scene* body) {
    const SchemeSpec& scheme = body->scheme;
    return scheme.choices.sequence == Sequence::usl && scheme.degree == 1 && moving_free_end(*body);
  });
  if (!divides_by_little) return "";
  return "scheme.sequence = \"usl\" with hat functions divides forces at a moving free end by next to no "
         "mass: long runs blow up at any step; \"musl\" was made for that, and degree 2 lasts longer";
}

}  // namespace hompm
