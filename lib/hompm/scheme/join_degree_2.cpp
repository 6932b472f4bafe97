#include <memory>

#include <hompm/scheme/join_degree.hpp>

template std::shared_ptr<const hompm::Discretisation> hompm::detail::join_degree<2>(
    const Material& material, const StageBuilder& builder);
