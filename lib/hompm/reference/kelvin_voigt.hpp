// The bar of small strains with viscosity (Kelvin-Voigt), by its modes.
#pragma once

#include <optional>

#include <hompm/reference/loads.hpp>
#include <hompm/reference/reference.hpp>

namespace hompm {

/// ρ0 ü = E u″ + η u̇″ + ρ0 b − β ρ0 u̇ in closed form, η > 0, any ends. Each mode sin κX or cos κX is an
/// oscillator, ω² = E κ²/ρ0, of the damping β + η κ²/ρ0, over- or underdamped; its answer to the loads is the
/// integral of exponentials times polynomials, which are integrated exactly. In high modes inertia tells no
/// more: what they sum up to is the static shape times the answer of a dashpot beside a spring, η r′ + E r =
/// load, so that only the difference is summed over the modes, and falls with the fourth power of κ (derived
/// in docs/method.md). `fineness` times the number of modes that the time asks for is summed over.
///
/// A function as `FieldsAt`; nothing where so little viscosity would take too many modes by `scene.end_time`,
/// or a load ends before it has grown.
std::optional<FieldsAt> kelvin_voigt_bar(const Scene& scene, const Loads& loads, double fineness);

}  // namespace hompm
