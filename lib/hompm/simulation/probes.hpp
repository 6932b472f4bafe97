// What is at the probes of a scene while it runs.
#pragma once

#include <functional>

#include <hompm/scene/scene.hpp>
#include <hompm/simulation/records.hpp>

namespace hompm::detail {

/// Tells `told` what the probes see for which `due` holds: values on the line in X through the two particles
/// of the body that are nearest. Of a place in space where no body is there is no row.
void tell_probes(const Scene& scene, const Snapshot& snapshot,
                 const std::function<bool(const ProbeSpec&)>& due,
                 const std::function<void(const ProbeRow&)>& told);

}  // namespace hompm::detail
