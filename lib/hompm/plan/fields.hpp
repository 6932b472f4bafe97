// The table of fields: the members of the state by name, and behind them what was declared.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include <hompm/plan/state.hpp>

namespace hompm {

/// A member of the state as a field.
struct CoreField {
  using Values = std::variant<double*, std::int64_t*, std::vector<std::int32_t>*, std::vector<double>*>;
  FieldInfo info;
  Values (*of)(State& state);
};

namespace detail {

/// The member of the state, or of one of its members.
template <auto... path>
CoreField::Values at(State& state) {
  return &(state.*....*path);
}
}  // namespace detail

/// Every member that changes in a run, in the order of traces and checkpoints, which hold all of them. Left
/// out is what follows from the scene alone: grid, ends, kinematics, number of markers.
inline constexpr auto core_fields = [] {
  using detail::at;
  using enum Site;
  constexpr bool kept = true, anew = false;
  return std::to_array<CoreField>({
      {{"step", "–", "of the step under way", body, kept}, at<&State::step>},
      {{"time", "s", "at the end of the step", body, kept}, at<&State::time>},
      {{"position_time", "s", "of the positions at which forces act", body, kept}, at<&State::position_time>},
      {{"time_step", "s", "length of the step", body, kept}, at<&State::time_step>},
      {{"kick", "s", "by which velocities change", body, kept}, at<&State::kick>},
      {{"drift", "s", "by which positions change", body, kept}, at<&State::drift>},
      {{"total_mass", "kg/m²", "of all particles", body, kept}, at<&State::total_mass>},
      {{"left_boundary", "m", "left end of the material", body, kept}, at<&State::left_boundary>},
      {{"right_boundary", "m", "right end of the material", body, kept}, at<&State::right_boundary>},
      {{"left_stress", "Pa", "applied at the left end", body, anew}, at<&State::left_stress>},
      {{"right_stress", "Pa", "applied at the right end", body, anew}, at<&State::right_stress>},
      {{"particles.reference_position", "m", "X", particle, kept},
       at<&State::particles, &Particles::reference_position>},
      {{"particles.displacement", "m", "u", particle, kept}, at<&State::particles, &Particles::displacement>},
      {{"particles.position", "m", "x = X + u", particle, kept}, at<&State::particles, &Particles::position>},
      {{"particles.velocity", "m/s", "v", particle, kept}, at<&State::particles, &Particles::velocity>},
      {{"particles.mass", "kg/m²", "m", particle, kept}, at<&State::particles, &Particles::mass>},
      {{"particles.reference_density", "kg/m³", "ρ0", particle, kept},
       at<&State::particles, &Particles::reference_density>},
      {{"particles.reference_volume", "m", "V0", particle, kept},
       at<&State::particles, &Particles::reference_volume>},
      {{"particles.volume", "m", "V = V0 λ", particle, kept}, at<&State::particles, &Particles::volume>},
      {{"particles.stretch", "–", "λ", particle, kept}, at<&State::particles, &Particles::stretch>},
      {{"particles.stress", "Pa", "σ of the law", particle, kept}, at<&State::particles, &Particles::stress>},
      {{"basis.first", "–", "first function that is not zero there", particle, anew},
       at<&State::basis, &BasisAtParticles::first>},
      {{"basis.values", "–", "N_i there", particle_function, anew},
       at<&State::basis, &BasisAtParticles::values>},
      {{"basis.gradients", "1/m", "∂N_i/∂x there", particle_function, anew},
       at<&State::basis, &BasisAtParticles::gradients>},
      {{"grid.mass", "kg/m²", "Σ m_p N_i", function, anew}, at<&State::fields, &GridFields::mass>},
      {{"grid.internal_force", "Pa", "∫σ ∂N_i/∂x", function, anew},
       at<&State::fields, &GridFields::internal_force>},
      {{"grid.force", "Pa", "external − internal", function, anew}, at<&State::fields, &GridFields::force>},
      {{"grid.acceleration", "m/s²", "by the mass of the scheme", function, anew},
       at<&State::fields, &GridFields::acceleration>},
      {{"grid.momentum", "kg/(m s)", "∫ρ v N_i", function, kept}, at<&State::fields, &GridFields::momentum>},
      {{"grid.velocity", "m/s", "of the last projection", function, kept},
       at<&State::fields, &GridFields::velocity>},
      {{"balance.dissipated", "J/m²", "since the start", body, kept},
       at<&State::balance, &Balance::dissipated>},
      {{"balance.external_work", "J/m²", "since the start", body, kept},
       at<&State::balance, &Balance::external_work>},
      {{"balance.impulse", "kg/(m s)", "of all forces, since the start", body, kept},
       at<&State::balance, &Balance::impulse>},
      {{"time_rest", "s", "what rounding left of the time", body, kept}, at<&State::time_rest>},
  });
}();

/// The core field of a name. Any other throws `std::out_of_range` when the plan is made, as every test would
/// show: clang++ 14 leaves calls of a consteval literal to the linker.
constexpr Field operator""_field(const char* name, std::size_t size) {
  std::size_t index = 0;
  while (core_fields.at(index).info.name != std::string_view(name, size)) ++index;
  return {index};
}

/// All fields of a state, as `visit_fields` and the stages of its plan have them. Of a field of another plan
/// there may be none: throws `Error`.
FieldInfo info_of(const State& state, Field field);

/// Calls `visit(const FieldInfo&, std::span values)` for every core field, and every declared one that
/// persists: always in the same order. `values` holds `double`, `std::int32_t` or `std::int64_t`, const where
/// the state is.
template <class AnyState, class Visit>
void visit_fields(AnyState& state, Visit visit) {
  constexpr bool is_const = std::is_const_v<AnyState>;
  const auto span_of = []<class Value>(Value* values, std::size_t size) {
    return std::span<std::conditional_t<is_const, const Value, Value>>(values, size);
  };
  for (const CoreField& core : core_fields)
    std::visit(
        [&](auto* values) {
          if constexpr (requires { values->data(); })
            visit(core.info, span_of(values->data(), values->size()));
          else
            visit(core.info, span_of(values, 1));
        },
        core.of(const_cast<State&>(state)));
  for (auto& field : state.declared)
    if (field.persists)
      visit(field.info(), span_of(const_cast<double*>(field.values.data()), field.values.size()));
}

/// Whether two states of one scene are the same, bit for bit, in all that `visit_fields` visits.
bool operator==(const State& a, const State& b);

}  // namespace hompm
