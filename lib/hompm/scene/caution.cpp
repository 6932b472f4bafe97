#include <algorithm>

#include <hompm/scene/caution.hpp>

namespace hompm {

std::string caution(const Scene& scene) {
  const auto bodies = bodies_of(scene);
  const bool divides_by_little = std::any_of(bodies.begin(), bodies.end(), [](const Scene* body) {
    const SchemeSpec& scheme = body->scheme;
    const bool free = body->ends.left == End::free || body->ends.right == End::free;
    return scheme.choices.sequence == Sequence::usl && scheme.degree == 1 && free &&
           body->kinematics == Kinematics::finite &&
           scheme.choices.formulation == Formulation::updated_lagrangian;
  });
  if (!divides_by_little) return "";
  return "scheme.sequence = \"usl\" with hat functions divides forces at a moving free end by next to no "
         "mass: long runs blow up at any step; \"musl\" was made for that, and degree 2 lasts longer";
}

}  // namespace hompm
