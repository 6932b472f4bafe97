#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <variant>

#include <hompm/materials/material.hpp>
#include <hompm/plan/fields.hpp>
#include <hompm/plan/state.hpp>

namespace hompm {
namespace {

numerics::SplineSpace make_grid(const Scene& scene) {
  const double width = scene.body.length / scene.scheme.cells;
  // Cells of a grid that reaches `way` beyond an end.
  const auto margin = [&](End end, std::optional<double> way) {
    if (end == End::fixed) return 0;
    return way ? static_cast<int>(std::ceil(*way / width - 1e-9)) : scene.scheme.margin_cells;
  };
  const auto& [from, to] = scene.grid;
  const int left = margin(scene.ends.left, from ? std::optional(scene.body.left() - *from) : std::nullopt);
  const int right = margin(scene.ends.right, to ? std::optional(*to - scene.body.right()) : std::nullopt);
  const auto grid_of = [&](double h) {
    return numerics::SplineSpace(scene.scheme.degree, scene.scheme.cells + left + right,
                                 scene.body.left() - left * h, h);
  };
  // A width that was rounded down may leave the end of the body just outside: a hair more does not.
  double h = width;
  for (double hair = std::numeric_limits<double>::epsilon(); grid_of(h).locate(scene.body.right()).cell < 0;
       hair *= 2.0)
    h = width * (1.0 + hair);
  return grid_of(h);
}

/// Moves the body to its displacement at the start, with the stretch and the stress that go with it.
void displace(const InitialField& displacement, const Scene& scene, State& state) {
  Particles& p = state.particles;
  const double length = scene.body.length;
  const auto place = [&](double X) { return (X - scene.body.left()) / length; };
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double at = place(p.reference_position[i]);
    p.displacement[i] = displacement.at(at, length);
    p.stretch[i] = 1.0 + displacement.slope_at(at, length);
  }
  std::visit(
      [&p](const auto& law) {
        for (std::size_t i = 0; i < p.size(); ++i) p.stress[i] = law.stress(p.stretch[i]);
      },
      make_material(scene.material));
  if (!state.moves) return;
  for (std::size_t i = 0; i < p.size(); ++i) p.volume[i] = p.reference_volume[i] * p.stretch[i];
  if (!state.basis_moves) return;
  for (std::size_t i = 0; i < p.size(); ++i) p.position[i] = p.reference_position[i] + p.displacement[i];
  state.left_boundary = scene.displaced(state.left_boundary);
  state.right_boundary = scene.displaced(state.right_boundary);
}

/// Distances of the particles from the left end of the body (m), markers included.
std::vector<double> reference_places(const Scene& scene) {
  const double length = scene.body.length;
  const auto count = static_cast<std::size_t>(scene.scheme.cells) *
                     static_cast<std::size_t>(scene.scheme.particles_per_cell);
  std::vector<double> places;
  if (scene.scheme.choices.markers) places.push_back(0.0);
  for (std::size_t i = 0; i < count; ++i)
    places.push_back(length * (static_cast<double>(2 * i + 1) / static_cast<double>(2 * count)));
  if (scene.scheme.choices.markers) places.push_back(length);
  return places;
}

}  // namespace

State undeformed_state(const Scene& scene) {
  State state{.grid = make_grid(scene),
              .ends = scene.ends,
              .particles = {},
              .basis = {},
              .fields = {},
              .balance = {}};
  const SchemeChoices& choices = scene.scheme.choices;
  Particles& p = state.particles;
  p.markers = choices.markers ? 1 : 0;
  p.reference_position = reference_places(scene);
  const std::size_t sites = p.reference_position.size();
  const double volume = scene.body.length / static_cast<double>(sites - 2 * p.markers);
  for (double& X : p.reference_position) X += scene.body.left();
  p.position = p.reference_position;
  p.velocity.assign(sites, 0.0);
  p.displacement.assign(sites, 0.0);
  p.reference_volume.assign(sites, volume);
  p.mass.assign(sites, scene.material.density * volume);
  if (p.markers > 0)
    p.mass.front() = p.mass.back() = p.reference_volume.front() = p.reference_volume.back() = 0.0;
  p.volume = p.reference_volume;
  p.reference_density.assign(sites, scene.material.density);
  p.stretch.assign(sites, 1.0);
  p.stress.assign(sites, 0.0);
  for (const double mass : p.mass) state.total_mass += mass;
  state.left_boundary = scene.body.left();
  state.right_boundary = scene.body.right();

  const std::size_t stencil =
      static_cast<std::size_t>(choices.basis == Basis::splines ? scene.scheme.degree + 1 : domain_stencil);
  state.basis.stencil = stencil;
  state.basis.first.assign(sites, 0);
  state.basis.values.assign(sites * stencil, 0.0);
  state.basis.gradients.assign(sites * stencil, 0.0);
  GridFields& g = state.fields;
  for (auto* field : {&g.mass, &g.internal_force, &g.force, &g.acceleration, &g.momentum, &g.velocity})
    field->assign(static_cast<std::size_t>(state.grid.functions()), 0.0);
  return state;
}

State initial_state(const Scene& scene) {
  State state = undeformed_state(scene);
  state.moves = scene.kinematics == Kinematics::finite;
  state.basis_moves = state.moves && scene.scheme.choices.formulation == Formulation::updated_lagrangian;
  if (const auto& initial = scene.initial_velocity) {
    const std::vector<double> places = reference_places(scene);
    for (std::size_t i = 0; i < places.size(); ++i)
      state.particles.velocity[i] = initial->at(places[i] / scene.body.length, scene.body.length);
  }
  if (scene.initial_displacement) displace(*scene.initial_displacement, scene, state);
  return state;
}

std::vector<double>& State::operator[](Field field) {
  if (field.index < core_fields.size())
    return *std::get<std::vector<double>*>(core_fields[field.index].of(*this));
  return declared[field.index - core_fields.size()].values;
}

std::vector<double>* State::find(std::string_view name) {
  const auto found = std::ranges::find(declared, name, &DeclaredField::name);
  return found == declared.end() ? nullptr : &found->values;
}

FieldInfo info_of(const State& state, Field field) {
  if (field.index < core_fields.size()) return core_fields[field.index].info;
  const std::size_t index = field.index - core_fields.size();
  if (index >= state.declared.size()) throw Error("a field that its plan has not declared");
  return state.declared[index].info();
}

bool operator==(const State& a, const State& b) {
  std::vector<std::span<const std::byte>> bytes;
  visit_fields(a, [&](const FieldInfo&, auto values) { bytes.push_back(std::as_bytes(values)); });
  std::size_t next = 0;
  bool same = true;
  visit_fields(b, [&](const FieldInfo&, auto values) {
    same = same && next < bytes.size() && std::ranges::equal(bytes[next], std::as_bytes(values));
    ++next;
  });
  return same && next == bytes.size();
}

}  // namespace hompm
