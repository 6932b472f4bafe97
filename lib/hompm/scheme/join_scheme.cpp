#include <memory>

#include <hompm/scheme/join_scheme.hpp>
#include <hompm/scheme/particle_domains.hpp>

namespace hompm {

namespace detail {
/// A file for each degree has its own.
template <int P>
std::shared_ptr<const Discretisation> join_degree(const Material& material, const StageBuilder& builder);
}  // namespace detail

std::shared_ptr<const Discretisation> join_scheme(const Material& material, const StageBuilder& builder) {
  if (builder.scheme.choices.basis != Basis::splines)
    return detail::join_degree<domain_stencil - 1>(material, builder);
  switch (builder.scheme.degree) {
    case 1: return detail::join_degree<1>(material, builder);
    case 2: return detail::join_degree<2>(material, builder);
    case 3: return detail::join_degree<3>(material, builder);
    case 4: return detail::join_degree<4>(material, builder);
    default: return detail::join_degree<5>(material, builder);
  }
}

}  // namespace hompm
