#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include <hompm/reference/characteristics.hpp>
#include <hompm/reference/closed_forms.hpp>
#include <hompm/reference/kelvin_voigt.hpp>
#include <hompm/reference/method_of_lines.hpp>
#include <hompm/reference/reference.hpp>
#include <hompm/reference/static_equilibrium.hpp>

namespace hompm {
namespace {

std::vector<double> nowhere(double) { return {}; }

/// A closed form, smooth unless `breaks` are told.
Reference exact(std::string description, FieldsAt at,
                std::function<std::vector<double>(double)> breaks = nowhere) {
  return {.description = std::move(description),
          .at = std::move(at),
          .estimated_error = [] { return ReferenceErrors{}; },
          .breaks = std::move(breaks)};
}

/// The same fields, computed for some points at a time.
FieldsAt watched(FieldsAt at, const ReferenceWatch& watch) {
  if (!watch) return at;
  return [at = std::move(at), watch](double time, std::span<const double> X) {
    constexpr std::size_t portion = 4096;
    ReferenceFields fields;
    for (std::size_t first = 0; first < X.size(); first += portion) {
      watch(static_cast<double>(first) / static_cast<double>(X.size()));
      const auto some = at(time, X.subspan(first, std::min(portion, X.size() - first)));
      for (const auto field : point_fields)
        (fields.*field).insert((fields.*field).end(), (some.*field).begin(), (some.*field).end());
    }
    return fields;
  };
}

/// Of a solution that is the work from `from` to `to` of the whole.
ReferenceWatch part_of(const ReferenceWatch& watch, double from, double to) {
  if (!watch) return {};
  return [=](double part) { watch(from + (to - from) * part); };
}

double norm(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

/// Lets a coarser solution run along, whose distance is the estimate of the error. A wave has strain v/c, and
/// over the body the displacement L v/c: by that each field tells how large the others are at other times.
Reference estimated(const Scene& scene, std::string description, FieldsAt fine, FieldsAt coarse) {
  const auto estimate = std::make_shared<ReferenceErrors>();
  const double E = scene.material.youngs_modulus;
  const double length = scene.body.length;
  const double speed = std::sqrt(E / scene.material.density);
  const auto at = [=, fine = std::move(fine), coarse = std::move(coarse)](double time,
                                                                          std::span<const double> X) {
    ReferenceFields fields = fine(time, X);
    const ReferenceFields other = coarse(time, X);
    for (const auto field : point_fields)
      for (std::size_t i = 0; i < X.size(); ++i)
        (fields.error.*field).push_back(std::abs((fields.*field)[i] - (other.*field)[i]));
    const double u = norm(fields.displacement) / length;
    const double v = norm(fields.velocity) / speed;
    const double s = norm(fields.stress) / E;
    // Over a thousandth of what the other fields tell where a field passes through zero.
    const auto relative = [&](auto field, double scale) {
      const double size = std::max(norm(fields.*field), 1e-3 * scale);
      return size > 0.0 ? norm(fields.error.*field) / size : 0.0;
    };
    *estimate = {.displacement = relative(&PointFields::displacement, length * std::max(v, s)),
                 .velocity = relative(&PointFields::velocity, speed * std::max(u, s)),
                 .stress = relative(&PointFields::stress, E * std::max(u, v))};
    return fields;
  };
  return {std::move(description), at, [estimate] { return *estimate; }, scene.material.law != "linear"};
}

/// A scene seen from the other side: X becomes L − X.
Loads mirrored(const Loads& loads) {
  Loads other = loads;
  for (Load& load : other.gravity) load.value = -load.value;
  std::swap(other.left, other.right);
  return other;
}

/// A solution whose X is `sign` times the way from `origin`.
Reference placed(Reference solution, double origin, double sign) {
  solution.at = [=, at = solution.at](double time, std::span<const double> X) {
    std::vector<double> places;
    for (const double x : X) places.push_back(sign * (x - origin));
    if (sign > 0.0) return at(time, places);
    std::ranges::reverse(places);
    ReferenceFields fields = at(time, places);
    for (double& u : fields.displacement) u = -u;
    for (double& v : fields.velocity) v = -v;
    for (const auto field : point_fields) {
      std::ranges::reverse(fields.*field);
      std::ranges::reverse(fields.error.*field);
    }
    return fields;
  };
  if (solution.breaks)
    solution.breaks = [=, breaks = solution.breaks](double time) {
      std::vector<double> places = breaks(time);
      for (double& place : places) place = origin + sign * place;
      if (sign < 0.0) std::ranges::reverse(places);
      return places;
    };
  return solution;
}

LinearBody linear_body(const Scene& scene) {
  return {scene.body.length, scene.material.density,
          std::sqrt(scene.material.youngs_modulus / scene.material.density)};
}

/// Solutions of a body fixed on the left and free on the right, other than by the method of lines.
std::optional<Reference> column_reference(const Scene& scene, const Loads& loads,
                                          const ReferenceWatch& watch) {
  const std::optional<double> weight = final_total(loads.gravity);
  const std::optional<double> pull = final_total(loads.right);
  if (scene.rest) {
    if (!weight || !pull) return std::nullopt;
    const auto at = [scene, weight, pull](double, std::span<const double> X) {
      return static_equilibrium(scene, *weight, *pull, X);
    };
    return exact("static equilibrium, valid once at rest (quadrature of the inverted law)", at);
  }
  const bool constant =
      std::ranges::all_of(loads.gravity, [](const Load& load) { return load.amplitude.constant(); });
  const bool pulled = std::ranges::any_of(loads.right, [](const Load& load) { return load.value != 0.0; });
  const double acceleration = weight.value_or(0.0);
  const bool only_gravity =
      acceleration != 0.0 && constant && !loads.damped() && !loads.local_damping && !pulled;
  if (!only_gravity || scene.material.law != "rate" || scene.initial_velocity || scene.initial_displacement)
    return std::nullopt;
  const GasColumn column{scene.body.length, scene.material.density, linear_body(scene).wave_speed,
                         acceleration};
  const auto [at, kink] = gas_column(column, 32, part_of(watch, 0.0, 0.8));
  Reference found =
      estimated(scene, "column of large strains, method of characteristics (extrapolated net, 8th order)", at,
                gas_column(column, 16, part_of(watch, 0.8, 1.0)).at);
  found.breaks = [kink = kink](double time) { return std::vector{kink(time)}; };
  return found;
}

/// Of small strains without damping, under loads that are constant.
std::optional<Reference> wave_reference(const Scene& scene, const Loads& loads, const ReferenceWatch& watch) {
  for (const auto* some : {&loads.gravity, &loads.left, &loads.right})
    if (!std::ranges::all_of(*some, [](const Load& load) { return load.amplitude.constant(); }))
      return std::nullopt;
  if (scene.material.law != "linear" || loads.damped()) return std::nullopt;
  const LinearBody body = linear_body(scene);
  const WaveProblem problem{.body = body,
                            .ends = scene.ends,
                            .velocity = scene.initial_velocity,
                            .displacement = scene.initial_displacement,
                            .acceleration = total(loads.gravity, 0.0),
                            .left = total(loads.left, 0.0),
                            .right = total(loads.right, 0.0)};
  const auto at = [problem](double time, std::span<const double> X) {
    return travelling_waves(problem, time, X);
  };
  return exact("small strains, d'Alembert's solution", watched(at, watch), [body](double time) {
    const double from_left = front_from_left(body, time);
    const auto [first, last] = std::minmax({from_left, body.length - from_left});
    return first < last ? std::vector{first, last} : std::vector{first};
  });
}

/// Where the scene has the effect `manufactured` and no other.
std::optional<Reference> manufactured_reference(const Scene& scene, const ReferenceWatch& watch) {
  if (scene.effects.size() != 1 || scene.effects.front().type != "manufactured") return std::nullopt;
  const LinearBody body = linear_body(scene);
  const auto at = [body, material = make_material(scene.material),
                   amplitude = scene.effects.front().number("amplitude")](double time,
                                                                          std::span<const double> X) {
    return manufactured_bar(body, material, amplitude, time, X);
  };
  Reference reference = exact("manufactured solution u = G sin(pi X/L) sin(pi c t/L)", watched(at, watch));
  reference.body_force = [body, material = make_material(scene.material),
                          amplitude = scene.effects.front().number("amplitude")](double time,
                                                                                 std::span<const double> X) {
    return manufactured_force(body, material, amplitude, time, X);
  };
  return reference;
}

/// How many times a motion repeats itself along the body: between fixed ends, from half waves and under no
/// load that tells left from right, each part of as many half waves as all fields have in common moves as a
/// bar between fixed ends of its own, the odd ones as its mirror image.
int repetitions(const Scene& scene, const Loads& loads) {
  if (scene.ends.left != End::fixed || scene.ends.right != End::fixed || !loads.gravity.empty()) return 1;
  int common = 0;
  for (const auto& field : {scene.initial_velocity, scene.initial_displacement}) {
    if (!field) continue;
    if (field->shape != "sine") return 1;
    common = std::gcd(common, field->mode);
  }
  return std::max(common, 1);
}

/// The fields of the whole body from those of its first part.
FieldsAt repeated(const FieldsAt& part, double length) {
  return [part, length](double time, std::span<const double> X) {
    std::vector<double> places;
    std::vector<double> signs;
    for (const double x : X) {
      const double number = std::floor(x / length);
      const bool mirrored = number != 2.0 * std::floor(0.5 * number);
      const double place = std::clamp(x - number * length, 0.0, length);
      places.push_back(mirrored ? length - place : place);
      signs.push_back(mirrored ? -1.0 : 1.0);
    }
    ReferenceFields fields = part(time, places);
    for (std::size_t i = 0; i < X.size(); ++i) {
      fields.displacement[i] *= signs[i];
      fields.velocity[i] *= signs[i];
    }
    return fields;
  };
}

/// For a body that starts at X = 0.
std::optional<Reference> reference_at_origin(const Scene& scene, const ReferenceWatch& watch) {
  if (auto manufactured = manufactured_reference(scene, watch)) return manufactured;
  const std::optional<Loads> loads = loads_of(scene);
  if (!loads) return std::nullopt;
  if (scene.kinematics == Kinematics::infinitesimal && scene.material.law != "linear") return std::nullopt;

  const bool left_fixed = scene.ends.left == End::fixed;
  const bool right_fixed = scene.ends.right == End::fixed;
  if (left_fixed != right_fixed)
    if (auto column = column_reference(scene, left_fixed ? *loads : mirrored(*loads), watch))
      return left_fixed ? *column : placed(*column, scene.body.length, -1.0);
  if (scene.rest || loads->local_damping) return std::nullopt;
  if (auto waves = wave_reference(scene, *loads, watch)) return waves;

  if (scene.material.law == "linear" && loads->viscosity > 0.0) {
    const auto all = kelvin_voigt_bar(scene, *loads, 1.0);
    const auto half = kelvin_voigt_bar(scene, *loads, 0.5);
    if (all && half)
      return estimated(scene, "bar of small strains with viscosity, sum of its modes", watched(*all, watch),
                       *half);
  }
  Scene part = scene;
  const int parts = repetitions(scene, *loads);
  if (parts > 1) {
    part.body.length /= parts;
    for (auto* field : {&part.initial_velocity, &part.initial_displacement})
      if (*field) (*field)->mode /= parts;
  }
  const Resolution fine = suitable_resolution(part, *loads);
  const Resolution coarse{fine.elements / 2, fine.degree, fine.step_factor};
  FieldsAt at = method_of_lines(part, *loads, fine, part_of(watch, 0.0, 0.8));
  FieldsAt with_half = method_of_lines(part, *loads, coarse, part_of(watch, 0.8, 1.0));
  if (parts > 1) {
    at = repeated(at, part.body.length);
    with_half = repeated(with_half, part.body.length);
  }
  return estimated(scene, "method of lines (Legendre spectral elements, Runge-Kutta)", std::move(at),
                   std::move(with_half));
}

}  // namespace

std::optional<Reference> make_reference(const Scene& scene, const ReferenceWatch& watch) {
  if (!scene.bodies.empty() || has_memory(scene.material)) return std::nullopt;
  std::optional<Reference> reference = reference_at_origin(scene, watch);
  if (reference && scene.body.left() != 0.0) return placed(*reference, scene.body.left(), 1.0);
  return reference;
}

}  // namespace hompm
