// The table of fields: the members of the state by name, and behind them what was declared.
#pragma once

#include <array>
#include <span>
#include <variant>

#include <hompm/plan/state.hpp>

namespace hompm {

/// A member of the state as a field.
struct CoreField {
  using Values = std::variant<double*, std::int64_t*, std::vector<std::int32_t>*, std::vector<double>*>;
  FieldInfo info;
  Values (*of)(State& state);
};

/// Every member that changes in a run, in the order of traces and checkpoints, which hold all of them. Left
/// out is what follows from the scene alone: grid, ends, kinematics, number of markers.
inline constexpr auto core_fields = [] {
  using Values = CoreField::Values;
  constexpr bool kept = true, anew = false;
  return std::to_array<CoreField>({
      {{"step", "–", "of the step under way", Site::body, kept}, [](State& s) -> Values { return &s.step; }},
      {{"time", "s", "at the end of the step", Site::body, kept}, [](State& s) -> Values { return &s.time; }},
      {{"position_time", "s", "of the positions at which forces act", Site::body, kept},
       [](State& s) -> Values { return &s.position_time; }},
      {{"time_step", "s", "length of the step", Site::body, kept},
       [](State& s) -> Values { return &s.time_step; }},
      {{"kick", "s", "by which velocities change", Site::body, kept},
       [](State& s) -> Values { return &s.kick; }},
      {{"drift", "s", "by which positions change", Site::body, kept},
       [](State& s) -> Values { return &s.drift; }},
      {{"total_mass", "kg/m²", "of all particles", Site::body, kept},
       [](State& s) -> Values { return &s.total_mass; }},
      {{"left_boundary", "m", "left end of the material", Site::body, kept},
       [](State& s) -> Values { return &s.left_boundary; }},
      {{"right_boundary", "m", "right end of the material", Site::body, kept},
       [](State& s) -> Values { return &s.right_boundary; }},
      {{"left_stress", "Pa", "applied at the left end", Site::body, anew},
       [](State& s) -> Values { return &s.left_stress; }},
      {{"right_stress", "Pa", "applied at the right end", Site::body, anew},
       [](State& s) -> Values { return &s.right_stress; }},
      {{"particles.reference_position", "m", "X", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.reference_position; }},
      {{"particles.displacement", "m", "u", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.displacement; }},
      {{"particles.position", "m", "x = X + u", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.position; }},
      {{"particles.velocity", "m/s", "v", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.velocity; }},
      {{"particles.mass", "kg/m²", "m", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.mass; }},
      {{"particles.reference_density", "kg/m³", "ρ0", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.reference_density; }},
      {{"particles.reference_volume", "m", "V0", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.reference_volume; }},
      {{"particles.volume", "m", "V = V0 λ", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.volume; }},
      {{"particles.stretch", "–", "λ", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.stretch; }},
      {{"particles.stress", "Pa", "σ of the law", Site::particle, kept},
       [](State& s) -> Values { return &s.particles.stress; }},
      {{"basis.first", "–", "first function that is not zero there", Site::particle, anew},
       [](State& s) -> Values { return &s.basis.first; }},
      {{"basis.values", "–", "N_i there", Site::particle_function, anew},
       [](State& s) -> Values { return &s.basis.values; }},
      {{"basis.gradients", "1/m", "∂N_i/∂x there", Site::particle_function, anew},
       [](State& s) -> Values { return &s.basis.gradients; }},
      {{"grid.mass", "kg/m²", "Σ m_p N_i", Site::function, anew},
       [](State& s) -> Values { return &s.fields.mass; }},
      {{"grid.internal_force", "Pa", "∫σ ∂N_i/∂x", Site::function, anew},
       [](State& s) -> Values { return &s.fields.internal_force; }},
      {{"grid.force", "Pa", "external − internal", Site::function, anew},
       [](State& s) -> Values { return &s.fields.force; }},
      {{"grid.acceleration", "m/s²", "by the mass of the scheme", Site::function, anew},
       [](State& s) -> Values { return &s.fields.acceleration; }},
      {{"grid.momentum", "kg/(m s)", "∫ρ v N_i", Site::function, kept},
       [](State& s) -> Values { return &s.fields.momentum; }},
      {{"grid.velocity", "m/s", "of the last projection", Site::function, kept},
       [](State& s) -> Values { return &s.fields.velocity; }},
      {{"balance.dissipated", "J/m²", "since the start", Site::body, kept},
       [](State& s) -> Values { return &s.balance.dissipated; }},
      {{"balance.external_work", "J/m²", "since the start", Site::body, kept},
       [](State& s) -> Values { return &s.balance.external_work; }},
      {{"balance.impulse", "kg/(m s)", "of all forces, since the start", Site::body, kept},
       [](State& s) -> Values { return &s.balance.impulse; }},
      {{"time_rest", "s", "what rounding left of the time", Site::body, kept},
       [](State& s) -> Values { return &s.time_rest; }},
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
